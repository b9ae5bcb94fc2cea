// Capsules: what a robot's links are taken for.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>

namespace depthgrid::robot {

/// All points within radius_m of the segment from a to b; a = b is a sphere. Metres, in the frame that the user states.
struct Capsule {
  Eigen::Vector3d a = Eigen::Vector3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double radius_m = 0;
};

/// A capsule fixed to a link of a RobotModel, in the link's frame.
struct LinkCapsule {
  std::size_t link = 0;
  Capsule capsule;
};

/// Distance from p to the capsule's axis.
[[nodiscard]] inline double distance_to_axis(const Capsule& capsule, const Eigen::Vector3d& p) noexcept {
  const Eigen::Vector3d along = capsule.b - capsule.a;
  const double square = along.squaredNorm();
  const double part = square > 0 ? std::clamp((p - capsule.a).dot(along) / square, 0.0, 1.0) : 0.0;
  return (p - capsule.a - part * along).norm();
}

}  // namespace depthgrid::robot
