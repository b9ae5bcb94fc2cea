#include "depthgrid/views/surveillance_radius.hpp"

#include <cmath>

#include "depthgrid/core/error.hpp"

namespace depthgrid::views {

double surveillance_radius_m(double rho_m, double v_max_m_s, double greatest_age_s, double blind_m) {
  const double radius_m = rho_m + v_max_m_s * greatest_age_s + blind_m;
  if (!(rho_m > 0 && v_max_m_s >= 0 && greatest_age_s >= 0 && blind_m >= 0 && std::isfinite(radius_m))) {
    fail("surveillance radius: rho is ", rho_m, " m, must be positive; v_max is ", v_max_m_s, " m/s, the greatest age ",
         greatest_age_s, " s, the blind layer ", blind_m, " m, must not be negative; all must be finite");
  }
  return radius_m;
}

}  // namespace depthgrid::views
