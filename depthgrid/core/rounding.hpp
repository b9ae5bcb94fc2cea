// Rounding to single precision in a chosen direction. Internal.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace depthgrid {

/// The nearest float; beyond the largest one it is infinite.
inline float nearest_float(double value) noexcept {
  return value > std::numeric_limits<float>::max() ? std::numeric_limits<float>::infinity() : static_cast<float>(value);
}

/// The largest float that is not above the value; values beyond all finite floats count as the outermost of these.
inline float rounded_down(double value) noexcept {
  constexpr float kLargest = std::numeric_limits<float>::max();
  const auto nearest = static_cast<float>(std::clamp(value, -static_cast<double>(kLargest), double{kLargest}));
  return static_cast<double>(nearest) > value ? std::nextafter(nearest, -kLargest) : nearest;
}

/// The smallest float that is not below the value, likewise.
inline float rounded_up(double value) noexcept { return -rounded_down(-value); }

/// A float above the value, by up to two steps: where a guard has to be more than nothing.
inline float float_above(double value) noexcept {
  return std::nextafter(static_cast<float>(value), std::numeric_limits<float>::infinity());
}

/// A float below the value, likewise.
inline float float_below(double value) noexcept { return -float_above(-value); }

}  // namespace depthgrid
