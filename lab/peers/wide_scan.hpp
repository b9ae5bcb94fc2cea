// Brute force over points and pixels with the widest instructions of the machine at hand, chosen at run time.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "depthgrid/grid/surveillance_window.hpp"

namespace depthgrid::lab {

/// Points beside each other in memory need no gather.
struct CloudColumns {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  std::size_t count = 0;  ///< a multiple of kWidestVector: pad with kFarAway
};
inline constexpr std::size_t kWidestVector = 16;
inline constexpr float kFarAway = 1e15F;

/// The smaller of `bound_squared` and the squared distance to the nearest point.
[[nodiscard]] float nearest_squared(const CloudColumns& cloud, const Eigen::Vector3f& p, float bound_squared);

/// An image with the rays of its pixels.
struct RayImage {
  const float* free_m = nullptr;   ///< rows without padding
  const float* slope_x = nullptr;  ///< x/z of each column
  const float* slope_y = nullptr;  ///< y/z of each row
  int width_px = 0;                ///< at least kWidestVector
};

/// The smaller of `bound_squared` and the squared distance from p (camera frame) to the nearest shadow of a pixel in
/// `window`: the part of the pixel's centre ray from the measured depth on. May look a few pixels beyond the window.
[[nodiscard]] float nearest_shadow_squared(const RayImage& image, const grid::PixelWindow& window,
                                           const Eigen::Vector3f& p, float bound_squared);

/// One row of pixels in the world frame: origin + depth (slope along + offset).
struct WorldRow {
  const float* depth_m = nullptr;
  const float* slope_x = nullptr;
  std::size_t width = 0;  ///< at least kWidestVector
  std::array<float, 3> along{}, offset{}, origin{};
  std::array<float, 3> low{}, high{};  ///< the box of points that count
};

/// Writes the coordinates of all pixels, and 1 where the pixel has a depth and lies in the box, else 0.
void deproject_row(const WorldRow& row, float* x, float* y, float* z, float* keep);

}  // namespace depthgrid::lab
