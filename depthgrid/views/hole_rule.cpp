#include "depthgrid/views/hole_rule.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "depthgrid/core/error.hpp"

namespace depthgrid::views {
namespace {

/// What is nearer than this in a hole is not told from nothing: so wide need no hole be looked at.
constexpr double kNearestTold_m = 0.25;

double checked_size(double smallest_obstacle_m) {
  if (!(smallest_obstacle_m > 0) || !std::isfinite(smallest_obstacle_m)) {
    throw Error("the smallest obstacle is " + std::to_string(smallest_obstacle_m) +
                " m, must be positive and finite (0.02 for instance)");
  }
  return smallest_obstacle_m;
}

/// The focal length that tells how narrow a ball's image may be at a place of its rim. Away from the axis the image is
/// an ellipse, with a radius of curvature at its tips that is less by the cosine of the angle; in unlike focal lengths,
/// too.
double focal_of_tips_px(const PinholeCamera& c) {
  const double smaller = std::min(c.fx_px, c.fy_px);
  const double larger = std::max(c.fx_px, c.fy_px);
  const double x = std::max(c.cx_px, c.width_px - c.cx_px) / c.fx_px;
  const double y = std::max(c.cy_px, c.height_px - c.cy_px) / c.fy_px;
  return smaller * smaller / larger / std::sqrt(1 + x * x + y * y);
}

std::vector<HoleLevel> levels_for(double focal_px, double size_m, double near_m) {
  return hole_levels(size_m * focal_px / (std::max(near_m, kNearestTold_m) + size_m / 2));
}

}  // namespace

/// What the codes of HoleImage::least stand for.
struct HoleRule::CodeScale {
  double step_m;
  int first;        ///< step of code 0
  int beyond_step;  ///< 0: no reading is beyond the far limit
  double beyond_m;

  [[nodiscard]] double depth_m(std::size_t code) const noexcept {
    const int step = static_cast<int>(code) + first;
    return step == beyond_step ? beyond_m : step * step_m;
  }
};

HoleRule::HoleRule(const PinholeCamera& camera, double metres_per_unit, const MeasurementRule& rule,
                   const SensorMargin& margin, double smallest_obstacle_m)
    : focal_px_(focal_of_tips_px(camera)),
      size_m_(checked_size(smallest_obstacle_m)),
      margin_(margin),
      reading_(rule, metres_per_unit, margin),
      image_(camera.width_px, camera.height_px, levels_for(focal_px_, size_m_, rule.near_m)) {
  for (const HoleLevel& level : image_.levels) {
    windows_.push_back({level.window_px, least_level(level.window_px)});
  }
  const CodeScale units{reading_.metres_per_unit, 1, reading_.has_beyond ? reading_.beyond_code : 0,
                        static_cast<double>(reading_.beyond_m)};
  const CodeScale metres{HoleImage::kFloatStep, 0, 0, 0.0};
  prepare(units, units_not_above, of_units_);
  prepare(metres, metres_not_above, of_metres_);
}

template <class Value, class Written>
void HoleRule::prepare(const CodeScale& scale, const Written& written, Format<Value>& format) {
  format.filled.resize(image_.level.size());
  format.of_code.resize(kNoReading);
  for (std::size_t code = 0; code < kNoReading; ++code) {
    format.of_code[code] = written(reading_, depth_m(scale.depth_m(code)));
  }
  format.of_level.reserve(image_.levels.size());
  for (const HoleLevel& level : image_.levels) {
    const bool too_wide = &level == &image_.levels.back();
    // Readings may stand w columns beside their place, so a hole is narrower than what gives no reading by twice that.
    const double bound_m = too_wide ? 0.0 : size_m_ * focal_px_ / (level.width_px + 2 * margin_.lateral_px);
    std::size_t first_code = 0;
    while (first_code < kNoReading && scale.depth_m(first_code) < bound_m) {
      ++first_code;
    }
    format.of_level.push_back(
        {static_cast<std::uint16_t>(first_code), too_wide ? Value{0} : written(reading_, depth_m(bound_m))});
  }
}

double HoleRule::width_px(int u, int v) const noexcept {
  const auto column = static_cast<std::size_t>(u);
  const std::size_t word = image_.words_per_row * static_cast<std::size_t>(v) + column / 64;
  if ((image_.missing[word] >> (column % 64) & 1U) == 0) {
    return 0.0;
  }
  const std::size_t n = image_.level[static_cast<std::size_t>(v) * static_cast<std::size_t>(image_.width_px) + column];
  return n + 1 == image_.levels.size() ? std::numeric_limits<double>::infinity() : image_.levels[n].width_px;
}

double HoleRule::depth_m(double bound_m) const noexcept {
  // m grows by at most this a metre below the bound, so it is subtracted in full afterwards.
  const double growth = margin_.linear + 2 * margin_.quadratic_per_m * bound_m;
  if (growth <= 0) {
    return bound_m - size_m_ / 2;
  }
  return growth < 1 ? bound_m - size_m_ / 2 / (1 - growth) : 0.0;
}

template <class Value>
Value HoleRule::value(int u, int v, std::size_t level, const Format<Value>& format) const noexcept {
  const Window& window = windows_[level];
  const int w = window.half_px;
  if (u < w || v < w || u + w >= image_.width_px || v + w >= image_.height_px) {
    return 0;
  }
  const int n = window.texels;
  const LeastLevel& least = image_.least[static_cast<std::size_t>(n)];
  const int i0 = (u - w) >> n;
  const int i1 = std::max(i0, ((u + w) >> n) - 3);
  const int j0 = (v - w) >> n;
  const int j1 = std::max(j0, ((v + w) >> n) - 3);
  const auto at = [&](int i, int j) {
    return least
        .texels[static_cast<std::size_t>(j) * static_cast<std::size_t>(least.width) + static_cast<std::size_t>(i)];
  };
  const std::uint16_t code = std::min(std::min(at(i0, j0), at(i1, j0)), std::min(at(i0, j1), at(i1, j1)));
  const auto& bound = format.of_level[level];
  return code < bound.first_code ? format.of_code[code] : bound.value;
}

template <class Value>
const Value* HoleRule::fill(const DepthView& depth, std::span<const HoleBounds> bounds,
                            Format<Value>& format) noexcept {
  const auto width = static_cast<std::size_t>(image_.width_px);
  for (int v = 0; v < image_.height_px; ++v) {
    const std::size_t row = static_cast<std::size_t>(v) * width;
    std::memcpy(format.filled.data() + row, static_cast<const char*>(depth.data) + depth.stride_bytes * v,
                width * sizeof(Value));
    for (std::size_t i = 0; i < image_.words_per_row; ++i) {
      for (std::uint64_t word = image_.missing[static_cast<std::size_t>(v) * image_.words_per_row + i]; word != 0;
           word &= word - 1) {
        const std::size_t u = 64 * i + static_cast<std::size_t>(std::countr_zero(word));
        const std::size_t level = image_.level[row + u];
        format.filled[row + u] = level + 1 < windows_.size() ? value(static_cast<int>(u), v, level, format) : Value{0};
      }
    }
  }
  for (const HoleBounds& bound : bounds) {
    Value& filled = format.filled[bound.pixel];
    filled = std::max(static_cast<Value>(bound.least), std::min(filled, static_cast<Value>(bound.most)));
  }
  return format.filled.data();
}

DepthView HoleRule::fill(const DepthView& depth, std::span<const HoleBounds> bounds) noexcept {
  find_holes(reading_, depth, image_);
  DepthView filled = depth;
  filled.stride_bytes = row_bytes(depth.format, image_.width_px);
  filled.data = depth.format == DepthFormat::uint16_units ? static_cast<const void*>(fill(depth, bounds, of_units_))
                                                          : fill(depth, bounds, of_metres_);
  return filled;
}

}  // namespace depthgrid::views
