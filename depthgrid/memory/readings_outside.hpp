// Readings of a row of pixels that lie in the region but in none of the set's voxels. Internal.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "depthgrid/memory/voxel_set.hpp"

namespace depthgrid::memory {

/// Pixels of a row, every n-th one, as lines in space: in voxels from the region's corner, pixel u of depth m lies at
/// origin + m (first + u step) along each axis.
struct RowOfReadings {
  const float* depth_m;  ///< of the whole row, 0 without a reading
  int begin, end, stride;
  std::array<float, 3> origin, first, step;
};

struct ReadingOutside {
  std::int32_t u, x, y, z;  ///< its pixel and the voxel that it lies in
};

/// Writes them one after the other, no more than there are pixels, and returns how many. Single precision, the same
/// with every instruction set.
std::size_t readings_outside(const RowOfReadings& row, const VoxelSet& voxels, ReadingOutside* to) noexcept;

}  // namespace depthgrid::memory
