#include "depthgrid/core/capsule.hpp"

#include <algorithm>

namespace depthgrid {

Eigen::Vector3d nearest_on_axis(const Capsule& capsule, const Eigen::Vector3d& p) noexcept {
  const Eigen::Vector3d axis = capsule.b - capsule.a;
  const double squared_length = axis.squaredNorm();
  if (!(squared_length > 0)) {
    return capsule.a;
  }
  const double along = std::clamp((p - capsule.a).dot(axis) / squared_length, 0.0, 1.0);
  return capsule.a + along * axis;
}

double distance_to_axis(const Capsule& capsule, const Eigen::Vector3d& p) noexcept {
  const Eigen::Vector3d along = capsule.b - capsule.a;
  const double square = along.squaredNorm();
  const double part = square > 0 ? std::clamp((p - capsule.a).dot(along) / square, 0.0, 1.0) : 0.0;
  return (p - capsule.a - part * along).norm();
}

}  // namespace depthgrid
