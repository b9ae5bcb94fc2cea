// What is asked about: a point, a sphere or a capsule.
#pragma once

#include <Eigen/Core>

namespace depthgrid::search {

/// All points within radius_m of the segment from a to b (world frame, metres). a = b: a sphere; radius 0: a point.
struct Primitive {
  Eigen::Vector3d a_world;
  Eigen::Vector3d b_world;
  double radius_m = 0;
};

[[nodiscard]] inline Primitive point(const Eigen::Vector3d& p_world) { return {p_world, p_world, 0.0}; }
[[nodiscard]] inline Primitive sphere(const Eigen::Vector3d& centre_world, double radius_m) {
  return {centre_world, centre_world, radius_m};
}
[[nodiscard]] inline Primitive capsule(const Eigen::Vector3d& a_world, const Eigen::Vector3d& b_world,
                                       double radius_m) {
  return {a_world, b_world, radius_m};
}

/// The axis' point nearest to x.
[[nodiscard]] Eigen::Vector3d nearest_on_axis(const Primitive& primitive, const Eigen::Vector3d& x_world) noexcept;

}  // namespace depthgrid::search
