// What tests say of many deviations.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace depthgrid::test {

/// The value below which `share` of them lie, one that is among them. Not empty.
[[nodiscard]] inline double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

}  // namespace depthgrid::test
