// Columns (or rows) of pixels. Internal.
#pragma once

#include <algorithm>
#include <limits>

namespace depthgrid::views {

/// Columns or rows [begin, end); without an argument none.
struct PixelRange {
  int begin = std::numeric_limits<int>::max();
  int end = 0;
  [[nodiscard]] bool empty() const noexcept { return begin >= end; }
};

/// The smallest range that holds both, of ranges that are either not empty or none.
[[nodiscard]] inline PixelRange joined(const PixelRange& a, const PixelRange& b) noexcept {
  return {std::min(a.begin, b.begin), std::max(a.end, b.end)};
}

/// What lies in both; none if nothing does.
[[nodiscard]] inline PixelRange common(const PixelRange& a, const PixelRange& b) noexcept {
  const PixelRange both{std::max(a.begin, b.begin), std::min(a.end, b.end)};
  return both.empty() ? PixelRange{} : both;
}

}  // namespace depthgrid::views
