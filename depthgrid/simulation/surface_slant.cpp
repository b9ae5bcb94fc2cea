#include "depthgrid/simulation/surface_slant.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace depthgrid::simulation {

namespace {

/// Slope of the inverse depth, which is linear in the image on a plane, from the flatter side; 0 without neighbours.
double inverse_slope(float before, float here, float after) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const double from_before = before > 0 ? 1.0 / here - 1.0 / before : kNone;
  const double to_after = after > 0 ? 1.0 / after - 1.0 / here : kNone;
  const double flatter = std::abs(from_before) < std::abs(to_after) ? from_before : to_after;
  return std::isinf(flatter) ? 0.0 : flatter;
}

}  // namespace

double surface_slant_rad(const PinholeCamera& camera, const DepthImage& depth_m, int u, int v) noexcept {
  const float here = depth_m.at(u, v);
  if (!(here > 0)) {
    return 0;
  }
  const auto depth = [&depth_m, &camera](int at_u, int at_v) {
    return camera.contains(at_u, at_v) ? depth_m.at(at_u, at_v) : 0.0F;
  };
  // A plane n . p = 1 has 1/z = n_x (u - cx) / fx + n_y (v - cy) / fy + n_z.
  const double nx = camera.fx_px * inverse_slope(depth(u - 1, v), here, depth(u + 1, v));
  const double ny = camera.fy_px * inverse_slope(depth(u, v - 1), here, depth(u, v + 1));
  const double nz =
      1.0 / here - nx * (u + 0.5 - camera.cx_px) / camera.fx_px - ny * (v + 0.5 - camera.cy_px) / camera.fy_px;
  return std::atan2(std::hypot(nx, ny), std::abs(nz));
}

EdgeDepths depths_around(const DepthImage& depth_m, int u, int v) noexcept {
  EdgeDepths result;
  const int last_u = std::min(u + 1, depth_m.width_px() - 1);
  const int last_v = std::min(v + 1, depth_m.height_px() - 1);
  for (int y = std::max(0, v - 1); y <= last_v; ++y) {
    for (int x = std::max(0, u - 1); x <= last_u; ++x) {
      const float z = depth_m.at(x, y);
      if (z > 0) {
        result.near_m = result.near_m > 0 ? std::min(result.near_m, z) : z;
        result.far_m = std::max(result.far_m, z);
      }
    }
  }
  return result;
}

}  // namespace depthgrid::simulation
