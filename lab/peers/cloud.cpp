#include "lab/peers/cloud.hpp"

#include <algorithm>
#include <cmath>

#include "lab/peers/wide_scan.hpp"

namespace depthgrid::lab {

Deprojector::Deprojector(const Rig& rig) {
  std::size_t widest = 0;
  for (const RigCamera& source : rig.cameras) {
    const PinholeCamera& intrinsics = source.intrinsics;
    Camera camera;
    camera.rule = source.rule;
    for (int u = 0; u < intrinsics.width_px; ++u) {
      camera.slope_x.push_back(static_cast<float>((u + 0.5 - intrinsics.cx_px) / intrinsics.fx_px));
    }
    for (int v = 0; v < intrinsics.height_px; ++v) {
      camera.slope_y.push_back(static_cast<float>((v + 0.5 - intrinsics.cy_px) / intrinsics.fy_px));
    }
    camera.rotation = source.T_world_camera.linear().cast<float>();
    camera.translation = source.T_world_camera.translation().cast<float>();
    widest = std::max(widest, camera.slope_x.size());
    cameras_.push_back(std::move(camera));
  }
  x_.resize(widest);
  y_.resize(widest);
  z_.resize(widest);
  keep_.resize(widest);
}

void Deprojector::row(const Camera& camera, int v, const Region* box) {
  const Region everything{Eigen::Vector3d::Constant(-1e9), Eigen::Vector3d::Constant(1e9)};
  const Region& kept = box != nullptr ? *box : everything;
  const float ty = camera.slope_y[static_cast<std::size_t>(v)];
  WorldRow row;
  row.depth_m = depth_m_.data() + depth_m_.index(0, v);
  row.slope_x = camera.slope_x.data();
  row.width = camera.slope_x.size();
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    row.along[axis] = camera.rotation(i, 0);
    row.offset[axis] = camera.rotation(i, 1) * ty + camera.rotation(i, 2);
    row.origin[axis] = camera.translation[i];
    row.low[axis] = static_cast<float>(kept.low_world[i]);
    row.high[axis] = static_cast<float>(kept.high_world[i]);
  }
  deproject_row(row, x_.data(), y_.data(), z_.data(), keep_.data());
}

VoxelFilter::VoxelFilter(const Region& box, double side_m)
    : low_(box.low_world.cast<float>()), per_side_(static_cast<float>(1 / side_m)) {
  std::size_t voxels = 1;
  for (int axis = 0; axis < 3; ++axis) {
    count_[axis] = static_cast<std::size_t>(std::ceil((box.high_world - box.low_world)[axis] / side_m)) + 1;
    voxels *= count_[axis];
  }
  seen_.resize(voxels / 64 + 1);
}

void VoxelFilter::clear() { std::fill(seen_.begin(), seen_.end(), 0); }

bool VoxelFilter::first(float x, float y, float z) {
  const auto i = static_cast<std::size_t>((x - low_.x()) * per_side_);
  const auto j = static_cast<std::size_t>((y - low_.y()) * per_side_);
  const auto k = static_cast<std::size_t>((z - low_.z()) * per_side_);
  const std::size_t voxel = (k * count_[1] + j) * count_[0] + i;
  const std::uint64_t bit = std::uint64_t{1} << (voxel % 64);
  const bool is_first = (seen_[voxel / 64] & bit) == 0;
  seen_[voxel / 64] |= bit;
  return is_first;
}

}  // namespace depthgrid::lab
