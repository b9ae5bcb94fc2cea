#include <algorithm>
#include <limits>

#include "world/draw.hpp"

namespace depthgrid::world {

void draw_exposures(World& world) {
  Random random(world.options.seed, 5);
  const bool together = random.chance(0.2);
  const double common_period_s = random.uniform(0.06, 0.16);
  Random breaking(world.options.seed, 93);
  const auto wrong = static_cast<std::size_t>(breaking.integer(0, static_cast<int>(world.cameras.size()) - 1));
  for (std::size_t k = 0; k < world.cameras.size(); ++k) {
    const CameraMargins& margins = world.settings.margins[k];
    const double period_s = together ? common_period_s : random.uniform(0.06, 0.16);
    const double phase_s = together ? 0.0 : random.uniform(0, period_s);
    const double latency_s = random.uniform(0, 0.08);
    const double dropped = random.chance(0.5) ? 0.0 : random.uniform(0, 0.1);
    const double late = random.chance(0.7) ? 0.0 : random.uniform(0, 0.1);
    const double offset_s = random.uniform(-1, 1) * margins.time_uncertainty_s;
    const double silent_from_s =
        random.chance(0.8) ? std::numeric_limits<double>::infinity() : random.uniform(0, world.duration_s);
    const double silent_to_s = silent_from_s + random.uniform(0.3, 2);
    const double wrong_s = (breaking.chance(0.5) ? 1 : -1) * breaking.uniform(0.1, 0.5);
    const bool is_wrong = world.options.broken == Broken::clock && k == wrong;
    for (int n = 0; phase_s + n * period_s < world.duration_s; ++n) {
      Exposure exposure;
      exposure.camera = k;
      exposure.number = n;
      exposure.mid_s = phase_s + (n + (together ? 0.0 : random.uniform(0, 0.2))) * period_s;
      const double stamp_error_s =
          0.5 * (offset_s + random.uniform(-1, 1) * margins.time_uncertainty_s) + (is_wrong ? wrong_s : 0.0);
      exposure.stamp_s = exposure.mid_s + stamp_error_s;
      exposure.arrival_s = exposure.mid_s + margins.half_exposure_s + latency_s + random.uniform(0, 0.01) +
                           (random.chance(late) ? random.uniform(0.05, 0.4) : 0.0);
      if (!random.chance(dropped) && !(exposure.mid_s > silent_from_s && exposure.mid_s < silent_to_s)) {
        world.exposures.push_back(exposure);
      }
    }
  }
  std::stable_sort(world.exposures.begin(), world.exposures.end(),
                   [](const Exposure& a, const Exposure& b) { return a.arrival_s < b.arrival_s; });
}

}  // namespace depthgrid::world
