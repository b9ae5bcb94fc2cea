#include "depthgrid/search/primitive.hpp"

#include <algorithm>

namespace depthgrid::search {

Eigen::Vector3d nearest_on_axis(const Primitive& primitive, const Eigen::Vector3d& x_world) noexcept {
  const Eigen::Vector3d axis = primitive.b_world - primitive.a_world;
  const double squared_length = axis.squaredNorm();
  if (!(squared_length > 0)) {
    return primitive.a_world;
  }
  const double along = std::clamp((x_world - primitive.a_world).dot(axis) / squared_length, 0.0, 1.0);
  return primitive.a_world + along * axis;
}

}  // namespace depthgrid::search
