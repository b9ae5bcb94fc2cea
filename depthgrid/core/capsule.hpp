// What is asked about, and what robots and people are made of: a point, a sphere or a capsule.
#pragma once

#include <Eigen/Core>

namespace depthgrid {

/// All points within radius_m of the segment from a to b, in metres, in the frame that the user states. a = b: a
/// sphere; radius 0 too: a point.
struct Capsule {
  Eigen::Vector3d a = Eigen::Vector3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double radius_m = 0;

  [[nodiscard]] static Capsule point(const Eigen::Vector3d& p) { return {p, p, 0}; }
  [[nodiscard]] static Capsule sphere(const Eigen::Vector3d& centre, double radius_m) {
    return {centre, centre, radius_m};
  }
};

/// The axis' point nearest to p.
[[nodiscard]] Eigen::Vector3d nearest_on_axis(const Capsule& capsule, const Eigen::Vector3d& p) noexcept;

/// Distance from p to the axis.
[[nodiscard]] double distance_to_axis(const Capsule& capsule, const Eigen::Vector3d& p) noexcept;

}  // namespace depthgrid
