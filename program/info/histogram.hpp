// Quantiles of many non-negative numbers in little memory.
#pragma once

#include <cstdint>
#include <vector>

namespace depthgrid::program {

/// Bins of half a millimetre from 0 to 2 m; everything beyond shares one last bin.
class Histogram {
 public:
  /// Adds `value_m` `times` times.
  void add(double value_m, std::int64_t times = 1);
  [[nodiscard]] std::int64_t count() const noexcept { return count_; }
  /// The middle of the bin that holds the q-quantile, 0 <= q <= 1; NaN when empty, 2 m when in the last bin.
  [[nodiscard]] double quantile_m(double q) const noexcept;

 private:
  std::vector<std::int64_t> bins_;  // a long recording has more residuals than 32 bits count
  std::int64_t count_ = 0;
};

}  // namespace depthgrid::program
