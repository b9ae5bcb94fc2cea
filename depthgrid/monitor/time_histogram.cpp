#include "depthgrid/monitor/time_histogram.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid::monitor {
namespace {

constexpr double kLeast_s = 1e-6;
constexpr double kStep = 1.05;

}  // namespace

void TimeHistogram::add(double seconds) noexcept {
  if (!std::isfinite(seconds)) {
    return;
  }
  const double step = seconds > kLeast_s ? std::log(seconds / kLeast_s) / std::log(kStep) : 0;
  counts_[static_cast<std::size_t>(std::min(step, static_cast<double>(kSteps - 1)))].fetch_add(
      1, std::memory_order_relaxed);
  count_.fetch_add(1, std::memory_order_relaxed);
  if (seconds > largest_s_.load(std::memory_order_relaxed)) {
    largest_s_.store(seconds, std::memory_order_relaxed);
  }
}

std::optional<double> TimeHistogram::quantile_s(double share) const noexcept {
  const std::uint64_t all = count();
  if (all == 0) {
    return std::nullopt;
  }
  const double wanted = share * static_cast<double>(all);
  double so_far = 0;
  for (std::size_t i = 0; i < kSteps; ++i) {
    so_far += static_cast<double>(counts_[i].load(std::memory_order_relaxed));
    if (so_far >= wanted) {
      return std::min(largest_s(), kLeast_s * std::pow(kStep, static_cast<double>(i + 1)));
    }
  }
  return largest_s();
}

}  // namespace depthgrid::monitor
