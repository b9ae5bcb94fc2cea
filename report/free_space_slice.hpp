// Which part of a plane through the world the cameras see free, and which is gray.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/rig.hpp"

namespace depthgrid::report {

/// What the cameras say of a point.
enum class Sight : std::uint8_t {
  outside,             ///< not in the principal camera's view
  free_for_principal,  ///< the principal camera sees past it
  free_for_other,      ///< only another camera sees past it
  gray,                ///< no camera sees past it
};

/// A rectangle in the world: the point of share (s, t) in [0, 1] is corner + s along + t down. Metres.
struct WorldRectangle {
  Eigen::Vector3d corner_world;
  Eigen::Vector3d along_world;
  Eigen::Vector3d down_world;
};

/// True when the camera sees past the point: it projects into the image and is nearer than the pixel's free depth
/// (metres, 0 = nothing is free), the depth that FreeDepth prepares.
[[nodiscard]] bool sees_past(const RigCamera& camera, const DepthImage& free_m,
                             const Eigen::Vector3d& p_world) noexcept;

/// One point, with the principal camera first in `rig`, whose view is the frustum between the depths d_min_m and
/// d_max_m.
[[nodiscard]] Sight sight(const Rig& rig, std::span<const DepthImage> free_m, double d_min_m, double d_max_m,
                          const Eigen::Vector3d& p_world) noexcept;

/// The centres of width x height equal parts of the rectangle, row by row. One free-depth image a camera of `rig`.
[[nodiscard]] std::vector<Sight> free_space_slice(const Rig& rig, std::span<const DepthImage> free_m, double d_min_m,
                                                  double d_max_m, const WorldRectangle& area, int width, int height);

}  // namespace depthgrid::report
