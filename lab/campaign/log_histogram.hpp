// The distribution of a positive quantity over many decades, in constant memory.
#pragma once

#include <array>
#include <cstdint>

namespace depthgrid::lab {

/// 20 bins a decade from 1e-6 to 100: quantiles are at most 12 % too large, the maximum is exact.
class LogHistogram {
 public:
  static constexpr int kBinsPerDecade = 20;
  static constexpr double kLowest = 1e-6;
  /// The first bin holds everything up to kLowest (and what is negative), the last everything beyond the others.
  static constexpr int kBins = 8 * kBinsPerDecade + 2;

  void add(double value);
  void add(const LogHistogram& other);
  [[nodiscard]] std::int64_t count() const;
  /// Upper end of the bin that holds this share of the values, at most the maximum; NaN when it is empty.
  [[nodiscard]] double quantile(double share) const;
  [[nodiscard]] double maximum() const { return maximum_; }

  [[nodiscard]] const std::array<std::int64_t, kBins>& bins() const { return bins_; }
  [[nodiscard]] static LogHistogram from(const std::array<std::int64_t, kBins>& bins, double maximum);

 private:
  std::array<std::int64_t, kBins> bins_{};
  double maximum_ = 0;
};

}  // namespace depthgrid::lab
