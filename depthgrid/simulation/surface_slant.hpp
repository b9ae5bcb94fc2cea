// What a depth image tells about the surface in a pixel: how steep it is, and whether it ends there.
#pragma once

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/depth_image.hpp"

namespace depthgrid::simulation {

/// Angle between the surface's normal and the optical axis, in [0, pi/2), from the flatter one of the differences to
/// either side in row and column. Exact on planes; (u, v) must lie in the image.
[[nodiscard]] double surface_slant_rad(const PinholeCamera& camera, const DepthImage& depth_m, int u, int v) noexcept;

/// Nearest and farthest depth in the 3 x 3 pixels around one; pixels without depth do not count.
struct EdgeDepths {
  float near_m = 0;
  float far_m = 0;
  /// They differ by more than 4 % and 3 cm: more than a steep surface does within three pixels.
  [[nodiscard]] bool is_edge() const noexcept { return far_m > 1.04F * near_m && far_m - near_m > 0.03F; }
};
[[nodiscard]] EdgeDepths depths_around(const DepthImage& depth_m, int u, int v) noexcept;

}  // namespace depthgrid::simulation
