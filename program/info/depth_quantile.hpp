// The middle of many depths over any range.
#pragma once

#include <cstdint>
#include <vector>

namespace depthgrid::program {

/// Bins of one percent from a millimetre to ten kilometres, so that depths in a wrong unit have their place, too; what
/// lies beyond shares the first or the last bin.
class DepthQuantile {
 public:
  /// A depth > 0.
  void add(double depth_m);
  /// The geometric middle of the bin that holds the median; NaN when empty.
  [[nodiscard]] double median_m() const noexcept;

 private:
  std::vector<std::int64_t> bins_;
  std::int64_t count_ = 0;
};

}  // namespace depthgrid::program
