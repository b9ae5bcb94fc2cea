#include "lab/campaign/log_histogram.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace depthgrid::lab {

void LogHistogram::add(double value) {
  const double bin = value > kLowest ? 1 + std::floor(kBinsPerDecade * std::log10(value / kLowest)) : 0;
  ++bins_.at(static_cast<std::size_t>(std::min<double>(bin, kBins - 1)));
  maximum_ = std::max(maximum_, value);
}

void LogHistogram::add(const LogHistogram& other) {
  std::transform(bins_.begin(), bins_.end(), other.bins_.begin(), bins_.begin(), std::plus<>());
  maximum_ = std::max(maximum_, other.maximum_);
}

std::int64_t LogHistogram::count() const { return std::accumulate(bins_.begin(), bins_.end(), std::int64_t{0}); }

double LogHistogram::quantile(double share) const {
  if (count() == 0) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const double wanted = share * static_cast<double>(count());
  std::int64_t seen = 0;
  for (int bin = 0; bin < kBins - 1; ++bin) {
    seen += bins_.at(static_cast<std::size_t>(bin));
    if (static_cast<double>(seen) >= wanted) {
      return std::min(maximum_, kLowest * std::pow(10.0, static_cast<double>(bin) / kBinsPerDecade));
    }
  }
  return maximum_;
}

LogHistogram LogHistogram::from(const std::array<std::int64_t, kBins>& bins, double maximum) {
  LogHistogram result;
  result.bins_ = bins;
  result.maximum_ = maximum;
  return result;
}

}  // namespace depthgrid::lab
