// Turns requests that may jump into commands that never leave the joints' position, velocity and acceleration limits,
// and from which a stop within the position limits is always possible.
#pragma once

#include "depthgrid/control/joint_box.hpp"
#include "depthgrid/control/robot_port.hpp"

namespace depthgrid::control {

/// Remembers the last command. Started within the limits, all its commands keep them:
///   lowest <= q <= highest, |v| <= V, |v - v of the command before| <= A T, to rounding.
/// Not for two threads at once; nothing but the constructor allocates, locks or throws.
class CommandLimiter {
 public:
  /// Throws Error when limits or period are invalid.
  CommandLimiter(const JointLimits& limits, double period_s);

  /// Begins at the robot's state. False, and nothing changes, when it is not finite or of another size. A state outside
  /// the limits is taken: then commands brake first, and may move back but not farther out.
  bool start(const JointVector& position_rad, const JointVector& velocity_rad_s) noexcept;

  /// The velocities that the next command may have.
  [[nodiscard]] JointBox box() const noexcept;

  /// The next command: the admissible velocity nearest to the requested one. What is not finite is a request to stop.
  JointCommand step(const JointVector& requested_rad_s) noexcept;

  /// The next command on the way to a position, without passing it where that can be avoided; what is not finite is a
  /// request to stop.
  JointCommand step_towards(const JointVector& requested_rad) noexcept;

  [[nodiscard]] const JointCommand& last() const noexcept { return last_; }
  [[nodiscard]] const JointLimits& limits() const noexcept { return limits_; }
  [[nodiscard]] double period_s() const noexcept { return period_s_; }

 private:
  JointLimits limits_;
  double period_s_;
  JointCommand last_;
};

}  // namespace depthgrid::control
