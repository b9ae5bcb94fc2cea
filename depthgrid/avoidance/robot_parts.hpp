// What of a robot is asked for its distance: points on its links, or the capsules of its links.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "depthgrid/robot/robot_model.hpp"
#include "depthgrid/search/primitive.hpp"

namespace depthgrid::avoidance {

/// All points within radius_m of the segment from a to b, in the frame of the link it moves with. a = b and radius 0: a
/// control point.
struct RobotPart {
  std::size_t link = 0;
  Eigen::Vector3d a_link = Eigen::Vector3d::Zero();
  Eigen::Vector3d b_link = Eigen::Vector3d::Zero();
  double radius_m = 0;
};

/// Nine control points as the letter has them, for an arm of the LWR 4+'s links: the flange first, as end effector,
/// then eight from the wrist to the shoulder. Throws Error when the model has no links of these names.
[[nodiscard]] std::vector<RobotPart> nine_control_points(const robot::RobotModel& model);

/// The capsules that contain the links that move, the one farthest from the base first. Links that fewer than
/// `least_joints` joints move are left out: the first link of an upright arm turns about its own axis, so it stays
/// where it is, and yet what stands beside the base would limit the joint. Throws Error when nothing is left or a shape
/// cannot be read.
[[nodiscard]] std::vector<RobotPart> moving_capsules(const robot::RobotModel& model, int least_joints = 2);

/// Where the parts are, given RobotModel::link_poses(); both spans have the same size.
void place(std::span<const RobotPart> parts, std::span<const Pose> T_world_link,
           std::span<search::Primitive> parts_world) noexcept;

}  // namespace depthgrid::avoidance
