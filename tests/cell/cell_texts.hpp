// A cell file that is right, and ways to break it.
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace depthgrid::test {

inline std::string whole_cell() {
  return R"(name: test cell
smallest_obstacle_m: 0.02
cameras:
  - name: left
    source: simulated
    rate_hz: 10
    intrinsics: {width_px: 64, height_px: 48, fx_px: 50, fy_px: 50, cx_px: 31.5, cy_px: 23.5}
    pose: {position_m: [2, 0, 1], look_at_m: [0, 0, 0.5]}
    sensor: ideal
  - name: right
    source: simulated
    intrinsics: {width_px: 64, height_px: 48, fx_px: 50, fy_px: 50, cx_px: 31.5, cy_px: 23.5}
    pose: {position_m: [-2, 0, 1], rpy_deg: [-90, 0, -90]}
    sensor: kinect_v1
    margins: {translation_m: 0.005, rotation_deg: 0.1}
robot:
  urdf: kuka_lwr4
  base: {position_m: [0, 0, 0], rpy_deg: [0, 0, 90]}
  joints: {source: simulated, time_error_s: 0.002}
  padding_m: 0.05
  tool: lwr_7_link
space: {low_m: [-1, -1, 0], high_m: [1, 1, 1.5]}
policies: {unobserved: obstacle, outside: ignored, robot_pockets: obstacle}
v_max_m_s: 1.6
memory: {start: unknown, voxel_m: 0.05}
ask:
  rate_hz: 100
  links: moving
  points: [{name: hand, at_m: [0.5, 0, 0.8], radius_m: 0.1}]
  rho_m: 0.6
ages: {image_s: 0.2}
outputs:
  udp: {port: 47000}
  jsonl: answers.jsonl
)";
}

/// The text with the first `what` replaced; fails the test where there is none.
inline std::string with(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

}  // namespace depthgrid::test
