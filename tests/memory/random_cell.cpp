#include "memory/random_cell.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid::memory {
namespace {

using Eigen::Vector3d;
using reference::Random;

/// A rectangle of pixels with one value.
void fill(std::vector<float>& image, const PinholeCamera& c, int most_px, float value, Random& random) {
  const int u0 = random.integer(0, c.width_px - 1);
  const int v0 = random.integer(0, c.height_px - 1);
  const int u1 = std::min(u0 + random.integer(1, most_px), c.width_px);
  const int v1 = std::min(v0 + random.integer(1, most_px), c.height_px);
  for (int v = v0; v < v1; ++v) {
    std::fill(image.begin() + v * c.width_px + u0, image.begin() + v * c.width_px + u1, value);
  }
}

}  // namespace

RandomCell::RandomCell(Random& random) {
  memory.voxel_m = random.uniform(0.02, 0.08);
  const Vector3d size(random.uniform(1, 20), random.uniform(1, 12), random.uniform(1, 12));
  memory.low_world = random.in_cube(0.3) - 0.5 * memory.voxel_m * size;
  memory.high_world = memory.low_world + memory.voxel_m * size;
  if (random.chance(0.2)) {  // more than one of the largest blocks
    memory.high_world.x() = memory.low_world.x() + 70 * memory.voxel_m;
    memory.high_world.y() = memory.low_world.y() + 3 * memory.voxel_m;
    memory.high_world.z() = memory.low_world.z() + 3 * memory.voxel_m;
  }
  if (random.chance(0.3)) {
    memory.start = StartEmpty{};
  } else {
    memory.start = StartUnknown{};
  }
  memory.thinnest_hidden_m = random.chance(0.5) ? 0.0 : random.uniform(0, 0.15);
  const Vector3d middle = 0.5 * (memory.low_world + memory.high_world);
  rig.name = "cell";
  rig.cameras.resize(static_cast<std::size_t>(random.integer(1, 3)));
  settings.margins.resize(rig.cameras.size());
  for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
    RigCamera& camera = rig.cameras[k];
    camera.id = std::to_string(k);
    const int width_px = random.integer(8, 40);
    const int height_px = random.integer(6, 30);
    const double focal_px = random.uniform(0.5, 1.5) * width_px;
    camera.intrinsics = {width_px,
                         height_px,
                         focal_px,
                         focal_px * random.uniform(0.9, 1.1),
                         width_px * random.uniform(0.3, 0.7),
                         height_px * random.uniform(0.3, 0.7)};
    camera.rule.near_m = random.chance(0.5) ? 0.0 : random.uniform(0.1, 1.2);
    camera.T_world_camera =
        look_at(middle + random.uniform(0.7, 2) * random.direction(), middle + random.in_cube(0.2), random.direction());
    CameraMargins& margins = settings.margins[k];
    margins.sensor = {random.uniform(0, 0.02), 0, 0, random.integer(0, 1)};
    margins.smallest_obstacle_m = 0;
    margins.translation_m = random.chance(0.5) ? 0.0 : random.uniform(0, 0.01);
    margins.rotation_rad = random.chance(0.5) ? 0.0 : random.uniform(0, 0.01);
    margins.half_exposure_s = random.uniform(0, 0.01);
    margins.time_uncertainty_s = random.chance(0.5) ? 0.0 : random.uniform(0, 0.005);
  }
  settings.space = views::BoxSpace{Vector3d::Constant(-1.5), Vector3d::Constant(1.5)};
  settings.policies = {views::Policy::obstacle, views::Policy::obstacle, views::Policy::obstacle, 0};
  settings.v_max_m_s = random.chance(0.1) ? 0.0 : random.uniform(0.1, 2);
  settings.rho_m = 0.5;
}

RandomImage::RandomImage(const RandomCell& cell, std::size_t camera, double time_s, Random& random)
    : T_world_camera_(cell.rig.cameras[camera].T_world_camera) {
  const PinholeCamera& c = cell.rig.cameras[camera].intrinsics;
  const auto pixels = static_cast<std::size_t>(c.width_px) * static_cast<std::size_t>(c.height_px);
  depth_m_.assign(pixels, static_cast<float>(random.uniform(1, 5)));
  near_m_.assign(pixels, 0.0F);
  far_m_.assign(pixels, 0.0F);
  for (int n = random.integer(0, 5); n > 0; --n) {
    fill(depth_m_, c, random.chance(0.5) ? 2 : 15,
         static_cast<float>(random.chance(0.2) ? 0 : random.uniform(0.4, 2.5)), random);
  }
  for (int n = random.integer(0, 2); n > 0; --n) {
    const double from_m = random.uniform(0.3, 2.2);
    Random same = random;  // both ends, and some readings, at the same pixels
    fill(near_m_, c, 12, static_cast<float>(from_m), random);
    Random again = same;
    fill(far_m_, c, 12, static_cast<float>(from_m + 0.4), again);
    if (same.chance(0.5)) {
      again = same;
      fill(depth_m_, c, 12, static_cast<float>(from_m + 0.2), again);
    }
  }
  if (random.chance(0.3)) {
    T_world_camera_.translation() += random.in_cube(0.1);
  }
  const Vector3d middle = 0.5 * (cell.memory.low_world + cell.memory.high_world);
  for (int n = random.chance(0.5) ? 0 : random.integer(1, 3); n > 0; --n) {
    links_.push_back({middle + random.in_cube(0.4), middle + random.in_cube(0.4), random.uniform(0.02, 0.15)});
  }
  frame_ = {depth_view(depth_m_, c.width_px, c.height_px), {near_m_.data(), far_m_.data(), c.width_px, 0, 5}, time_s};
  frame_.robot.links_world = links_;
  frame_.robot.within_margin = random.chance(0.5);
}

}  // namespace depthgrid::memory
