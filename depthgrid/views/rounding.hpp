// Rounding to single precision in a chosen direction. Internal.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace depthgrid::views {

/// The largest float that is not above the value; values beyond all finite floats count as the outermost of these.
inline float rounded_down(double value) noexcept {
  constexpr float kLargest = std::numeric_limits<float>::max();
  const auto nearest = static_cast<float>(std::clamp(value, -static_cast<double>(kLargest), double{kLargest}));
  return static_cast<double>(nearest) > value ? std::nextafter(nearest, -kLargest) : nearest;
}

/// The smallest float that is not below the value, likewise.
inline float rounded_up(double value) noexcept { return -rounded_down(-value); }

}  // namespace depthgrid::views
