// Distance between a primitive's axis (a point or a segment) and an axis-aligned box. Internal.
#pragma once

#include <Eigen/Core>

namespace depthgrid::search {

struct AxisToBox {
  Eigen::Vector3d on_axis;
  Eigen::Vector3d in_box;
  double distance_m = 0;
};

/// Exact, in double precision: the squared distance from a + t (b - a) to the box is convex and piecewise quadratic in
/// t with at most six breakpoints. a = b is a point.
[[nodiscard]] AxisToBox nearest(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& low,
                                const Eigen::Vector3d& high) noexcept;

}  // namespace depthgrid::search
