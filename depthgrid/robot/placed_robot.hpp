// A robot and where it stands.
#pragma once

#include <span>
#include <vector>

#include "depthgrid/robot/robot_model.hpp"

namespace depthgrid::robot {

/// What finds the robot in images and what moves it take the same one, so that its place is stated once.
struct PlacedRobot {
  RobotModel model;
  Pose T_world_base = Pose::Identity();  ///< of the root link, in the world of the cameras; it does not move

  /// RobotModel::link_poses() from there.
  [[nodiscard]] bool link_poses(std::span<const double> q, std::span<Pose> T_world_link) const noexcept {
    return model.link_poses(q, T_world_base, T_world_link);
  }
  /// The same for what is set up once: allocates. Throws Error when q has not one position a joint.
  [[nodiscard]] std::vector<Pose> link_poses(std::span<const double> q) const;
};

}  // namespace depthgrid::robot
