// What a robot's joints can do.
#pragma once

#include "depthgrid/control/joints.hpp"

namespace depthgrid::control {

/// Limits of every joint; rad, rad/s, rad/s^2.
struct JointLimits {
  JointVector lowest_rad;
  JointVector highest_rad;
  JointVector velocity_rad_s;       ///< of either sign
  JointVector acceleration_rad_s2;  ///< of either sign; what the robot can brake with at any time

  [[nodiscard]] int joints() const noexcept { return static_cast<int>(lowest_rad.size()); }
};

/// Throws Error with joint, value and rule: 1 to kMaxJoints joints, all vectors of one size, finite, lowest < highest,
/// velocity and acceleration greater than 0.
void validate(const JointLimits& limits);

/// Throws Error unless the time between two commands is greater than 0 and at most 1 s.
void validate_period(double period_s, const char* name);

}  // namespace depthgrid::control
