// How far a robot's capsules may move within an error of time.
#pragma once

#include <span>

#include "depthgrid/robot/link_capsules.hpp"
#include "depthgrid/robot/robot_model.hpp"

namespace depthgrid::robot {

/// For each capsule a bound of how far any of its points is from where it is at T_world_link, if each joint stands
/// elsewhere by at most joint_speeds * time_error_s: a capsule grown by it contains the link. Not linearised: with d_j
/// the error of joint j and rho_j the capsule's greatest distance from its axis, the joints from the tip to the base
/// each turn d into d + d_j (rho_j + d), sliding ones into d + d_j. joint_speeds: rad/s or m/s, not negative; the
/// greatest within the time error, from the model's limits or from measurement; an infinite one gives infinity.
/// Spans: one element a joint, a link, a capsule, a capsule. Any number of threads.
void motion_padding(const RobotModel& model, std::span<const LinkCapsule> capsules, std::span<const Pose> T_world_link,
                    std::span<const double> joint_speeds, double time_error_s, std::span<double> padding_m) noexcept;

}  // namespace depthgrid::robot
