#include "depthgrid/avoidance/distance_source.hpp"

#include <limits>

namespace depthgrid::avoidance {

bool NoDistances::take(std::span<const Frame> /*frames*/) noexcept { return true; }

void NoDistances::evaluate(std::span<const Capsule> parts_world, double /*now_s*/,
                           std::span<PartAnswer> answers) noexcept {
  for (std::size_t i = 0; i < answers.size(); ++i) {
    answers[i] = PartAnswer{};
    answers[i].obstacle.distance_m = std::numeric_limits<double>::max();
    answers[i].at_world = parts_world[i].a;
  }
}

}  // namespace depthgrid::avoidance
