#include "depthgrid/control/repulsion.hpp"

#include <algorithm>
#include <cmath>

#include "depthgrid/core/error.hpp"

namespace depthgrid::control {
namespace {

/// Towards the obstacles; at most of length 1.
Eigen::Vector3d direction_of(const Obstacle& obstacle, RepulsionForm form) noexcept {
  Eigen::Vector3d nearest = obstacle.direction_world.value_or(Eigen::Vector3d::Zero());
  const Eigen::Vector3d& hybrid = obstacle.hybrid_direction_world;
  switch (form) {
    case RepulsionForm::nearest:
      return nearest;
    case RepulsionForm::letter:
      return hybrid / std::max(1.0, hybrid.norm());
    case RepulsionForm::unit_mean:
      return unit_vector(hybrid).value_or(Eigen::Vector3d::Zero());
    case RepulsionForm::corrected:
      return unit_vector(hybrid).value_or(nearest);
  }
  return nearest;
}

}  // namespace

void validate(const RepulsionSettings& settings) {
  constexpr const char* kName = "repulsion: ";
  if (!(std::isfinite(settings.rho_m) && settings.rho_m > 0)) {
    fail(kName, "rho is ", settings.rho_m, " m, must be greater than 0 and finite");
  }
  if (!(std::isfinite(settings.v_max_m_s) && settings.v_max_m_s >= 0)) {
    fail(kName, "v_max is ", settings.v_max_m_s, " m/s, must be finite and not negative");
  }
  if (!(settings.alpha > 0 && settings.alpha <= kLargestAlpha)) {
    fail(kName, "alpha is ", settings.alpha, ", must be greater than 0 and at most ", kLargestAlpha);
  }
}

double risk(double distance_m, double rho_m, double alpha) noexcept {
  const double distance = distance_m > 0 ? distance_m : 0.0;
  return distance < rho_m ? 1.0 / inverse_repulsion(distance, rho_m, alpha) : 0.0;
}

double risk(const Obstacle& obstacle, double rho_m, double alpha) noexcept {
  return risk(obstacle.distance_m.value_or(0.0), rho_m, alpha);
}

Eigen::Vector3d repulsive_velocity(const Obstacle& obstacle, const RepulsionSettings& settings) noexcept {
  const double speed = settings.v_max_m_s * risk(obstacle, settings.rho_m, settings.alpha);
  return -speed * direction_of(obstacle, settings.form);
}

}  // namespace depthgrid::control
