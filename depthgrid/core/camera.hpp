// Pinhole camera: equations (1)-(3) of the letter, in the pixel-edge convention.
//
// Pixel (i, j) covers the square [i, i+1) x [j, j+1) of continuous image coordinates, so the pixel of
// a point is the floor of its projection. OpenCV and ROS put the centre of pixel 0 at 0: from_opencv()
// and to_opencv() add and subtract the half pixel.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace depthgrid {

/// A point in depth space: continuous image coordinates in pixels and depth z in metres.
struct DepthPoint {
  double x_px = 0.0;
  double y_px = 0.0;
  double depth_m = 0.0;
};

/// Intrinsics. fx_px is the product f s_x of equation (2). Distortion is removed before anything else.
struct PinholeCamera {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;  ///< pixel-edge convention
  double cy_px = 0.0;  ///< pixel-edge convention

  /// True when pixel (u, v) lies in the image.
  [[nodiscard]] bool contains(int u, int v) const noexcept { return u >= 0 && v >= 0 && u < width_px && v < height_px; }
};

/// Largest accepted image side in pixels.
inline constexpr int kLargestImageSide = 16384;

/// Largest accepted focal length and distance of the principal point from the image's corner, in pixels.
inline constexpr double kLargestIntrinsic = 1e6;

/// Throws Error unless the size is in [1, kLargestImageSide], focal lengths are positive and all numbers are finite and
/// at most kLargestIntrinsic. `name` is used in messages only.
void validate(const PinholeCamera& camera, const char* name = "camera");

/// Intrinsics from OpenCV's or ROS's convention (centre of pixel 0 at 0). Throws as validate().
PinholeCamera from_opencv(int width_px, int height_px, double fx_px, double fy_px, double cx_px, double cy_px);

/// Principal point in OpenCV's convention (centre of pixel 0 at 0), in pixels.
Eigen::Vector2d principal_point_opencv(const PinholeCamera& camera) noexcept;

/// Equation (2): camera frame (metres) to depth space. Meaningful only for z > 0; the result is not
/// clipped to the image.
[[nodiscard]] inline DepthPoint project(const PinholeCamera& camera, const Eigen::Vector3d& p_camera) noexcept {
  return {camera.fx_px * p_camera.x() / p_camera.z() + camera.cx_px,
          camera.fy_px * p_camera.y() / p_camera.z() + camera.cy_px, p_camera.z()};
}

/// Equation (3): depth space to camera frame, metres.
[[nodiscard]] inline Eigen::Vector3d deproject(const PinholeCamera& camera, const DepthPoint& p) noexcept {
  return {(p.x_px - camera.cx_px) * p.depth_m / camera.fx_px, (p.y_px - camera.cy_px) * p.depth_m / camera.fy_px,
          p.depth_m};
}

}  // namespace depthgrid
