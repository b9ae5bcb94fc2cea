#include "depthgrid/avoidance/nothing_near.hpp"

#include <limits>

namespace depthgrid::avoidance {

void NothingNear::evaluate(std::span<const Capsule> /*capsules*/, double /*now_s*/,
                           std::span<Answer> answers) noexcept {
  for (Answer& answer : answers) {
    answer = Answer{};
    answer.distance_now_m = std::numeric_limits<double>::max();
    answer.blind_m = 0;
  }
}

}  // namespace depthgrid::avoidance
