// Points on a robot whose distance is asked, and how much of the robot each stands for.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "depthgrid/robot/link_capsules.hpp"
#include "depthgrid/robot/robot_model.hpp"

namespace depthgrid::robot {

/// The ball of radius_m around p_link, in the link's frame. A point is not a link: nothing of what the ball covers is
/// nearer to an obstacle than the point's distance less radius_m.
struct ControlPoint {
  std::size_t link = 0;
  Eigen::Vector3d p_link = Eigen::Vector3d::Zero();
  double radius_m = 0;
};

/// Balls that together contain the capsules: evenly along each axis, at most spacing_m apart, of radius
/// sqrt(r^2 + (h/2)^2) where h is their distance; one ball where the axis is a point. Throws Error unless spacing_m is
/// positive.
[[nodiscard]] std::vector<ControlPoint> cover_with_balls(std::span<const LinkCapsule> capsules, double spacing_m);

/// The points in the world; both spans have the same size. T_world_link: as RobotModel::link_poses() gives them.
void place(std::span<const ControlPoint> points, std::span<const Pose> T_world_link,
           std::span<Eigen::Vector3d> points_world) noexcept;

}  // namespace depthgrid::robot
