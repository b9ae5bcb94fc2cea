#include "depthgrid/core/margin.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "depthgrid/core/error.hpp"

namespace depthgrid {
namespace {

constexpr int kMaxFilterRadius = 16;

void check_part(const char* name, const char* part, double value, const char* unit) {
  if (!(std::isfinite(value) && value >= 0)) {
    fail(name, ": ", part, " is ", value, unit, ", must be a finite number that is not negative");
  }
}

/// The largest float that does not exceed a value >= 0; values below 1e-30 (and NaN) become 0. Clearing the bits of
/// the mantissa that a float does not have truncates, after which the conversion is exact; unlike a change of the
/// rounding mode this vectorises.
inline float round_towards_zero(double value) noexcept {
  const double kept = value >= 1e-30 ? value : 0.0;
  constexpr std::uint64_t kFloatBits = ~((std::uint64_t{1} << 29) - 1);
  return static_cast<float>(std::bit_cast<double>(std::bit_cast<std::uint64_t>(kept) & kFloatBits));
}

/// The margin, enlarged so that the rounding of D - m(D) in double precision never shows the result above the exact
/// value: the products and sums of m err by less than 2^-50 of m, the difference by less than 2^-50 of D. A margin of
/// zero stays zero, for which D - m is exact.
SensorMargin cover_rounding(const SensorMargin& margin) noexcept {
  if (margin.constant_m == 0.0 && margin.linear == 0.0 && margin.quadratic_per_m == 0.0) {
    return margin;
  }
  constexpr double kRounding = 0x1p-50;
  return {margin.constant_m * (1.0 + kRounding), margin.linear * (1.0 + kRounding) + kRounding,
          margin.quadratic_per_m * (1.0 + kRounding), margin.lateral_px};
}

/// D - m(D), never above the exact value; 0 for no measurement.
void reduce_row(const float* measured_m, const SensorMargin& margin, int width_px, float* reduced_m) noexcept {
  const SensorMargin m = margin;  // a copy, so that the compiler knows that the result does not change it
  for (int u = 0; u < width_px; ++u) {
    const auto depth_m = static_cast<double>(measured_m[u]);
    reduced_m[u] = round_towards_zero(depth_m - depth_margin_m(m, depth_m));
  }
}

/// Robot pixels get the robot's exit. An exit that is not finite is no exit: the pixel stays what it was.
void apply_robot_row(const float* measured_m, const float* near_m, const float* far_m, const SensorMargin& margin,
                     int width_px, float* reduced_m) noexcept {
  const SensorMargin m = margin;
  constexpr float kLargest = std::numeric_limits<float>::max();
  for (int u = 0; u < width_px; ++u) {
    const auto depth_m = static_cast<double>(measured_m[u]);
    const auto near = static_cast<double>(near_m[u]);
    // One selection after the other instead of `and`, so that the loop vectorises.
    float result_m = std::max(reduced_m[u], far_m[u]);
    result_m = measured_m[u] > 0.0F ? result_m : reduced_m[u];
    result_m = near > 0.0 ? result_m : reduced_m[u];
    result_m = near <= depth_m - depth_margin_m(m, depth_m) ? result_m : reduced_m[u];
    result_m = measured_m[u] <= far_m[u] ? result_m : reduced_m[u];
    result_m = far_m[u] <= kLargest ? result_m : reduced_m[u];
    reduced_m[u] = result_m;
  }
}

inline void minimum_into(const float* __restrict other, int count, float* __restrict result) noexcept {
  for (int i = 0; i < count; ++i) {
    result[i] = std::min(result[i], other[i]);
  }
}

/// Minimum over the 2 w + 1 neighbours in the row; 0 where they leave it.
void filter_row(const float* source, int width_px, int radius_px, float* result) noexcept {
  const int inner = width_px - 2 * radius_px;
  if (inner <= 0) {
    std::fill_n(result, width_px, 0.0F);
    return;
  }
  std::fill_n(result, radius_px, 0.0F);
  std::copy_n(source, inner, result + radius_px);
  for (int offset = 1; offset <= 2 * radius_px; ++offset) {
    minimum_into(source + offset, inner, result + radius_px);
  }
  std::fill_n(result + width_px - radius_px, radius_px, 0.0F);
}

}  // namespace

void validate(const SensorMargin& margin, const char* name) {
  check_part(name, "constant", margin.constant_m, " m");
  check_part(name, "linear", margin.linear, "");
  check_part(name, "quadratic", margin.quadratic_per_m, " 1/m");
  if (margin.lateral_px < 0 || margin.lateral_px > kMaxFilterRadius) {
    fail(name, ": filter radius is ", margin.lateral_px, " px, must be between 0 and ", kMaxFilterRadius);
  }
}

void validate(const PoseMargin& margin, const char* name) {
  check_part(name, "translation", margin.translation_m, " m");
  check_part(name, "rotation", margin.rotation_rad, " rad");
  check_part(name, "time", margin.time_m, " m");
}

void validate(const CameraMargins& margins, const char* name) {
  validate(margins.sensor, name);
  check_part(name, "translation", margins.translation_m, " m");
  check_part(name, "rotation", margins.rotation_rad, " rad");
  check_part(name, "half exposure", margins.half_exposure_s, " s");
  check_part(name, "time uncertainty", margins.time_uncertainty_s, " s");
  if (!std::isnan(margins.smallest_obstacle_m)) {
    check_part(name, "smallest obstacle", margins.smallest_obstacle_m, " m");
  }
  check_part(name, "distance of the second view", std::abs(margins.second_view_x_m), " m");
}

FreeDepth::FreeDepth(int width_px, int height_px, const SensorMargin& margin)
    : margin_(margin),
      reduced_m_(width_px, height_px),
      row_minimum_m_(width_px, height_px),
      free_m_(width_px, height_px) {
  validate(margin);
}

void FreeDepth::update(const DepthImage& measured, const RobotView& robot) noexcept {
  const int width_px = free_m_.width_px();
  const int height_px = free_m_.height_px();
  const int radius_px = margin_.lateral_px;
  const SensorMargin rounded_up = cover_rounding(margin_);
  if (measured.width_px() != width_px || measured.height_px() != height_px) {
    std::fill_n(free_m_.data(), free_m_.index(0, height_px), 0.0F);
    return;
  }
  DepthImage& reduced_m = radius_px == 0 ? free_m_ : reduced_m_;
  for (int v = 0; v < height_px; ++v) {
    const float* measured_m = measured.data() + measured.index(0, v);
    float* row_m = reduced_m.data() + reduced_m.index(0, v);
    reduce_row(measured_m, rounded_up, width_px, row_m);
    if (robot.near_m != nullptr) {
      apply_robot_row(measured_m, robot.near_m + v * robot.stride_px, robot.far_m + v * robot.stride_px, margin_,
                      width_px, row_m);
    }
    if (radius_px > 0) {
      filter_row(row_m, width_px, radius_px, row_minimum_m_.data() + row_minimum_m_.index(0, v));
    }
  }
  if (radius_px == 0) {
    return;
  }
  for (int v = 0; v < height_px; ++v) {
    float* result_m = free_m_.data() + free_m_.index(0, v);
    if (v < radius_px || v >= height_px - radius_px) {
      std::fill_n(result_m, width_px, 0.0F);
      continue;
    }
    std::copy_n(row_minimum_m_.data() + row_minimum_m_.index(0, v - radius_px), width_px, result_m);
    for (int other = v - radius_px + 1; other <= v + radius_px; ++other) {
      minimum_into(row_minimum_m_.data() + row_minimum_m_.index(0, other), width_px, result_m);
    }
  }
}

}  // namespace depthgrid
