// The law of repulsion that evaluators and control share: how much an obstacle counts at its distance, and which way
// all of them together lie. The defaults are the letter's.
//
//   v(D) / V = 1 / (1 + exp((2 D / rho - 1) alpha))
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace depthgrid {

inline constexpr double kDefaultRho = 0.4;    ///< where it begins, metres
inline constexpr double kDefaultAlpha = 6.0;  ///< steepness
inline constexpr double kDefaultBlend = 0.5;  ///< how much the others turn the direction to the nearest obstacle
inline constexpr double kLargestAlpha = 100.0;

/// V / v(D): a divisor, so that a weight is rounded once.
[[nodiscard]] inline double inverse_repulsion(double distance_m, double rho_m, double alpha) noexcept {
  return 1.0 + std::exp((2.0 * distance_m / rho_m - 1.0) * alpha);
}

/// n + b (m - (m.n) n), normalised: the unit vector n towards the nearest obstacle leads, the mean m of those to all
/// obstacles turns it by at most 45 degrees, for b in [0, 1].
[[nodiscard]] inline Eigen::Vector3d led_direction(const Eigen::Vector3d& n, const Eigen::Vector3d& mean,
                                                   double b) noexcept {
  return (n + b * (mean - mean.dot(n) * n)).normalized();
}

}  // namespace depthgrid
