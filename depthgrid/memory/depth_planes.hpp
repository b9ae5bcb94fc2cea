// What an image shows free, piece by piece between two planes. Internal.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "depthgrid/core/aligned_vector.hpp"
#include "depthgrid/core/camera.hpp"
#include "depthgrid/views/prepared_image.hpp"

namespace depthgrid::memory {

/// Windows of pixels of several sizes, and to each two planes in the camera's frame that differ in z only: what lies
/// before the one, {p: near . p < 1}, is free in every pixel of the window as far as it lies there, and what lies
/// behind the other, {p: far . p > 1}, is free in none. The blind zone is left out, and islands count for the
/// second plane only. Inverse depth is linear in the image for every plane in space, so that floors, walls and tables
/// lie close between the two however slanted they are seen.
///
/// Window (i, j) of level n has the pixels [i s, (i + 4) s) x [j s, (j + 4) s) with s = 8 2^n, so that pixels whose
/// first and last differ by at most 3 s lie in one of the windows.
class DepthPlanes {
 public:
  static constexpr int kMostLevels = 12;
  static constexpr int kFirstShift = 3;
  static constexpr int kTiles = 4;  ///< along each side of a window
  struct Level {
    std::int32_t offset = 0;  ///< of its first tile, and of its first window
    std::int32_t width = 0;   ///< tiles along a row; kTiles - 1 fewer windows
    std::int32_t height = 0;
    std::int32_t shift = 0;  ///< from pixels to tiles
  };

  /// Allocates for images up to this size.
  DepthPlanes(int width_px, int height_px);
  /// Of an image of at most that size.
  void update(const views::PreparedImage& image, const PinholeCamera& camera) noexcept;

  [[nodiscard]] const std::array<Level, kMostLevels>& levels() const noexcept { return levels_; }
  [[nodiscard]] std::size_t level_count() const noexcept { return level_count_; }
  /// Per window, 1/m: x and y of both planes, and z of each.
  [[nodiscard]] const float* x() const noexcept { return x_.data(); }
  [[nodiscard]] const float* y() const noexcept { return y_.data(); }
  [[nodiscard]] const float* z_near() const noexcept { return z_near_.data(); }
  [[nodiscard]] const float* z_far() const noexcept { return z_far_.data(); }
  /// And two more that face the camera: their x and y are 0.
  [[nodiscard]] const float* nearest() const noexcept { return nearest_.data(); }
  [[nodiscard]] const float* farthest() const noexcept { return farthest_.data(); }

  /// The inverse depth of each tile: bounded by planes in the image, at + right u + down v from its middle on, u and v
  /// in pixels.
  struct Tiles {
    AlignedVector<float> mean, right, down, most, least, nearest, farthest;
  };

 private:
  void lay_out(int width_px, int height_px) noexcept;

  std::array<Level, kMostLevels> levels_{};
  std::size_t level_count_ = 0;
  Tiles tiles_;
  AlignedVector<float> x_, y_, z_near_, z_far_, nearest_, farthest_;
  AlignedVector<float> rows_;  ///< scratch of one row of tiles
};

}  // namespace depthgrid::memory
