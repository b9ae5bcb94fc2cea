#include "program/info/surface.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace depthgrid::program {

namespace {

constexpr int kNeighbour_px = 3;
constexpr float kLargestJump_m = 0.2F;

Eigen::Vector3f normal(const Surface& surface, int u, int v) {
  const auto at = [&](int x, int y) -> const Eigen::Vector3f& {
    return surface
        .points[static_cast<std::size_t>(y) * static_cast<std::size_t>(surface.width_px) + static_cast<std::size_t>(x)];
  };
  const Eigen::Vector3f& centre = at(u, v);
  const std::array<const Eigen::Vector3f*, 4> around = {&at(u - kNeighbour_px, v), &at(u + kNeighbour_px, v),
                                                        &at(u, v - kNeighbour_px), &at(u, v + kNeighbour_px)};
  for (const auto* point : around) {
    if (!(point->z() > 0.0F) || std::abs(point->z() - centre.z()) >= kLargestJump_m) {
      return Eigen::Vector3f::Zero();
    }
  }
  const Eigen::Vector3f across = (*around[1] - *around[0]).cross(*around[3] - *around[2]);
  const float length = across.norm();
  if (!(length > 0.0F)) {
    return Eigen::Vector3f::Zero();
  }
  return across.dot(centre) > 0.0F ? Eigen::Vector3f(-across / length) : Eigen::Vector3f(across / length);
}

}  // namespace

void make_surface(const PinholeCamera& camera, const DepthImage& depth, Surface& surface) {
  surface.width_px = depth.width_px();
  surface.height_px = depth.height_px();
  const std::size_t size = depth.index(0, depth.height_px());
  surface.points.resize(size);
  surface.normals.assign(size, Eigen::Vector3f::Zero());
  for (int v = 0; v < depth.height_px(); ++v) {
    for (int u = 0; u < depth.width_px(); ++u) {
      surface.points[depth.index(u, v)] =
          deproject(camera, {u + 0.5, v + 0.5, static_cast<double>(depth.at(u, v))}).cast<float>();
    }
  }
  for (int v = kNeighbour_px; v < depth.height_px() - kNeighbour_px; ++v) {
    for (int u = kNeighbour_px; u < depth.width_px() - kNeighbour_px; ++u) {
      if (depth.at(u, v) > 0.0F) {
        surface.normals[depth.index(u, v)] = normal(surface, u, v);
      }
    }
  }
}

}  // namespace depthgrid::program
