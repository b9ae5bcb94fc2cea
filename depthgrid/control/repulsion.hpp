// The repulsive velocity of the end effector: how fast and in which direction it evades.
//
//   v(D) = V / (1 + exp((2 D / rho - 1) alpha))  for D < rho, else 0       magnitude
//   V_rep = -v(D) d                               d: direction towards the obstacles, as the form says
//
// v(rho / 2) = V / 2; v(0) stays below V and v jumps from V / (1 + exp(alpha)) to 0 at rho. It is a bounded push:
// nothing in it keeps an obstacle from being touched.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "depthgrid/control/obstacle.hpp"
#include "depthgrid/core/repulsion_law.hpp"

namespace depthgrid::control {

/// Which direction a repulsion takes.
enum class RepulsionForm : std::uint8_t {
  nearest,    ///< away from the nearest obstacle
  letter,     ///< against the mean (11) as printed, not normalised: weak where obstacles stand on several sides
  unit_mean,  ///< against the mean (11), normalised
  corrected,  ///< against the led direction of the corrected evaluators: at most 45 degrees from `nearest`
};

struct RepulsionSettings {
  RepulsionForm form = RepulsionForm::corrected;
  double rho_m = kDefaultRho;    ///< where it begins
  double v_max_m_s = 1.5;        ///< V
  double alpha = kDefaultAlpha;  ///< steepness
};

/// Throws Error with value and rule.
void validate(const RepulsionSettings& settings);

/// f(D) = v(D) / V: the risk of the body's points uses the same shape. From 0 (at rho and beyond) to less than 1;
/// negative distances count as 0. NaN gives f(0).
[[nodiscard]] double risk(double distance_m, double rho_m, double alpha) noexcept;

/// risk() of the obstacle's distance; f(0) where that is unknown.
[[nodiscard]] double risk(const Obstacle& obstacle, double rho_m, double alpha) noexcept;

/// V_rep, m/s in the world frame. Zero with nothing within rho, and where the direction is unknown.
/// In the form `corrected` a direction that was not asked for is replaced by the nearest one.
[[nodiscard]] Eigen::Vector3d repulsive_velocity(const Obstacle& obstacle, const RepulsionSettings& settings) noexcept;

}  // namespace depthgrid::control
