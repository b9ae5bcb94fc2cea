// The pivot: an obstacle that comes nearer is evaded sideways instead of straight away.
//
// The obstacle's velocity is not measured; the rate of the repulsive vector V stands in for it:
//
//   Vdot = (V_k - V_{k-1}) / T,  a = Vdot / |Vdot|,  r = V / |V|,  beta = acos(a . r)
//   beta < pi / 2, the obstacle approaches:  n = a x r,  w = n x a, normalised
//     gamma = beta + (beta - pi / 2) / (1 + exp(-(2 |Vdot| / rate - 1) c))
//     V_pivot = |V| (cos(gamma) a + sin(gamma) w)
//   else V_pivot = V.
//
// The gain is small and depth images make Vdot noisy: an option, off by default.
#pragma once

#include <Eigen/Core>

namespace depthgrid::control {

struct PivotSettings {
  double rate_m_s2 = 1.0;  ///< of the repulsive vector, at which the pivot is nearly full
  double c = 5.0;          ///< steepness
};

/// Throws Error with value and rule.
void validate(const PivotSettings& settings);

/// V_pivot for V = `repulsion` and V_{k-1} = `before`, both m/s; |V_pivot| = |V|. V itself where V, Vdot or the angle
/// between them is zero, and where anything is not finite or the period is not positive.
[[nodiscard]] Eigen::Vector3d pivoted(const Eigen::Vector3d& repulsion_m_s, const Eigen::Vector3d& before_m_s,
                                      double period_s, const PivotSettings& settings) noexcept;

}  // namespace depthgrid::control
