#include "report/free_space_slice.hpp"

#include <cmath>
#include <optional>

namespace depthgrid::report {

namespace {

struct Seen {
  int u = 0;
  int v = 0;
  double depth_m = 0;
};

/// The pixel that shows the point; nothing behind the camera and outside the image.
std::optional<Seen> pixel_of(const RigCamera& camera, const Eigen::Vector3d& p_world) {
  const Eigen::Vector3d p_camera = camera.T_world_camera.inverse(Eigen::Isometry) * p_world;
  if (!(p_camera.z() > 0)) {
    return std::nullopt;
  }
  const DepthPoint p = project(camera.intrinsics, p_camera);
  if (!(p.x_px >= 0 && p.y_px >= 0 && p.x_px < camera.intrinsics.width_px && p.y_px < camera.intrinsics.height_px)) {
    return std::nullopt;
  }
  return Seen{static_cast<int>(p.x_px), static_cast<int>(p.y_px), p.depth_m};
}

}  // namespace

bool sees_past(const RigCamera& camera, const DepthImage& free_m, const Eigen::Vector3d& p_world) noexcept {
  const std::optional<Seen> seen = pixel_of(camera, p_world);
  return seen && seen->depth_m > camera.rule.near_m && seen->depth_m < free_m.at(seen->u, seen->v);
}

Sight sight(const Rig& rig, std::span<const DepthImage> free_m, double d_min_m, double d_max_m,
            const Eigen::Vector3d& p_world) noexcept {
  const std::optional<Seen> principal = pixel_of(rig.cameras.front(), p_world);
  if (!principal || principal->depth_m < d_min_m || principal->depth_m > d_max_m) {
    return Sight::outside;
  }
  for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
    if (sees_past(rig.cameras[k], free_m[k], p_world)) {
      return k == 0 ? Sight::free_for_principal : Sight::free_for_other;
    }
  }
  return Sight::gray;
}

std::vector<Sight> free_space_slice(const Rig& rig, std::span<const DepthImage> free_m, double d_min_m, double d_max_m,
                                    const WorldRectangle& area, int width, int height) {
  std::vector<Sight> result;
  result.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const Eigen::Vector3d p_world =
          area.corner_world + (column + 0.5) / width * area.along_world + (row + 0.5) / height * area.down_world;
      result.push_back(sight(rig, free_m, d_min_m, d_max_m, p_world));
    }
  }
  return result;
}

}  // namespace depthgrid::report
