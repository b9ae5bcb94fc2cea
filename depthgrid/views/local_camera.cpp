#include "depthgrid/views/local_camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "depthgrid/core/rounding.hpp"

namespace depthgrid::views {
namespace {

constexpr double kEpsilon = 0x1p-24;  ///< half an ulp of 1 in single precision

Clip view_between(double d_min_m, double d_max_m) noexcept {
  return {true, d_min_m, d_max_m, std::max(float_below(d_min_m), kFirstDepth_m), float_above(d_max_m)};
}

}  // namespace

void make_local(const Snapshot& snapshot, std::size_t camera, const Eigen::Vector3d& origin_world, double extent_m,
                LocalCamera& local) noexcept {
  const PreparedImage& image = prepared(snapshot.view(camera));
  const RigCamera& rig_camera = snapshot.camera(camera);
  const Pose& T_world_camera = snapshot.T_world_camera(camera);
  local.image = &image;
  local.pinhole = rig_camera.intrinsics;
  local.near_m = rig_camera.rule.near_m;
  local.pose_margin = snapshot.pose_margin(camera);
  local.R_camera_world = T_world_camera.linear().transpose();
  local.offset_camera_m = local.R_camera_world * (origin_world - T_world_camera.translation());
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const std::size_t at = 3 * static_cast<std::size_t>(row) + static_cast<std::size_t>(column);
      local.rotation[at] = static_cast<float>(local.R_camera_world(row, column));
      local.absolute_rotation[at] = float_above(std::abs(local.R_camera_world(row, column)));
    }
    local.offset_m[static_cast<std::size_t>(row)] = static_cast<float>(local.offset_camera_m(row));
  }
  // Ten roundings at most, each of at most half an ulp of the largest intermediate value.
  const double largest_m = local.offset_camera_m.cwiseAbs().maxCoeff() + 3 * extent_m;
  local.guard_m = float_above(16 * kEpsilon * largest_m);
  const PinholeCamera& pinhole = local.pinhole;
  // A coordinate inside the image is f x / z + c with |f x / z| <= size + |c|.
  local.guard_px =
      float_above(16 * kEpsilon *
                  (pinhole.width_px + pinhole.height_px + 2 * std::abs(pinhole.cx_px) + 2 * std::abs(pinhole.cy_px)));
  local.fx = static_cast<float>(pinhole.fx_px);
  local.fy = static_cast<float>(pinhole.fy_px);
  local.cx = static_cast<float>(pinhole.cx_px);
  local.cy = static_cast<float>(pinhole.cy_px);
  local.width = static_cast<float>(pinhole.width_px);
  local.height = static_cast<float>(pinhole.height_px);
  local.blind_m = local.near_m > 0 ? float_above(local.near_m) : 0.0F;
  local.has_pose_error =
      local.pose_margin.translation_m > 0 || local.pose_margin.rotation_rad > 0 || local.pose_margin.time_m > 0;
  local.pose_error_m = float_above(local.pose_margin.translation_m + local.pose_margin.time_m);
  local.pose_error_per_m = float_above(local.pose_margin.rotation_rad);
  if (!local.has_pose_error) {
    local.pose_error_m = 0;
    local.pose_error_per_m = 0;
  }
  local.free_m = image.free_m.data();
  local.minima_m = image.minima_m.data();
  local.levels = image.levels.data();
  local.level_count = static_cast<int>(image.levels.size());
  local.texels[0] = {0, image.free_m.width_px(), 0, 0};
  for (int level = 0; level < local.level_count && level + 1 < static_cast<int>(local.texels.size()); ++level) {
    const PyramidLevel& from = image.levels[static_cast<std::size_t>(level)];
    local.texels[static_cast<std::size_t>(level) + 1] = {from.offset, from.width, level, 3};
  }
  local.width_px = image.free_m.width_px();
  local.has_islands = image.has_islands;
  const auto* frustum = std::get_if<FrustumSpace>(&snapshot.settings().space);
  const bool is_principal = frustum != nullptr && frustum->principal == camera;
  local.space = is_principal && !local.has_pose_error ? view_between(frustum->d_min_m, frustum->d_max_m) : Clip{};
  // Covered is what lies beyond the blind zone, its end excluded.
  constexpr double kBeyondM = 1e-9;
  const double from_m = local.near_m + kBeyondM;
  local.coverage = is_principal ? view_between(std::max(from_m, frustum->d_min_m), frustum->d_max_m)
                                : view_between(from_m, std::numeric_limits<double>::infinity());
  local.coverage.low_m = std::max(local.coverage.low_m, float_above(static_cast<double>(local.blind_m)));
}

}  // namespace depthgrid::views
