// Which pixel showed last that the ball of a voxel is not free to a camera. Internal.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "depthgrid/core/aligned_vector.hpp"

namespace depthgrid::memory {

/// For each voxel of a region, block by block: how many columns and rows the pixel lies from the one that the voxel's
/// centre projects to. A guess where to look first in the next image; that pixel is asked like any other, so that no
/// answer depends on it.
/// - Memory: 2 bytes a voxel, allocated by the constructor.
/// - Threads: the one that writes the memory.
class BlockingPixels {
 public:
  static constexpr std::size_t kVoxels = 64;  ///< of a block

  explicit BlockingPixels(std::size_t blocks) : offsets_(blocks * kVoxels) {}

  /// Of a block's voxels: columns in the low byte, rows in the high one, each from -127 to 127.
  [[nodiscard]] std::int16_t* of_block(std::size_t block) noexcept { return offsets_.data() + block * kVoxels; }

  [[nodiscard]] static std::int16_t offset(int columns, int rows) noexcept {
    return static_cast<std::int16_t>(256 * std::clamp(rows, -127, 127) + (std::clamp(columns, -127, 127) & 255));
  }

 private:
  AlignedVector<std::int16_t> offsets_;
};

}  // namespace depthgrid::memory
