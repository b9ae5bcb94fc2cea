// Distances and rays of capsules and half spaces in closed form, double precision. Shares nothing with the product but
// the shape of a capsule.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "depthgrid/core/capsule.hpp"

namespace depthgrid::world {

/// A floor or a wall: all points x with normal . x < offset_m. World frame, metres; the normal has length 1.
struct HalfSpace {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset_m = 0;
};

/// From segment to segment.
[[nodiscard]] double segment_distance_m(const Eigen::Vector3d& a0, const Eigen::Vector3d& a1, const Eigen::Vector3d& b0,
                                        const Eigen::Vector3d& b1);
/// From surface to surface; negative where they overlap.
[[nodiscard]] double gap_m(const Capsule& a, const Capsule& b);
[[nodiscard]] double gap_m(const Capsule& a, const HalfSpace& b);
/// From a point to the capsule's surface; negative inside.
[[nodiscard]] double gap_m(const Capsule& a, const Eigen::Vector3d& point);

/// The least s >= 0 at which s ray, a ray from the origin, is in the capsule.
[[nodiscard]] std::optional<double> first_hit(const Capsule& capsule, const Eigen::Vector3d& ray);

}  // namespace depthgrid::world
