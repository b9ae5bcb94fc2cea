#include "depthgrid/grid/depth_grid.hpp"

#include <algorithm>
#include <cmath>

#include "depthgrid/core/error.hpp"

namespace depthgrid::grid {

void validate(const DepthQuantisation& q) {
  if (!(std::isfinite(q.d_min_m) && q.d_min_m >= 0)) {
    fail("depth grid: d_min is ", q.d_min_m, " m, must be finite and not negative");
  }
  if (!(std::isfinite(q.step_m) && q.step_m > 0)) {
    fail("depth grid: step is ", q.step_m, " m, must be positive and finite");
  }
  if (!(q.growth >= 0 && q.growth <= 1)) {
    fail("depth grid: growth is ", q.growth, ", must be between 0 (fixed step) and 1");
  }
  if (q.count < 1 || q.count > 65535) {
    fail("depth grid: count is ", q.count, " cells, must be between 1 and 65535");
  }
}

DepthGrid::DepthGrid(const PinholeCamera& principal, const DepthQuantisation& quantisation)
    : principal_(principal), quantisation_(quantisation) {
  validate(principal, "principal camera");
  grid::validate(quantisation);
  boundaries_m_.resize(static_cast<std::size_t>(quantisation.count) + 1);
  for (int n = 0; n <= quantisation.count; ++n) {
    const double steps =
        quantisation.growth == 0 ? n : std::expm1(n * std::log1p(quantisation.growth)) / quantisation.growth;
    boundaries_m_[static_cast<std::size_t>(n)] = quantisation.d_min_m + quantisation.step_m * steps;
  }
  if (!std::isfinite(boundaries_m_.back()) || boundaries_m_.back() > 1e6) {
    fail("depth grid: the last of ", quantisation.count, " cells ends at ", boundaries_m_.back(),
         " m, must be at most 1e6 m; lower the count or the growth");
  }
  for (std::size_t n = 1; n < boundaries_m_.size(); ++n) {
    if (!(static_cast<float>(boundaries_m_[n]) > static_cast<float>(boundaries_m_[n - 1]))) {
      fail("depth grid: a step of ", quantisation.step_m, " m vanishes in single precision at ", boundaries_m_[n],
           " m; use a larger step");
    }
  }
}

int DepthGrid::cell_of(double d_m) const noexcept {
  const double steps = (d_m - quantisation_.d_min_m) / quantisation_.step_m;
  if (steps < 0) {
    // Below the grid cells keep the first cell's size: callers clip, but differences of indices stay meaningful.
    return static_cast<int>(std::max(std::floor(steps), -1e9));
  }
  if (d_m >= boundaries_m_.back()) {
    const double last = boundaries_m_.back() - boundaries_m_[boundaries_m_.size() - 2];
    return static_cast<int>(std::min(quantisation_.count + std::floor((d_m - boundaries_m_.back()) / last), 1e9));
  }
  const double guess =
      quantisation_.growth == 0 ? steps : std::log1p(steps * quantisation_.growth) / std::log1p(quantisation_.growth);
  int n = std::clamp(static_cast<int>(guess), 0, quantisation_.count - 1);
  while (n > 0 && d_m < boundary_m(n)) {
    --n;
  }
  while (d_m >= boundary_m(n + 1)) {
    ++n;
  }
  return n;
}

}  // namespace depthgrid::grid
