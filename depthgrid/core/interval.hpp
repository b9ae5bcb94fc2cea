// Interval arithmetic in double precision, for bounds over a whole pixel. Internal to the library. Internal.
//
// Results are not rounded outward: they hold up to a relative error of about 1e-15, which callers add or neglect.
#pragma once

#include <algorithm>

namespace depthgrid {

/// All numbers from low to high.
struct Interval {
  double low = 0.0;
  double high = 0.0;

  Interval() = default;
  Interval(double value) : low(value), high(value) {}  // NOLINT(google-explicit-constructor): constants mix freely
  Interval(double low_end, double high_end) : low(low_end), high(high_end) {}

  [[nodiscard]] bool contains(double value) const noexcept { return low <= value && value <= high; }
};

inline Interval operator+(const Interval& a, const Interval& b) noexcept { return {a.low + b.low, a.high + b.high}; }
inline Interval operator-(const Interval& a, const Interval& b) noexcept { return {a.low - b.high, a.high - b.low}; }
inline Interval operator*(const Interval& a, const Interval& b) noexcept {
  const auto [low, high] = std::minmax({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
  return {low, high};
}
/// The divisor must not contain 0.
inline Interval operator/(const Interval& a, const Interval& b) noexcept {
  return a * Interval(1.0 / b.high, 1.0 / b.low);
}

/// Tighter than a * a where a contains 0.
inline Interval square(const Interval& a) noexcept {
  const double low = a.low * a.low;
  const double high = a.high * a.high;
  return {a.contains(0.0) ? 0.0 : std::min(low, high), std::max(low, high)};
}
inline double square(double a) noexcept { return a * a; }

}  // namespace depthgrid
