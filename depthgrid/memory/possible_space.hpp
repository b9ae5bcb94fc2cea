// What may be where at one time. Internal.
#pragma once

#include <cstdint>
#include <limits>

#include "depthgrid/core/impossible_surfaces.hpp"
#include "depthgrid/memory/voxel_set.hpp"

namespace depthgrid::memory {

/// At time_s every place where something may be lies within pending_m of a voxel that is set. With a smallest hidden
/// thing of diameter s it is every centre of a ball of that diameter of which obstacles consist.
struct PossibleSpace {
  VoxelSet voxels;
  double pending_m = 0;
  double time_s = std::numeric_limits<double>::quiet_NaN();  ///< not known before the first image
  ImpossibleSurfaces impossible{};                           ///< so far
  bool is_everything = false;                                ///< nothing has been taken out since it was filled
  std::uint64_t version = 0;                                 ///< differs between any two of the process
};

}  // namespace depthgrid::memory
