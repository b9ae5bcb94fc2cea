#include "depthgrid/memory/growth.hpp"

#include <algorithm>

namespace depthgrid::memory {
namespace {

/// One axis: bits move by `Step` within a block, and from the last of the four to the first of the next block.
template <int Step>
constexpr Block spread(Block here, Block before, Block after) noexcept {
  constexpr Block kFirst = Step == 1 ? 0x1111111111111111 : Step == 4 ? 0x000F000F000F000F : 0x000000000000FFFF;
  constexpr Block kLast = kFirst << (3 * Step);
  return here | ((here << Step) & ~kFirst) | ((before >> (3 * Step)) & kFirst) | ((here >> Step) & ~kLast) |
         ((after << (3 * Step)) & kLast);
}

/// Spreads every row, column or pillar of blocks: those that lie `stride` apart are neighbours, `count` of them.
template <int Step>
void spread_all(const std::vector<Block>& from, std::vector<Block>& to, std::size_t stride,
                std::size_t count) noexcept {
  for (std::size_t begin = 0; begin < from.size(); begin += stride * count) {
    for (std::size_t n = 0; n < count; ++n) {
      const std::size_t at = begin + n * stride;
      for (std::size_t i = at; i < at + stride; ++i) {
        to[i] = spread<Step>(from[i], n > 0 ? from[i - stride] : kWholeBlock,
                             n + 1 < count ? from[i + stride] : kWholeBlock);
      }
    }
  }
}

}  // namespace

void dilate(VoxelSet& set, std::vector<Block>& scratch) noexcept {
  std::vector<Block>& bits = set.voxel_blocks();
  const auto x = static_cast<std::size_t>(set.blocks(0)[0]);
  const auto y = static_cast<std::size_t>(set.blocks(0)[1]);
  const auto z = static_cast<std::size_t>(set.blocks(0)[2]);
  spread_all<1>(bits, scratch, 1, x);
  spread_all<4>(scratch, bits, x, y);
  spread_all<16>(bits, scratch, x * y, z);
  bits.swap(scratch);
}

void grow(PossibleSpace& space, double motion_m, std::vector<Block>& scratch, History* history,
          double until_s) noexcept {
  if (space.is_everything) {
    return;
  }
  VoxelSet& voxels = space.voxels;
  const double voxel_m = voxels.voxel_m();
  space.pending_m += motion_m;
  // From the border inwards everything is reached.
  const double most_m = 0.5 * (voxels.high_world() - voxels.low_world()).minCoeff() + 2 * voxel_m;
  if (!(space.pending_m < most_m)) {
    voxels.fill();
    space.pending_m = 0;
    space.is_everything = true;
    if (history != nullptr) {
      history->note(voxels, until_s, false);
    }
    return;
  }
  const bool grows = space.pending_m >= voxel_m;
  while (space.pending_m >= voxel_m) {
    dilate(voxels, scratch);
    space.pending_m -= voxel_m;
    if (history != nullptr) {
      // What is still pending has been moved since this step was due.
      history->note(voxels, until_s - (until_s - space.time_s) * std::min(space.pending_m / motion_m, 1.0), true);
    }
  }
  if (grows) {
    voxels.rebuild();
  }
}

}  // namespace depthgrid::memory
