#include "program/info/histogram.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depthgrid::program {

namespace {

constexpr double kBinSize_m = 0.0005;
constexpr std::size_t kBinCount = 4001;

}  // namespace

void Histogram::add(double value_m, std::int64_t times) {
  if (bins_.empty()) {
    bins_.resize(kBinCount);
  }
  const double bin = std::min(std::floor(value_m / kBinSize_m), static_cast<double>(kBinCount - 1));
  bins_[static_cast<std::size_t>(std::max(bin, 0.0))] += times;
  count_ += times;
}

double Histogram::quantile_m(double q) const noexcept {
  if (count_ == 0) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const auto rank = static_cast<std::int64_t>(std::ceil(q * static_cast<double>(count_)));
  std::int64_t below = 0;
  for (std::size_t bin = 0; bin + 1 < kBinCount; ++bin) {
    below += bins_[bin];
    if (below >= rank) {
      return (static_cast<double>(bin) + 0.5) * kBinSize_m;
    }
  }
  return static_cast<double>(kBinCount - 1) * kBinSize_m;
}

}  // namespace depthgrid::program
