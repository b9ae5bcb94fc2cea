// From a robot's description to the limits that the controller keeps.
#pragma once

#include "depthgrid/control/joint_limits.hpp"
#include "depthgrid/robot/robot_model.hpp"

namespace depthgrid::avoidance {

/// Ranges and speeds of the model, and this acceleration for every joint: what each can brake with at any time, which
/// no URDF states; rad/s^2, or m/s^2 where it slides. Where joints differ set JointLimits::acceleration_rad_s2
/// afterwards. Joints without an end get +-1000 rad. Throws Error that names the joint when it has no range or no speed
/// limit, and when there are no joints, more than control::kMaxJoints, or the acceleration is not positive and finite.
[[nodiscard]] control::JointLimits joint_limits(const robot::RobotModel& model, double acceleration_rad_s2);

}  // namespace depthgrid::avoidance
