// A simulated cell that a test runs.
#pragma once

#include <string>

namespace depthgrid::test {

/// Two small cameras, so that a sanitizer's build keeps up. kinect_v1 has noise, so that no two images are equal.
inline std::string small_cell() {
  return R"(name: small
smallest_obstacle_m: 0
cameras:
  - name: front
    source: simulated
    rate_hz: 20
    intrinsics: {width_px: 64, height_px: 48, fx_px: 48, fy_px: 48, cx_px: 31.5, cy_px: 23.5}
    pose: {position_m: [2.3, -1.6, 1.4], look_at_m: [0, -0.1, 0.4]}
    sensor: kinect_v1
  - name: back
    source: simulated
    rate_hz: 20
    intrinsics: {width_px: 64, height_px: 48, fx_px: 48, fy_px: 48, cx_px: 31.5, cy_px: 23.5}
    pose: {position_m: [-2.3, -1.5, 1.4], look_at_m: [0, -0.1, 0.4]}
    sensor: kinect_v1
robot:
  urdf: kuka_lwr4
  base: {position_m: [0, 0, 0]}
  joints: {source: simulated, rate_hz: 100, time_error_s: 0.005}
  padding_m: 0.1
space: {low_m: [-1.4, -1.4, -0.4], high_m: [1.4, 1.4, 1.4]}
policies: {unobserved: obstacle, outside: ignored, robot_pockets: ignored, ignored_pocket_m: 0.1}
v_max_m_s: 1.6
memory: none
ask: {rate_hz: 50, links: moving, rho_m: 0.6, resolution_m: 0.02, points: [{name: far, at_m: [1.0, -0.6, 1.2]}]}
ages: {image_s: 0.35, joints_s: 0.25}
)";
}

}  // namespace depthgrid::test
