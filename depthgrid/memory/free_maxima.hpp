// Up to which depth some pixel of a rectangle is free or robot, at most. Internal.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "depthgrid/views/prepared_image.hpp"

namespace depthgrid::memory {

/// A pyramid of maxima over an image, level by level: texel (i, j) of level n covers the pixels
/// [i 4 2^n, (i + 1) 4 2^n) x [j 4 2^n, (j + 1) 4 2^n).
class FreeMaxima {
 public:
  static constexpr int kLevels = 8;
  struct Level {
    std::int32_t offset = 0;  ///< of its first texel
    std::int32_t width = 0;
    std::int32_t height = 0;
    std::int32_t shift = 0;  ///< from pixels to texels
  };

  /// Allocates for images up to this size.
  FreeMaxima(int width_px, int height_px);
  /// Of an image of at most that size. The robot's islands count as free up to their far end.
  void update(const views::PreparedImage& image) noexcept;

  [[nodiscard]] const std::array<Level, kLevels>& levels() const noexcept { return levels_; }
  [[nodiscard]] const float* texels_m() const noexcept { return texels_m_.data(); }

 private:
  void lay_out(int width_px, int height_px) noexcept;

  std::array<Level, kLevels> levels_{};
  std::vector<float> texels_m_;
};

}  // namespace depthgrid::memory
