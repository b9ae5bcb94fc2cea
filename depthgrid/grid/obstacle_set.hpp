// What a scan over the principal camera's pixels collects for one control point. Internal.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "depthgrid/core/pixel_frustum.hpp"
#include "depthgrid/core/repulsion_law.hpp"

namespace depthgrid::grid {

/// A control point in the principal camera's frame and depth space: equations (1) and (2).
struct ControlPoint {
  Eigen::Vector3d p_camera;  ///< metres
  DepthPoint p;
};

/// Obstacle points within rho, one per principal pixel at most.
class ObstacleSet {
 public:
  /// `repulsion_alpha` shapes the weight of each direction.
  ObstacleSet(double rho_m, double repulsion_alpha) noexcept
      : rho_m_(rho_m), nearest_m_(rho_m), alpha_(repulsion_alpha) {}

  /// Keeps the obstacle if it is the nearest within rho so far.
  void take_nearest(const NearestPoint& obstacle, int u, int v) noexcept {
    if (obstacle.distance_m < nearest_m_) {
      nearest_m_ = obstacle.distance_m;
      nearest_ = obstacle;
      u_ = u;
      v_ = v;
      found_ = true;
    }
  }

  /// Adds the unit vector (10) towards an obstacle within rho to the sum of equation (11).
  void add_direction(const Eigen::Vector3d& direction_camera) noexcept {
    direction_sum_ += direction_camera;
    ++count_;
  }

  /// Adds the unit vector weighted by the repulsion at its distance.
  void add_weighted_direction(const NearestPoint& obstacle) noexcept {
    if (obstacle.distance_m < rho_m_) {
      const double weight = 1.0 / inverse_repulsion(obstacle.distance_m, rho_m_, alpha_);
      direction_sum_ += weight * obstacle.direction_camera;
      weight_sum_ += weight;
      ++count_;
    }
  }

  [[nodiscard]] bool found() const noexcept { return found_; }
  /// Distance of the nearest so far; rho while there is none.
  [[nodiscard]] double nearest_m() const noexcept { return nearest_m_; }
  [[nodiscard]] const NearestPoint& nearest() const noexcept { return nearest_; }
  [[nodiscard]] int u() const noexcept { return u_; }  ///< principal pixel of the nearest
  [[nodiscard]] int v() const noexcept { return v_; }
  [[nodiscard]] std::int64_t count() const noexcept { return count_; }

  /// Equation (11) as printed: the mean of the unit vectors, not normalised. Zero when there is none.
  [[nodiscard]] Eigen::Vector3d mean_direction() const noexcept;

  /// The direction that the nearest leads, with the weighted mean of the others.
  [[nodiscard]] Eigen::Vector3d led_direction(double b) const noexcept;

 private:
  double rho_m_;
  double nearest_m_;
  double alpha_;
  NearestPoint nearest_{};
  int u_ = 0, v_ = 0;
  bool found_ = false;
  Eigen::Vector3d direction_sum_ = Eigen::Vector3d::Zero();
  double weight_sum_ = 0;
  std::int64_t count_ = 0;
};

}  // namespace depthgrid::grid
