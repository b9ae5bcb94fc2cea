#include "depthgrid/monitor/recorded_format.hpp"

#include "depthgrid/monitor/recorder.hpp"

namespace depthgrid::monitor {

messages::Transform recorded_pose(const Pose& pose) noexcept {
  const Eigen::Vector3d t = pose.translation();
  const Eigen::Quaterniond turn = Eigen::Quaterniond(pose.linear()).normalized();
  return {.translation = {.x = t.x(), .y = t.y(), .z = t.z()},
          .rotation = {.x = turn.x(), .y = turn.y(), .z = turn.z(), .w = turn.w()}};
}

Pose recorded_pose(const messages::Transform& pose) noexcept {
  const messages::Quaternion& turn = pose.rotation;
  const Eigen::Vector3d t(pose.translation.x, pose.translation.y, pose.translation.z);
  Pose result = Pose::Identity();
  result.linear() = Eigen::Quaterniond(turn.w, turn.x, turn.y, turn.z).toRotationMatrix();
  result.translation() = t;
  return result;
}

Pose recordable(const Pose& pose) noexcept { return recorded_pose(recorded_pose(pose)); }

}  // namespace depthgrid::monitor
