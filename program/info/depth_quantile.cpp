#include "program/info/depth_quantile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depthgrid::program {

namespace {

constexpr double kFirst_m = 1e-3;
constexpr double kLast_m = 1e4;
constexpr double kBinsPerE = 100.0;

}  // namespace

void DepthQuantile::add(double depth_m) {
  const auto bin_of = [](double value_m) { return std::log(value_m / kFirst_m) * kBinsPerE; };
  bins_.resize(static_cast<std::size_t>(bin_of(kLast_m)) + 1);
  const double bin = std::clamp(bin_of(depth_m), 0.0, static_cast<double>(bins_.size() - 1));
  ++bins_[static_cast<std::size_t>(bin)];
  ++count_;
}

double DepthQuantile::median_m() const noexcept {
  std::int64_t below = 0;
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    below += bins_[i];
    if (2 * below >= count_) {
      return kFirst_m * std::exp((static_cast<double>(i) + 0.5) / kBinsPerE);
    }
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace depthgrid::program
