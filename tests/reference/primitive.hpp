// What the oracle is asked about, and boxes along the world's axes.
#pragma once

#include <Eigen/Core>

namespace depthgrid::reference {

/// A box with axes along the world's, metres.
struct WorldBox {
  Eigen::Vector3d low, high;

  [[nodiscard]] Eigen::Vector3d centre() const { return 0.5 * (low + high); }
  [[nodiscard]] double half_diagonal_m() const { return 0.5 * (high - low).norm(); }
  [[nodiscard]] double longest_side_m() const { return (high - low).maxCoeff(); }
  [[nodiscard]] Eigen::Vector3d corner(int index) const {
    return {(index & 1) != 0 ? high.x() : low.x(), (index & 2) != 0 ? high.y() : low.y(),
            (index & 4) != 0 ? high.z() : low.z()};
  }
  [[nodiscard]] WorldBox grown(double by_m) const {
    return {low - Eigen::Vector3d::Constant(by_m), high + Eigen::Vector3d::Constant(by_m)};
  }
  [[nodiscard]] Eigen::Vector3d nearest_to(const Eigen::Vector3d& p) const { return p.cwiseMax(low).cwiseMin(high); }
};

/// All points within radius_m of the segment from a to b, world frame: a point (a = b, radius 0), a sphere or a
/// capsule.
struct Primitive {
  Eigen::Vector3d a_world, b_world;
  double radius_m = 0;

  [[nodiscard]] bool is_segment() const { return a_world != b_world; }
  [[nodiscard]] Eigen::Vector3d on_axis(double t) const { return a_world + t * (b_world - a_world); }
};

[[nodiscard]] inline Primitive point(const Eigen::Vector3d& p_world) { return {p_world, p_world, 0.0}; }

/// The axis' point nearest to x.
[[nodiscard]] Eigen::Vector3d nearest_on_axis(const Primitive& primitive, const Eigen::Vector3d& x_world);
/// Distance from the axis to x.
[[nodiscard]] double axis_distance_m(const Primitive& primitive, const Eigen::Vector3d& x_world);
/// The axis' point nearest to the box.
[[nodiscard]] Eigen::Vector3d nearest_on_axis(const Primitive& primitive, const WorldBox& box);

}  // namespace depthgrid::reference
