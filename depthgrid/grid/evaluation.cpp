#include "depthgrid/grid/evaluation.hpp"

#include <cmath>

#include "depthgrid/core/error.hpp"

namespace depthgrid::grid {

void validate(const EvaluationSettings& settings) {
  const auto within = [](const char* name, double value, double low, double high) {
    if (!(value >= low && value <= high)) {
      fail("evaluation settings: ", name, " is ", value, ", must be between ", low, " and ", high);
    }
  };
  if (!(std::isfinite(settings.rho_m) && settings.rho_m > 0)) {
    fail("evaluation settings: rho is ", settings.rho_m, " m, must be a positive finite number");
  }
  within("direction_blend", settings.direction_blend, 0, 1);
  within("repulsion_alpha", settings.repulsion_alpha, 0, kLargestAlpha);
  if (!(settings.max_frame_age_s >= 0)) {
    fail("evaluation settings: max_frame_age is ", settings.max_frame_age_s, " s, must not be negative");
  }
  if (!(settings.max_image_age_s > 0 && settings.max_image_age_s <= 3600)) {
    fail("evaluation settings: max_image_age is ", settings.max_image_age_s, " s, must be above 0 and at most 3600");
  }
  if (settings.memory && settings.variant == Variant::letter) {
    fail(
        "evaluation settings: a memory with the variant letter, whose distances may be too large: what nothing can be "
        "in "
        "does not mend them; take the variant corrected, or the search");
  }
  depthgrid::validate(settings.sensor);
  depthgrid::validate(settings.pose);
}

}  // namespace depthgrid::grid
