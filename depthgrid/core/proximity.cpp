#include "depthgrid/core/proximity.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid {

std::string_view to_string(ProximityState state) noexcept {
  switch (state) {
    case ProximityState::not_evaluated:
      return "not_evaluated";
    case ProximityState::measured:
      return "measured";
    case ProximityState::occluded:
      return "occluded";
    case ProximityState::unmeasured:
      return "unmeasured";
    case ProximityState::unobserved:
      return "unobserved";
    case ProximityState::outside:
      return "outside";
    case ProximityState::beyond_rho:
      return "beyond_rho";
  }
  return "invalid";
}

std::string_view to_string(Unmeasured why) noexcept {
  switch (why) {
    case Unmeasured::not_told:
      return "not_told";
    case Unmeasured::no_reading:
      return "no_reading";
    case Unmeasured::image_edge:
      return "image_edge";
    case Unmeasured::blind_zone:
      return "blind_zone";
    case Unmeasured::late_image:
      return "late_image";
  }
  return "invalid";
}

bool has_distance(const Proximity& answer) noexcept { return !std::isnan(answer.distance_m); }

double lower_bound_after(const Proximity& answer, double elapsed_s, double v_max_m_s) noexcept {
  if (!has_distance(answer) || !(elapsed_s >= 0) || !(v_max_m_s >= 0)) {
    return Proximity::kNaN;
  }
  // fmin ignores known_to_m where it is NaN, that is where it does not apply.
  return std::max(0.0, std::fmin(answer.distance_m, answer.known_to_m) - v_max_m_s * elapsed_s);
}

}  // namespace depthgrid
