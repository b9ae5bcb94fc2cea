#include "reference/primitive.hpp"

#include <algorithm>

namespace depthgrid::reference {

Eigen::Vector3d nearest_on_axis(const Primitive& primitive, const Eigen::Vector3d& x_world) {
  if (!primitive.is_segment()) {
    return primitive.a_world;
  }
  const Eigen::Vector3d axis = primitive.b_world - primitive.a_world;
  return primitive.on_axis(std::clamp(axis.dot(x_world - primitive.a_world) / axis.squaredNorm(), 0.0, 1.0));
}

double axis_distance_m(const Primitive& primitive, const Eigen::Vector3d& x_world) {
  return (nearest_on_axis(primitive, x_world) - x_world).norm();
}

Eigen::Vector3d nearest_on_axis(const Primitive& primitive, const WorldBox& box) {
  if (!primitive.is_segment()) {
    return primitive.a_world;
  }
  // The squared distance is convex along the axis: bisection on the sign of its slope.
  const Eigen::Vector3d axis = primitive.b_world - primitive.a_world;
  const auto rises = [&](double t) {
    const Eigen::Vector3d p = primitive.on_axis(t);
    return axis.dot(p - box.nearest_to(p)) >= 0;
  };
  if (rises(0)) {
    return primitive.a_world;
  }
  if (!rises(1)) {
    return primitive.b_world;
  }
  double low = 0;
  double high = 1;
  for (int step = 0; step < 40; ++step) {
    const double middle = 0.5 * (low + high);
    (rises(middle) ? high : low) = middle;
  }
  return primitive.on_axis(0.5 * (low + high));
}

}  // namespace depthgrid::reference
