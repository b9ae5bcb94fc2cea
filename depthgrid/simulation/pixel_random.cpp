#include "depthgrid/simulation/pixel_random.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace depthgrid::simulation {

namespace {

constexpr std::size_t kHalf = 32768;

/// Upper half of the quantiles, by Newton's method from each to the next.
std::vector<float> make_quantiles() {
  std::vector<float> quantiles(kHalf);
  double x = 0;
  for (std::size_t i = 0; i < kHalf; ++i) {
    const double share_above = 0.5 - (static_cast<double>(i) + 0.5) / (2 * kHalf);
    for (int step = 0; step < 30; ++step) {
      const double error = 0.5 * std::erfc(x * std::numbers::sqrt2 / 2) - share_above;
      const double density = std::exp(-0.5 * x * x) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
      const double move = error / density;
      x += move;
      if (std::abs(move) < 1e-9) {
        break;
      }
    }
    quantiles[i] = static_cast<float>(x);
  }
  return quantiles;
}

}  // namespace

float normal_of(std::uint16_t bits) noexcept {
  static const std::vector<float> kQuantiles = make_quantiles();
  return bits < kHalf ? -kQuantiles[kHalf - 1 - bits] : kQuantiles[bits - kHalf];
}

}  // namespace depthgrid::simulation
