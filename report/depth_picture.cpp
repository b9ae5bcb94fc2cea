#include "report/depth_picture.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

namespace depthgrid::report {

namespace {

std::string metres(double value_m) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << value_m << " m";
  return text.str();
}

}  // namespace

DepthRange depth_range(const DepthImage& depth_m) noexcept {
  DepthRange range{std::numeric_limits<double>::infinity(), 0};
  for (int v = 0; v < depth_m.height_px(); ++v) {
    for (int u = 0; u < depth_m.width_px(); ++u) {
      const double z = depth_m.at(u, v);
      if (z > 0 && std::isfinite(z)) {
        range.near_m = std::min(range.near_m, z);
        range.far_m = std::max(range.far_m, z);
      }
    }
  }
  return range.near_m < range.far_m ? range : DepthRange{};
}

Raster depth_raster(const DepthImage& depth_m, const DepthRange& range) {
  Raster raster(depth_m.width_px(), depth_m.height_px());
  for (int v = 0; v < depth_m.height_px(); ++v) {
    for (int u = 0; u < depth_m.width_px(); ++u) {
      const double z = depth_m.at(u, v);
      const double share = (z - range.near_m) / (range.far_m - range.near_m);
      raster.set(u, v, z > 0 ? depth_colour(share) : kNoMeasurement);
    }
  }
  return raster;
}

void draw_depth(Canvas& canvas, const Rectangle& area, const DepthImage& depth_m, const DepthRange& range) {
  canvas.raster(area, depth_raster(depth_m, range));
}

void draw_depth_legend(Canvas& canvas, const Rectangle& area, const DepthRange& range) {
  Raster bar(256, 1);
  for (int u = 0; u < bar.width_px; ++u) {
    bar.set(u, 0, depth_colour(u / 255.0));
  }
  const double size_px = area.height_px;
  const double text_px = canvas.text_width_px("00.0 m ", size_px);
  const double base_px = area.y_px + 0.85 * area.height_px;
  canvas.text({area.x_px, base_px}, metres(range.near_m), size_px);
  canvas.raster({area.x_px + text_px, area.y_px, area.width_px - 2 * text_px, area.height_px}, bar);
  canvas.text({area.x_px + area.width_px, base_px}, metres(range.far_m), size_px, kBlack, Align::right);
}

}  // namespace depthgrid::report
