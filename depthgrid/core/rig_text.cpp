#include "depthgrid/core/cpp_text.hpp"
#include "depthgrid/core/rig.hpp"

namespace depthgrid {
namespace {

/// The structured bindings do not compile once there is another member.
std::string camera_text(const RigCamera& camera) {
  const auto& [id, intrinsics, distortion, metres_per_unit, rule, T_world_camera, sensor, margins] = camera;
  const auto& [width_px, height_px, fx_px, fy_px, cx_px, cy_px] = intrinsics;
  const auto& [model, coefficients] = distortion;
  const auto& [near_m, far_m, clamp_beyond_far, invalid_units] = rule;
  return "{.id = " + cpp_text(id) +
         ",\n     .intrinsics = " + cpp_list(width_px, height_px, fx_px, fy_px, cx_px, cy_px) +
         ",\n     .distortion = {depthgrid::Distortion::Model::" + std::string(to_string(model)) + ", " +
         cpp_range(coefficients) + "},\n     .metres_per_unit = " + cpp_text(metres_per_unit) + ",\n     .rule = {" +
         cpp_text(near_m) + ", " + cpp_text(far_m) + ", " + cpp_text(clamp_beyond_far) + ", " +
         cpp_range(invalid_units) + "},\n     .T_world_camera = " + cpp_text(T_world_camera) +
         ",\n     .sensor = " + cpp_text(sensor) + ",\n     .margins = " + cpp_text(margins) + "}";
}

}  // namespace

std::string to_string(const Rig& rig) {
  const auto& [name, cameras, T_floor_world] = rig;
  std::string text = "depthgrid::Rig{.name = " + cpp_text(name) + ",\n  .cameras = {";
  for (const RigCamera& camera : cameras) {
    text += (&camera == cameras.data() ? "\n    " : ",\n    ") + camera_text(camera);
  }
  return text + "},\n  .T_floor_world = " + cpp_text(T_floor_world) + "}";
}

}  // namespace depthgrid
