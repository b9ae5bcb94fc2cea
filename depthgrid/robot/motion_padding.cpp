#include "depthgrid/robot/motion_padding.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid::robot {

namespace {

/// Greatest distance of a point of the capsule (world frame) from the line; convex, so an end has it.
double reach(const Capsule& capsule, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  const double a = (capsule.a - origin).cross(direction).norm();
  const double b = (capsule.b - origin).cross(direction).norm();
  return std::max(a, b) + capsule.radius_m;
}

}  // namespace

void motion_padding(const RobotModel& model, std::span<const LinkCapsule> capsules, std::span<const Pose> T_world_link,
                    std::span<const double> joint_speeds, double time_error_s, std::span<double> padding_m) noexcept {
  for (std::size_t i = 0; i < capsules.size(); ++i) {
    const Pose& T_world_capsule = T_world_link[capsules[i].link];
    const Capsule capsule{T_world_capsule * capsules[i].capsule.a, T_world_capsule * capsules[i].capsule.b,
                          capsules[i].capsule.radius_m};
    double moved_m = 0;
    for (std::optional<std::size_t> link = capsules[i].link; link; link = model.joint_of_link(*link).parent) {
      const LinkJoint& joint = model.joint_of_link(*link);
      if (!joint.joint || time_error_s == 0) {
        continue;
      }
      const double error = std::abs(joint.multiplier) * joint_speeds[*joint.joint] * time_error_s;
      if (joint.type == JointType::prismatic) {
        moved_m += error;
      } else {
        const Pose& T_world_joint = T_world_link[*link];
        moved_m +=
            error * (reach(capsule, T_world_joint.translation(), T_world_joint.linear() * joint.axis_link) + moved_m);
      }
    }
    padding_m[i] = moved_m;
  }
}

}  // namespace depthgrid::robot
