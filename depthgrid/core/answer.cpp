#include "depthgrid/core/answer.hpp"

namespace depthgrid {

double clear_of_layer_m(const Answer& answer) noexcept {
  const double clear_m = answer.distance_now_m - answer.blind_m;
  return clear_m < 0 ? 0 : clear_m;  // NaN stays NaN
}

}  // namespace depthgrid
