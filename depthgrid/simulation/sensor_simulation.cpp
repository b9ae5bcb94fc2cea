#include "depthgrid/simulation/sensor_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/sensor_models.hpp"
#include "depthgrid/simulation/pixel_random.hpp"
#include "depthgrid/simulation/second_view.hpp"
#include "depthgrid/simulation/surface_slant.hpp"

namespace depthgrid::simulation {

namespace {

enum Stream : std::uint64_t { kLateral = 1, kAxial, kDropout, kVibration, kBias };

void require(bool holds, const SensorSimulation& sensor, const char* what, double value) {
  if (!holds) {
    fail("simulation of sensor '", sensor.name, "': ", what, " is ", value, ", out of range");
  }
}

void validate(const SensorSimulation& s) {
  const auto not_negative = [&s](const char* what, double value) {
    require(std::isfinite(value) && value >= 0, s, what, value);
  };
  const auto share = [&s](const char* what, double value) { require(value >= 0 && value <= 1, s, what, value); };
  not_negative("noise_constant_m", s.noise_constant_m);
  not_negative("noise_quadratic_per_m", s.noise_quadratic_per_m);
  not_negative("noise_origin_m", s.noise_origin_m);
  not_negative("noise_slant", s.noise_slant);
  not_negative("lateral_px", s.lateral_px);
  not_negative("lateral_slant_px", s.lateral_slant_px);
  not_negative("lateral_limit_px", s.lateral_limit_px);
  not_negative("step_per_m", s.step_per_m);
  not_negative("bias_constant_m", s.bias_constant_m);
  not_negative("bias_linear", s.bias_linear);
  not_negative("baseline_m", s.baseline_m);
  not_negative("near_m", s.near_m);
  not_negative("vibration_px", s.vibration_px);
  share("flying_share", s.flying_share);
  share("dropout_share", s.dropout_share);
  require(s.patch_px >= 1, s, "patch_px", s.patch_px);
  require(s.far_m > s.near_m, s, "far_m", s.far_m);
  require(s.largest_slant_rad > 0, s, "largest_slant_rad", s.largest_slant_rad);
}

/// Whether the slant of the surface decides anything.
bool asks_slant(const SensorSimulation& s) {
  return s.noise_slant > 0 || s.lateral_slant_px > 0 || s.largest_slant_rad < std::numbers::pi / 2;
}

/// theta / (pi/2 - theta), which grows without limit towards grazing views.
double steepness(double slant_rad) { return slant_rad / std::max(1e-3, std::numbers::pi / 2 - slant_rad); }

/// 0 for a reading that the sensor does not give.
float in_range(const SensorSimulation& s, double reading_m) {
  return reading_m > 0 && reading_m >= s.near_m && reading_m <= s.far_m ? static_cast<float>(reading_m) : 0.0F;
}

/// Of a number of at most a million.
int nearest_integer(double x) {
  constexpr int kShift = 1 << 20;  // so that cutting off is rounding down
  constexpr double kShiftAndHalf = kShift + 0.5;
  return static_cast<int>(x + kShiftAndHalf) - kShift;
}

/// Between -1 and 1 in every pixel, with half a wave to a whole one across the image, another for each seed.
std::vector<float> smooth_pattern(const PinholeCamera& camera, std::uint64_t seed) {
  const PixelRandom random(seed, 0, kBias);
  const auto wave = [&random](std::uint64_t n, double share) {
    return std::cos(std::numbers::pi * (1 + random.uniform(n)) * share + 2 * std::numbers::pi * random.uniform(n + 1));
  };
  std::vector<float> pattern;
  for (int v = 0; v < camera.height_px; ++v) {
    const double down = wave(0, static_cast<double>(v) / camera.height_px);
    for (int u = 0; u < camera.width_px; ++u) {
      pattern.push_back(static_cast<float>(down * wave(2, static_cast<double>(u) / camera.width_px)));
    }
  }
  return pattern;
}

}  // namespace

double noise_sigma_m(const SensorSimulation& s, double depth_m, double slant_rad) noexcept {
  const double beyond = depth_m - s.noise_origin_m;
  const double facing_m = s.noise_constant_m + s.noise_quadratic_per_m * beyond * beyond;
  if (s.noise_slant == 0) {
    return facing_m;
  }
  const double steep = steepness(std::min(slant_rad, s.largest_slant_rad));
  return facing_m + s.noise_slant / std::sqrt(depth_m) * steep * steep;
}

SimulatedSensor::SimulatedSensor(SensorSimulation sensor, const PinholeCamera& camera, std::uint64_t seed)
    : sensor_(std::move(sensor)), camera_(camera), seed_(seed) {
  depthgrid::validate(camera_);
  validate(sensor_);
  hidden_.resize(static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px));
  slant_rad_.resize(hidden_.size());
  if (sensor_.bias_constant_m > 0 || sensor_.bias_linear > 0) {
    bias_ = smooth_pattern(camera_, seed_);
  }
}

double SimulatedSensor::reading_m(double ideal_m, std::size_t source, std::uint64_t dice) const noexcept {
  const SensorSimulation& s = sensor_;
  double z = ideal_m;
  if (s.flying_share > 0 && edges_.is_edge(source)) {
    const std::uint64_t flight = scrambled(dice);
    if (uniform_of(flight, 0) < s.flying_share) {
      z = edges_.near_m(source) + uniform_of(flight, 1) * (edges_.far_m(source) - edges_.near_m(source));
    }
  }
  z += noise_sigma_m(s, z, slant_rad_[source]) * normal_of(dice, 0);
  if (!bias_.empty()) {
    z += (s.bias_constant_m + s.bias_linear * z) * bias_[source];
  }
  if (s.step_per_m > 0 && z > 0) {
    const double steps = std::floor(1 / (z * s.step_per_m) + 0.5);
    z = steps > 0 ? 1 / (steps * s.step_per_m) : 0;
  }
  return z;
}

void SimulatedSensor::look_at(const DepthImage& ideal_m) {
  std::fill(hidden_.begin(), hidden_.end(), std::uint8_t{0});
  if (sensor_.baseline_m > 0) {
    mark_hidden_from_second_view(camera_, ideal_m, sensor_.baseline_m, hidden_);
  }
  if (asks_slant(sensor_)) {
    surface_slants(camera_, ideal_m, slant_rad_);
  }
  if (sensor_.flying_share > 0) {
    edges_.update(ideal_m);
  }
}

int SimulatedSensor::beside(int at, double sigma_px, float normal, double shake_px, int size_px) const noexcept {
  const double offset_px = std::clamp(sigma_px * normal, -sensor_.lateral_limit_px, sensor_.lateral_limit_px);
  return std::clamp(nearest_integer(at + offset_px + shake_px), 0, size_px - 1);
}

void SimulatedSensor::measure(const DepthImage& ideal_m, std::uint64_t frame, DepthImage& measured_m) {
  if (ideal_m.width_px() != camera_.width_px || ideal_m.height_px() != camera_.height_px) {
    fail("ideal image is ", ideal_m.width_px(), " x ", ideal_m.height_px(), " px, must be the camera's ",
         camera_.width_px, " x ", camera_.height_px);
  }
  if (measured_m.width_px() != camera_.width_px || measured_m.height_px() != camera_.height_px) {
    measured_m = DepthImage(camera_.width_px, camera_.height_px);
  }
  look_at(ideal_m);
  const SensorSimulation& s = sensor_;
  const PixelRandom lateral(seed_, frame, kLateral);
  const PixelRandom axial(seed_, frame, kAxial);
  const PixelRandom dropout(seed_, frame, kDropout);
  const std::uint64_t shake = PixelRandom(seed_, frame, kVibration).bits(0);
  const double shake_u = s.vibration_px * (2 * uniform_of(shake, 0) - 1) / std::numbers::sqrt2;
  const double shake_v = s.vibration_px * (2 * uniform_of(shake, 1) - 1) / std::numbers::sqrt2;
  const bool displaced = s.lateral_px > 0 || s.lateral_slant_px > 0 || s.vibration_px > 0;
  for (int v = 0; v < camera_.height_px; ++v) {
    for (int u = 0; u < camera_.width_px; ++u) {
      const std::size_t pixel = ideal_m.index(u, v);
      const std::size_t patch = s.patch_px == 1 ? pixel : ideal_m.index(u / s.patch_px, v / s.patch_px);
      std::size_t source = pixel;  // the ideal pixel that this one shows
      if (displaced) {
        const std::uint64_t aside = lateral.bits(patch);
        const double slant_rad = std::min<double>(slant_rad_[pixel], s.largest_slant_rad);
        const double sigma_px = s.lateral_px + s.lateral_slant_px * steepness(slant_rad);
        source = ideal_m.index(beside(u, sigma_px, normal_of(aside, 0), shake_u, camera_.width_px),
                               beside(v, sigma_px, normal_of(aside, 1), shake_v, camera_.height_px));
      }
      const bool lost = s.dropout_share > 0 && dropout.uniform(pixel) < s.dropout_share;
      const bool seen = ideal_m.data()[source] > 0 && hidden_[source] == 0 && slant_rad_[source] <= s.largest_slant_rad;
      measured_m.data()[pixel] =
          seen && !lost ? in_range(s, reading_m(ideal_m.data()[source], source, axial.bits(patch))) : 0.0F;
    }
  }
}

std::vector<std::uint16_t> in_units(const DepthImage& depth_m, double metres_per_unit) {
  if (!(metres_per_unit > 0)) {
    fail("metres per unit is ", metres_per_unit, ", must be positive");
  }
  constexpr double kLargest = 65534;  // 65535 means saturated
  const std::size_t pixels =
      static_cast<std::size_t>(depth_m.width_px()) * static_cast<std::size_t>(depth_m.height_px());
  std::vector<std::uint16_t> units(pixels);
  std::transform(depth_m.data(), depth_m.data() + pixels, units.begin(), [metres_per_unit](float z) {
    const double steps = std::round(z / metres_per_unit);
    return steps > 0 && steps <= kLargest ? static_cast<std::uint16_t>(steps) : std::uint16_t{0};
  });
  return units;
}

}  // namespace depthgrid::simulation
