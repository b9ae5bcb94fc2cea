#include "depthgrid/robot/placed_robot.hpp"

#include "depthgrid/core/error.hpp"

namespace depthgrid::robot {

std::vector<Pose> PlacedRobot::link_poses(std::span<const double> q) const {
  std::vector<Pose> T_world_link(model.links().size(), Pose::Identity());
  if (!link_poses(q, T_world_link)) {
    fail(model.source(), ": ", q.size(), " joint positions for ", model.joints().size(), " joints");
  }
  return T_world_link;
}

}  // namespace depthgrid::robot
