// The part of space that one pixel looks at between two depths, and its distance from a point.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>

#include "depthgrid/core/camera.hpp"

namespace depthgrid {

/// The convex set { a0 z <= x <= a1 z, b0 z <= y <= b1 z, d1 <= z <= d2 } in the camera frame, metres.
/// Invariants: 0 <= d1 <= d2, d2 may be infinite, a0 <= a1, b0 <= b1.
struct PixelFrustum {
  double a0 = 0, a1 = 0;
  double b0 = 0, b1 = 0;
  double d1_m = 0;
  double d2_m = std::numeric_limits<double>::infinity();
};

/// Nearest point of a set and its distance, camera frame, metres.
struct NearestPoint {
  Eigen::Vector3d point_camera;
  double distance_m = 0;
  /// Unit vector from the query point to point_camera; zero where the distance is zero.
  Eigen::Vector3d direction_camera;
};

/// The frustum of pixel (u, v) of `camera` between the depths d1_m and d2_m. The pixel may lie outside the image.
[[nodiscard]] PixelFrustum pixel_frustum(const PinholeCamera& camera, int u, int v, double d1_m, double d2_m) noexcept;

/// Exact Euclidean distance from `p_camera` to the frustum, in closed form. With x and y minimised first,
///   F(z) = (X - clamp(X, a0 z, a1 z))^2 + (Y - clamp(Y, b0 z, b1 z))^2 + (Z - z)^2
/// is strictly convex and piecewise quadratic with at most four breakpoints X/a0, X/a1, Y/b0, Y/b1; its minimum over
/// [d1, d2] is an end or the one root of F'. Exact to double rounding (about 1e-12 m at 10 m). p_camera must be finite.
[[nodiscard]] NearestPoint nearest_point(const PixelFrustum& frustum, const Eigen::Vector3d& p_camera) noexcept;

/// Distance only, squared; the same minimum as nearest_point().
[[nodiscard]] double squared_distance(const PixelFrustum& frustum, const Eigen::Vector3d& p_camera) noexcept;

/// The letter's equations (5)-(7): clamps in pixel coordinates, so never less than the exact distance; up to 7 mm more
/// for 1 cm cells. `p` is the point in depth space (equation (2), p.depth_m > 0). d2_m may equal d1_m (case (ii), a
/// surface); it must be finite unless p.depth_m < d1_m.
[[nodiscard]] NearestPoint nearest_point_letter(const PinholeCamera& camera, int u, int v, double d1_m, double d2_m,
                                                const DepthPoint& p) noexcept;

/// Equations (5)-(7) for one point and many pixels: what depends on the point alone is computed once.
class LetterDistance {
 public:
  /// `p` is the point in depth space, p.depth_m > 0.
  LetterDistance(const PinholeCamera& camera, const DepthPoint& p) noexcept
      : camera_(camera),
        p_(p),
        x_px_m_((p.x_px - camera.cx_px) * p.depth_m),
        y_px_m_((p.y_px - camera.cy_px) * p.depth_m),
        inverse_fx_(1.0 / camera.fx_px),
        inverse_fy_(1.0 / camera.fy_px) {}

  /// The vector (v_x v_y v_z) of (7) from the point to the cell, camera frame, metres. Arguments as above.
  [[nodiscard]] Eigen::Vector3d vector(int u, int v, double d1_m, double d2_m) const noexcept {
    const double o_x_px = std::min(std::max(p_.x_px, static_cast<double>(u)), u + 1.0);  // (5)
    const double o_y_px = std::min(std::max(p_.y_px, static_cast<double>(v)), v + 1.0);
    const double o_d_m = std::min(std::max(p_.depth_m, d1_m), d2_m);  // (6)
    return {((o_x_px - camera_.cx_px) * o_d_m - x_px_m_) * inverse_fx_,
            ((o_y_px - camera_.cy_px) * o_d_m - y_px_m_) * inverse_fy_, o_d_m - p_.depth_m};  // (7)
  }

 private:
  PinholeCamera camera_;
  DepthPoint p_;
  double x_px_m_, y_px_m_;
  double inverse_fx_, inverse_fy_;
};

}  // namespace depthgrid
