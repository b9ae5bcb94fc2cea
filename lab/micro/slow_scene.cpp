#include "lab/micro/slow_scene.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>

#include "depthgrid/core/error.hpp"

namespace depthgrid::lab {
namespace {

constexpr int kWide = 640;
constexpr int kHigh = 480;

struct Field {
  const char* name;
  double SlowScene::*value;
  double low;
  double high;
};

constexpr std::array<Field, 12> kFields{{{"cameras", &SlowScene::cameras, 2, 8.999},
                                         {"wall_m", &SlowScene::wall_m, 0.6, 6},
                                         {"tilt_m", &SlowScene::tilt_m, -3, 3},
                                         {"stripe_px", &SlowScene::stripe_px, 0, 64},
                                         {"stripe_m", &SlowScene::stripe_m, 0.5, 6},
                                         {"speck_share", &SlowScene::speck_share, 0, 0.2},
                                         {"speck_px", &SlowScene::speck_px, 1, 24},
                                         {"speck_near_m", &SlowScene::speck_near_m, 0.3, 4},
                                         {"speck_far_m", &SlowScene::speck_far_m, 0.3, 6},
                                         {"noise_m", &SlowScene::noise_m, 0, 0.2},
                                         {"missing_share", &SlowScene::missing_share, 0, 0.1},
                                         {"pose_error_m", &SlowScene::pose_error_m, 0, 0.03}}};

double share_of(std::mt19937_64& generator) { return static_cast<double>(generator() >> 11U) * 0x1p-53; }

/// Uniform in [0, 1), the same on every machine.
double hashed(std::uint64_t seed, int k, int what, int u, int v) {
  std::uint64_t x = seed;
  for (const int part : {k, what, u, v}) {
    x += 0x9E3779B97F4A7C15U + static_cast<std::uint64_t>(part);
    x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9U;
    x = (x ^ (x >> 27U)) * 0x94D049BB133111EBU;
    x ^= x >> 31U;
  }
  return static_cast<double>(x >> 11U) * 0x1p-53;
}

double depth_m(const SlowScene& scene, int k, int u, int v) {
  if (hashed(scene.seed, k, 0, u, v) < scene.missing_share) {
    return 0;
  }
  double depth_m = scene.wall_m + scene.tilt_m * (u / static_cast<double>(kWide) - 0.5);
  const int stripe_px = static_cast<int>(scene.stripe_px);
  if (stripe_px > 0 && u / stripe_px % 2 == 1) {
    depth_m = scene.stripe_m;
  }
  const int speck_px = std::max(1, static_cast<int>(scene.speck_px));
  if (hashed(scene.seed, k, 1, u / speck_px, v / speck_px) < scene.speck_share) {
    const double part = hashed(scene.seed, k, 2, u / speck_px, v / speck_px);
    depth_m = scene.speck_near_m + part * (scene.speck_far_m - scene.speck_near_m);
  }
  return depth_m + scene.noise_m * (2 * hashed(scene.seed, k, 3, u, v) - 1);
}

}  // namespace

std::string to_text(const SlowScene& scene) {
  std::ostringstream text;
  text.precision(6);
  text << "seed=" << scene.seed;
  for (const Field& field : kFields) {
    text << ' ' << field.name << '=' << scene.*field.value;
  }
  return text.str();
}

SlowScene scene_from_text(const std::string& text) {
  SlowScene scene;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::size_t at = word.find('=');
    const std::string name = word.substr(0, at);
    const char* const begin = at == std::string::npos ? nullptr : word.data() + at + 1;
    const char* const end = word.data() + word.size();
    const auto field =
        std::find_if(kFields.begin(), kFields.end(), [&name](const Field& known) { return name == known.name; });
    std::from_chars_result read{begin, std::errc::invalid_argument};
    if (begin != nullptr && name == "seed") {
      read = std::from_chars(begin, end, scene.seed);
    } else if (begin != nullptr && field != kFields.end()) {
      read = std::from_chars(begin, end, scene.*field->value);
    }
    const bool known = read.ec == std::errc() && read.ptr == end;
    if (!known ||
        (field != kFields.end() && !(scene.*field->value >= field->low && scene.*field->value <= field->high))) {
      fail("a slow scene: '", word, "' is no field with a value that it may have; for instance: ", to_text({}));
    }
  }
  return scene;
}

SlowScene mutated(const SlowScene& scene, std::mt19937_64& generator) {
  SlowScene changed = scene;
  changed.seed = 1 + generator() % 1000;
  const std::size_t fields = 1 + generator() % 3;
  for (std::size_t i = 0; i < fields; ++i) {
    const Field& field = kFields[generator() % kFields.size()];
    double& value = changed.*field.value;
    const double anew = field.low + share_of(generator) * (field.high - field.low);
    const double step = value * std::exp2(2 * share_of(generator) - 1);
    // Written and read back as it will be kept.
    value = std::clamp(generator() % 2 == 0 ? anew : step, field.low, field.high);
  }
  return scene_from_text(to_text(changed));
}

std::vector<std::uint16_t> image_of(const SlowScene& scene, int k) {
  std::vector<std::uint16_t> image(static_cast<std::size_t>(kWide) * kHigh);
  for (int v = 0; v < kHigh; ++v) {
    for (int u = 0; u < kWide; ++u) {
      const double depth_mm = std::clamp(1e3 * depth_m(scene, k, u, v), 0.0, 65535.0);
      image[static_cast<std::size_t>(v) * kWide + static_cast<std::size_t>(u)] = static_cast<std::uint16_t>(depth_mm);
    }
  }
  return image;
}

}  // namespace depthgrid::lab
