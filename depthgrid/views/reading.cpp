#include "depthgrid/views/reading.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "depthgrid/core/rounding.hpp"

namespace depthgrid::views {
namespace {

constexpr float kLargest = std::numeric_limits<float>::max();
constexpr double kUlp = 0x1p-24;  ///< the largest relative error of one rounding in single precision

/// Where D - m(D) is positive, every intermediate result of x (slope - curve x) - constant is at most x times the
/// scale, so its four operations err by at most one kUlp of that each. x times the scale differs from D by one kUlp,
/// that of a value beyond the far limit by two, and D - m(D) by no more than that because its slope is between -1
/// and 1. Together six; half a one covers what double precision loses here.
Reduction make_reduction(const SensorMargin& margin, double metres_per_value) noexcept {
  if (margin.constant_m == 0 && margin.linear == 0 && margin.quadratic_per_m == 0 && metres_per_value == 1) {
    return {1.0F, 0.0F, 0.0F};
  }
  return {rounded_down(metres_per_value * (1.0 - margin.linear - 6.5 * kUlp)),
          rounded_up(metres_per_value * metres_per_value * margin.quadratic_per_m), rounded_up(margin.constant_m)};
}

/// As the vector code has it.
float reduced(const Reduction& r, float x) noexcept {
  const float result_m = x * (r.slope - x * r.curve) - r.constant_m;
  return result_m >= kSmallestReduced ? result_m : 0.0F;
}

}  // namespace

Reading::Reading(const MeasurementRule& rule, double metres_per_unit_in, const SensorMargin& margin)
    : metres_per_unit(metres_per_unit_in),
      invalid_units(rule.invalid_units),
      of_units(make_reduction(margin, metres_per_unit)),
      lowest_m(std::max(nearest_float(rule.near_m), std::numeric_limits<float>::denorm_min())),
      highest_m(std::min(nearest_float(rule.far_m), kLargest)),
      beyond_highest_m(rule.clamp_beyond_far && nearest_float(rule.far_m) <= kLargest ? nearest_float(rule.far_m)
                                                                                      : 0.0F),
      of_metres(make_reduction(margin, 1.0)) {
  // Ask the one place that decides, value by value.
  MeasurementRule without_list = rule;
  without_list.invalid_units.clear();
  const auto depth_m = [&](int units) {
    const auto value = static_cast<std::uint16_t>(units);
    const DepthView pixel{&value, DepthFormat::uint16_units, 1, 1, sizeof value, metres_per_unit};
    return measured_depth_m(pixel, without_list, 0, 0).value_or(0.0F);
  };
  const auto own_depth_m = [&](int units) { return static_cast<float>(static_cast<double>(units) * metres_per_unit); };
  constexpr int kLast = 65534;  // 65535 means saturated
  int low = 1;
  while (low <= kLast && !(depth_m(low) > 0)) {
    ++low;
  }
  int high = kLast;
  while (high >= low && depth_m(high) != own_depth_m(high)) {
    --high;
  }
  lowest_code = static_cast<std::uint16_t>(low);
  highest_unit = static_cast<std::uint16_t>(high);
  beyond_code = static_cast<std::uint16_t>(high + 1);
  beyond_m = high < kLast ? depth_m(kLast) : 0.0F;
  has_beyond = beyond_m > 0;
  beyond_value = rounded_down(static_cast<double>(beyond_m) / metres_per_unit);
  if (has_beyond) {
    invalid_units.push_back(kLast + 1);
  }
  float last_m = 0.0F;
  ascending = true;
  for (int code = low; code <= high + (has_beyond ? 1 : 0); ++code) {
    const float result_m = reduced(of_units, code > high ? beyond_value : static_cast<float>(code));
    ascending = ascending && result_m >= last_m;
    last_m = result_m;
  }
}

std::uint16_t units_not_above(const Reading& reading, double depth_m) noexcept {
  const double steps = depth_m * (1 - 1e-12) / reading.metres_per_unit;
  if (!(steps >= reading.lowest_code)) {
    return 0;
  }
  auto value = static_cast<std::uint16_t>(std::min(steps, static_cast<double>(reading.highest_unit)));
  while (std::ranges::find(reading.invalid_units, value) != reading.invalid_units.end()) {
    --value;
  }
  return value >= reading.lowest_code ? value : std::uint16_t{0};
}

float metres_not_above(const Reading& reading, double depth_m) noexcept {
  const float value = rounded_down(depth_m);
  return value >= reading.lowest_m ? std::min(value, reading.highest_m) : 0.0F;
}

}  // namespace depthgrid::views
