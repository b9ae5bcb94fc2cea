#include "depthgrid/core/blind_layer.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid {

double half_pixel(const PinholeCamera& camera) noexcept { return 0.5 * std::hypot(1 / camera.fx_px, 1 / camera.fy_px); }

double thicker(double a_m, double b_m) noexcept { return std::isnan(a_m) || a_m >= b_m ? a_m : b_m; }

RobotView with_layer(RobotView robot, const PinholeCamera& camera, double padding_m) noexcept {
  if (robot.near_m == nullptr || robot.far_m == nullptr || !(padding_m >= 0 && std::isfinite(padding_m))) {
    return robot;
  }
  const std::ptrdiff_t stride_px = robot.stride_px != 0 ? robot.stride_px : camera.width_px;
  float deepest_m = 0;
  for (int v = 0; v < camera.height_px; ++v) {
    const float* near_m = robot.near_m + stride_px * v;
    const float* far_m = robot.far_m + stride_px * v;
    for (int u = 0; u < camera.width_px; ++u) {
      // What is not finite is no robot.
      deepest_m = near_m[u] > 0 && far_m[u] > deepest_m && std::isfinite(far_m[u]) ? far_m[u] : deepest_m;
    }
  }
  double longest_ray = 1;
  for (const double u_px : {0, camera.width_px}) {
    for (const double v_px : {0, camera.height_px}) {
      longest_ray = std::max(longest_ray, deproject(camera, {u_px, v_px, 1.0}).norm());
    }
  }
  robot.blind_m = deepest_m > 0 ? padding_m + half_pixel(camera) * deepest_m : 0.0;
  robot.reach_m = longest_ray * deepest_m;
  return robot;
}

double blind_layer_m(const RobotView& robot, const PinholeCamera& camera, const SensorMargin& sensor,
                     const PoseMargin& pose) noexcept {
  if (robot.near_m == nullptr || (robot.blind_m == 0 && robot.reach_m == 0)) {
    return 0;
  }
  return robot.blind_m + pose.translation_m +
         (2 * sensor.lateral_px * half_pixel(camera) + pose.rotation_rad) * robot.reach_m;
}

}  // namespace depthgrid
