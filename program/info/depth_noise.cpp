#include "program/info/depth_noise.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace depthgrid::program {

namespace {

constexpr int kRadius_px = 4;
constexpr double kSlice_m = 0.5;
constexpr std::size_t kSliceCount = 40;
constexpr double kFarthest_m = kSlice_m * kSliceCount;
constexpr double kEdge = 0.03;
constexpr std::int64_t kFewestResiduals = 1000;
constexpr double kCoveredNoise = 0.95;

/// Noise of one pixel that the residual of z against its two neighbours shows; negative: not usable.
double residual_m(double z, double before, double after) {
  if (!(before > 0) || !(after > 0) || std::abs(before - z) > kEdge * z || std::abs(after - z) > kEdge * z) {
    return -1.0;
  }
  return std::abs(1.0 / z - 0.5 * (1.0 / before + 1.0 / after)) * z * z * std::sqrt(2.0 / 3.0);
}

/// The line c + q x, c >= 0 and q >= 0, on or above all points (x, y) with the least sum of heights.
std::pair<double, double> line_above(const std::vector<std::pair<double, double>>& points) {
  double best_c = 0;
  double best_q = 0;
  double best_sum = -1;
  const auto offer = [&](double q) {
    if (!(q >= 0)) {
      return;
    }
    double c = 0;
    double sum = 0;
    for (const auto& [x, y] : points) {
      c = std::max(c, y - q * x);
    }
    for (const auto& [x, y] : points) {
      sum += c + q * x;
    }
    if (best_sum < 0 || sum < best_sum) {
      best_c = c;
      best_q = q;
      best_sum = sum;
    }
  };
  offer(0.0);
  for (const auto& [x, y] : points) {
    offer(y / x);
    for (const auto& [x2, y2] : points) {
      if (x2 > x) {
        offer((y2 - y) / (x2 - x));
      }
    }
  }
  return {best_c, best_q};
}

}  // namespace

void DepthNoise::add(const DepthImage& depth) {
  slices_.resize(kSliceCount);
  for (int v = kRadius_px; v < depth.height_px() - kRadius_px; ++v) {
    for (int u = kRadius_px; u < depth.width_px() - kRadius_px; ++u) {
      const double z = depth.at(u, v);
      if (!(z > 0 && z < kFarthest_m)) {  // before the cast: not every float fits into an integer
        continue;
      }
      const auto slice = static_cast<std::size_t>(z / kSlice_m);
      for (const auto& [du, dv] : {std::pair(kRadius_px, 0), std::pair(0, kRadius_px)}) {
        const double r = residual_m(z, depth.at(u - du, v - dv), depth.at(u + du, v + dv));
        if (r >= 0) {
          slices_[slice].add(r);
        }
      }
    }
  }
}

SensorMargin DepthNoise::suggested_margin() const {
  std::vector<std::pair<double, double>> points;  // middle of the slice squared, quantile
  for (std::size_t slice = 0; slice < slices_.size(); ++slice) {
    if (slices_[slice].count() >= kFewestResiduals) {
      const double middle_m = (static_cast<double>(slice) + 0.5) * kSlice_m;
      points.emplace_back(middle_m * middle_m, slices_[slice].quantile_m(kCoveredNoise));
    }
  }
  const auto [constant_m, quadratic_per_m] = line_above(points);
  SensorMargin margin;
  margin.constant_m = constant_m;
  margin.quadratic_per_m = quadratic_per_m;
  return margin;
}

}  // namespace depthgrid::program
