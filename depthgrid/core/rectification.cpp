#include "depthgrid/core/rectification.hpp"

#include <algorithm>

#include "depthgrid/core/radial_distortion.hpp"

namespace depthgrid {
namespace {

/// tan^2 of 65 degrees: farther off the axis a plane takes many pixels for a few of the lens.
constexpr double kWidest = 4.599;

/// Rays are sampled at most this many times along a side of the image.
constexpr int kSamples = 256;

/// Pixels from first to last, exclusive, of the distorted camera's image plane; negative ones are added before it.
struct Span {
  int first, last;
};

/// By how much a side may grow in each direction.
int most_added(int side_px) { return std::min(side_px, kLargestImageSide - side_px) / 2; }

Span grown(const Span& span, int pixel, int step, int side_px) {
  const int added = most_added(side_px);
  return {std::max(std::min(span.first, pixel + 1 - step), -added),
          std::min(std::max(span.last, pixel + step), side_px + added)};
}

bool contains(const PinholeCamera& camera, const Eigen::Vector2d& distorted) {
  const double x_px = camera.fx_px * distorted.x() + camera.cx_px;
  const double y_px = camera.fy_px * distorted.y() + camera.cy_px;
  return x_px >= 0.0 && y_px >= 0.0 && x_px < camera.width_px && y_px < camera.height_px;
}

}  // namespace

PinholeCamera rectified_camera(const PinholeCamera& distorted, const Distortion& lens) {
  validate(distorted, "distorted camera");
  refuse_fold(distorted, lens);
  if (!distorts(lens)) {
    return distorted;
  }
  const int added_x = most_added(distorted.width_px);
  const int added_y = most_added(distorted.height_px);
  const auto ray = [&distorted](double x_px, double y_px) {
    return Eigen::Vector2d((x_px - distorted.cx_px) / distorted.fx_px, (y_px - distorted.cy_px) / distorted.fy_px);
  };
  double s_largest = 0.0;
  for (const int x_px : {-added_x, distorted.width_px + added_x}) {
    for (const int y_px : {-added_y, distorted.height_px + added_y}) {
      s_largest = std::max(s_largest, ray(x_px, y_px).squaredNorm());
    }
  }
  const double s_kept = std::min(unfolded_squared_radius(lens, s_largest), kWidest);
  const int step = std::max(1, std::max(distorted.width_px, distorted.height_px) / kSamples);
  Span columns{0, distorted.width_px};
  Span rows{0, distorted.height_px};
  for (int v = -added_y; v < distorted.height_px + added_y; v += step) {
    for (int u = -added_x; u < distorted.width_px + added_x; u += step) {
      const Eigen::Vector2d n = ray(u + 0.5, v + 0.5);
      if (n.squaredNorm() <= s_kept && contains(distorted, distort(lens, n))) {
        columns = grown(columns, u, step, distorted.width_px);
        rows = grown(rows, v, step, distorted.height_px);
      }
    }
  }
  return {columns.last - columns.first,    rows.last - rows.first,      distorted.fx_px, distorted.fy_px,
          distorted.cx_px - columns.first, distorted.cy_px - rows.first};
}

}  // namespace depthgrid
