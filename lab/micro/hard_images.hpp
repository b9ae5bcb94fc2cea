// Images that are hard to search, and the nine points on the arm of the benchmark's cell that are asked.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "depthgrid/search/search.hpp"
#include "lab/micro/slow_scene.hpp"

namespace depthgrid::lab {

/// Images of all cameras, 640 x 480 millimetres each, and what they are asked with.
struct HardImages {
  Rig rig;
  views::Settings settings;
  std::vector<std::vector<std::uint16_t>> images;
};

/// W is the benchmark's cell, unobserved space is an obstacle, nothing else is assumed.
[[nodiscard]] views::Settings hard_settings(int cameras, double pose_error_m);
[[nodiscard]] HardImages hard_images(const SlowScene& scene);
[[nodiscard]] std::unique_ptr<views::ViewStore> stored(const HardImages& hard);

[[nodiscard]] std::vector<Capsule> nine_on_arm();

/// Looks `time_s` seconds for slow scenes by mutation, with a progress line, and prints the slowest.
void hunt_slow_scenes(double time_s, std::uint64_t seed);

}  // namespace depthgrid::lab
