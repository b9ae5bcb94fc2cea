#include "depthgrid/robot/capsule_spans.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid::robot {

namespace {

struct Range {
  double low;
  double high;
};

/// Slopes x/z between which the circle of radius r around (x, z), z > r, is seen from the origin.
Range slopes(double x, double z, double r) {
  const double divisor = z * z - r * r;
  const double spread = r * std::sqrt(x * x + divisor);
  return {(x * z - spread) / divisor, (x * z + spread) / divisor};
}

Range joined(const Range& a, const Range& b) { return {std::min(a.low, b.low), std::max(a.high, b.high)}; }

/// Pixels or rows that meet the range of image coordinates, one more on either side for rounding.
PixelSpan pixels(const Range& slope, double f_px, double c_px, int size_px) {
  const auto clamped = [size_px](double x_px) {
    return static_cast<int>(std::clamp(x_px, 0.0, static_cast<double>(size_px)));
  };
  return {clamped(std::floor(f_px * slope.low + c_px) - 1), clamped(std::floor(f_px * slope.high + c_px) + 2)};
}

PixelSpan joined(const PixelSpan& a, const PixelSpan& b) {
  if (a.empty() || b.empty()) {
    return a.empty() ? b : a;
  }
  return {std::min(a.begin, b.begin), std::max(a.end, b.end)};
}

}  // namespace

RowRange widen(const PinholeCamera& camera, const Capsule& capsule, std::span<PixelSpan> rows) noexcept {
  constexpr double kNearest = 1e-6;
  constexpr double kMaxPieces = 8;
  const double r = capsule.radius_m;
  const Eigen::Vector3d along = capsule.b - capsule.a;
  if (std::max(capsule.a.z(), capsule.b.z()) < -r) {
    return {};
  }
  const int height_px = camera.height_px;
  if (!(std::min(capsule.a.z(), capsule.b.z()) > r + kNearest)) {
    std::fill(rows.begin(), rows.end(), PixelSpan{0, camera.width_px});
    return {0, height_px};
  }
  const int pieces = static_cast<int>(std::clamp(std::ceil(2 * along.norm() / (r + kNearest)), 1.0, kMaxPieces));
  RowRange touched{height_px, 0};
  Range x_before = slopes(capsule.a.x(), capsule.a.z(), r);
  Range y_before = slopes(capsule.a.y(), capsule.a.z(), r);
  for (int i = 1; i <= pieces; ++i) {
    const Eigen::Vector3d end = capsule.a + static_cast<double>(i) / pieces * along;
    const Range x = slopes(end.x(), end.z(), r);
    const Range y = slopes(end.y(), end.z(), r);
    const PixelSpan u = pixels(joined(x_before, x), camera.fx_px, camera.cx_px, camera.width_px);
    const PixelSpan v = pixels(joined(y_before, y), camera.fy_px, camera.cy_px, height_px);
    if (!u.empty() && !v.empty()) {
      for (int row = v.begin; row < v.end; ++row) {
        rows[static_cast<std::size_t>(row)] = joined(rows[static_cast<std::size_t>(row)], u);
      }
      touched = {std::min(touched.begin, v.begin), std::max(touched.end, v.end)};
    }
    x_before = x;
    y_before = y;
  }
  return touched.begin < touched.end ? touched : RowRange{};
}

}  // namespace depthgrid::robot
