#include "depthgrid/control/obstacle.hpp"

#include <cmath>

namespace depthgrid::control {

std::optional<Eigen::Vector3d> unit_vector(const Eigen::Vector3d& direction) noexcept {
  constexpr double kShortest = 1e-9;  // what rounding leaves of vectors that cancel has no direction
  const double length = direction.norm();
  if (!(std::isfinite(length) && length > kShortest)) {
    return std::nullopt;
  }
  return direction / length;
}

Obstacle obstacle_of(const Answer& answer, BlindLayer layer) noexcept {
  Obstacle obstacle;
  const double distance_m = layer == BlindLayer::ignored ? answer.distance_now_m : clear_of_layer_m(answer);
  if (!std::isfinite(distance_m)) {
    return obstacle;
  }
  obstacle.distance_m = distance_m;
  obstacle.direction_world = unit_vector(answer.nearest.direction_world);
  if (answer.hybrid_direction_world.allFinite()) {
    obstacle.hybrid_direction_world = answer.hybrid_direction_world;
  }
  return obstacle;
}

Obstacle obstacle_of(const Proximity& answer, const Eigen::Vector3d& hybrid_direction_world, double elapsed_s,
                     double v_max_m_s) noexcept {
  return obstacle_of({.nearest = answer,
                      .distance_now_m = lower_bound_after(answer, elapsed_s, v_max_m_s),
                      .on_axis_world = {},
                      .hybrid_direction_world = hybrid_direction_world},
                     BlindLayer::ignored);
}

}  // namespace depthgrid::control
