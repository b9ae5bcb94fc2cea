// Which pixels a solid can cover: the image rectangle of the spheres that bound it.
#pragma once

#include "depthgrid/core/camera.hpp"
#include "depthgrid/simulation/shapes.hpp"

namespace depthgrid::simulation {

/// Half-open rectangle of pixels inside the image.
struct PixelBounds {
  int u_begin = 0, v_begin = 0;
  int u_end = 0, v_end = 0;
};

/// Covers every pixel whose square meets the projection of the solid (camera frame, metres): a box is the hull of its
/// corners, a capsule that of its end spheres. The whole image when a part reaches to z <= 0.
[[nodiscard]] PixelBounds image_bounds(const PinholeCamera& camera, const Plane& plane) noexcept;
[[nodiscard]] PixelBounds image_bounds(const PinholeCamera& camera, const Box& box) noexcept;
[[nodiscard]] PixelBounds image_bounds(const PinholeCamera& camera, const Sphere& sphere) noexcept;
[[nodiscard]] PixelBounds image_bounds(const PinholeCamera& camera, const Capsule& capsule) noexcept;

}  // namespace depthgrid::simulation
