// What of a robot is asked for its distance: points on its links, or the capsules of its links.
#pragma once

#include <vector>

#include "depthgrid/robot/link_capsules.hpp"
#include "depthgrid/robot/robot_model.hpp"

namespace depthgrid::robot {

/// Nine control points as the letter has them, for an arm of the LWR 4+'s links: the flange first, as end effector,
/// then eight from the wrist to the shoulder. Throws Error when the model has no links of these names.
[[nodiscard]] std::vector<LinkCapsule> nine_control_points(const RobotModel& model);

/// The capsules that contain the links that move, the one farthest from the base first. Links that fewer than
/// `least_joints` joints move are left out: the first link of an upright arm turns about its own axis, so it stays
/// where it is, and yet what stands beside the base would limit the joint. Throws Error when nothing is left or a shape
/// cannot be read.
[[nodiscard]] std::vector<LinkCapsule> moving_capsules(const RobotModel& model, int least_joints = 2,
                                                       const CapsuleOptions& options = {});

/// The parts with one of this link first, as the loop wants that of the end effector; a link without a part gets a
/// point, its origin.
[[nodiscard]] std::vector<LinkCapsule> tip_first(std::vector<LinkCapsule> parts, std::size_t tip_link);

}  // namespace depthgrid::robot
