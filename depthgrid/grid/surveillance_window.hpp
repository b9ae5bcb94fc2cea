// Which pixels of the principal camera can hold an obstacle within rho of a point. Internal.
#pragma once

#include <Eigen/Core>

#include "depthgrid/core/camera.hpp"

namespace depthgrid::grid {

/// Half-open rectangle of pixels inside the image; empty when u_end <= u_begin or v_end <= v_begin.
struct PixelWindow {
  int u_begin = 0, v_begin = 0;
  int u_end = 0, v_end = 0;

  [[nodiscard]] bool empty() const noexcept { return u_end <= u_begin || v_end <= v_begin; }
  [[nodiscard]] bool contains(int u, int v) const noexcept {
    return u >= u_begin && u < u_end && v >= v_begin && v < v_end;
  }
};

/// All pixels of the image.
[[nodiscard]] PixelWindow whole_image(const PinholeCamera& camera) noexcept;

/// Equations (8)-(9) as printed: sides rho f / (d_p - rho), half of which reach to each side of the point. That is half
/// of what a sphere of radius rho needs: at 2 m and rho = 0.4 m obstacles are missed from 0.25 m off the axis outward.
/// For d_p <= rho the equations are undefined and the whole image is taken.
[[nodiscard]] PixelWindow printed_window(const PinholeCamera& camera, const DepthPoint& p, double rho_m) noexcept;

/// The smallest rectangle of pixels that covers the projection of the sphere of radius rho_m around p_camera (metres):
/// per axis the slopes t = (X Z -+ rho sqrt(X^2 + Z^2 - rho^2)) / (Z^2 - rho^2). The whole image when the sphere
/// touches the plane z = 0, empty when it lies behind it. Clipped to the image.
[[nodiscard]] PixelWindow sphere_window(const PinholeCamera& camera, const Eigen::Vector3d& p_camera,
                                        double rho_m) noexcept;

}  // namespace depthgrid::grid
