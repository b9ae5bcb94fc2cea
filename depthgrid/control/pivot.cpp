#include "depthgrid/control/pivot.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "depthgrid/control/obstacle.hpp"
#include "depthgrid/core/error.hpp"

namespace depthgrid::control {

void validate(const PivotSettings& settings) {
  if (!(std::isfinite(settings.rate_m_s2) && settings.rate_m_s2 > 0)) {
    fail("pivot: rate is ", settings.rate_m_s2, " m/s^2, must be greater than 0 and finite");
  }
  if (!(std::isfinite(settings.c) && settings.c > 0)) {
    fail("pivot: c is ", settings.c, ", must be greater than 0 and finite");
  }
}

Eigen::Vector3d pivoted(const Eigen::Vector3d& repulsion_m_s, const Eigen::Vector3d& before_m_s, double period_s,
                        const PivotSettings& settings) noexcept {
  constexpr double kRightAngle = 0.5 * std::numbers::pi;
  if (!(period_s > 0)) {
    return repulsion_m_s;
  }
  const Eigen::Vector3d rate = (repulsion_m_s - before_m_s) / period_s;
  const auto a = unit_vector(rate);
  const auto r = unit_vector(repulsion_m_s);
  if (!a || !r) {
    return repulsion_m_s;
  }
  const auto w = unit_vector(a->cross(*r).cross(*a));
  const double beta = std::acos(std::clamp(a->dot(*r), -1.0, 1.0));
  if (!w || beta >= kRightAngle) {
    return repulsion_m_s;
  }
  const double x = 2.0 * rate.norm() / settings.rate_m_s2 - 1.0;
  const double gamma = beta + (beta - kRightAngle) / (1.0 + std::exp(-settings.c * x));
  return repulsion_m_s.norm() * (std::cos(gamma) * *a + std::sin(gamma) * *w);
}

}  // namespace depthgrid::control
