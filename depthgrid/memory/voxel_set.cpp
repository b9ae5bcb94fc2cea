#include "depthgrid/memory/voxel_set.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace depthgrid::memory {
namespace {

constexpr Block kFirstRow = 0xF;  ///< x of y = z = 0
/// More than the rounding of positions in the region.
constexpr double kGuard = 1e-9;
/// Cells that a box of questions spans along each axis at most, unless they are of the coarsest level.
constexpr int kSpan = 12;

/// Bits first to last, both within 0 to 3.
constexpr Block some(int first, int last) noexcept { return (kFirstRow >> (3 - (last - first))) << first; }

/// Cells first to last along each axis, inclusive.
struct Cells {
  std::array<int, 3> first{};
  std::array<int, 3> last{};
};

/// Those bits of a block that belong to the cells.
Block mask_of(const Cells& cells, const std::array<int, 3>& block) noexcept {
  std::array<Block, 3> along{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    along[axis] =
        some(std::max(cells.first[axis] - 4 * block[axis], 0), std::min(cells.last[axis] - 4 * block[axis], 3));
  }
  // Four bits become the first bit of each of four rows, and of each of four layers.
  const Block rows = (along[1] & 1U) | (along[1] & 2U) << 3U | (along[1] & 4U) << 6U | (along[1] & 8U) << 9U;
  const Block layers = (along[2] & 1U) | (along[2] & 2U) << 15U | (along[2] & 4U) << 30U | (along[2] & 8U) << 45U;
  return along[0] * rows * layers;
}

double squared(double x) noexcept { return x * x; }

}  // namespace

VoxelSet::VoxelSet(const Eigen::Vector3d& low_world, const Eigen::Vector3d& high_world, double voxel_m)
    : low_(low_world), high_(low_world), voxel_m_(voxel_m) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    int blocks = std::max(static_cast<int>(std::ceil((high_world[a] - low_world[a]) / (4 * voxel_m) - 1e-6)), 1);
    high_[a] += 4 * blocks * voxel_m;
    int cells = 4 * blocks;
    for (Level& level : levels_) {
      level.cells[axis] = cells;
      level.blocks[axis] = blocks;
      cells = blocks;
      blocks = (blocks + 3) / 4;
    }
  }
  for (Level& level : levels_) {
    level.bits.resize(static_cast<std::size_t>(level.blocks[0]) * static_cast<std::size_t>(level.blocks[1]) *
                      static_cast<std::size_t>(level.blocks[2]));
  }
  fill();
}

void VoxelSet::fill() noexcept {
  std::fill(levels_[0].bits.begin(), levels_[0].bits.end(), kWholeBlock);
  rebuild();
}

void VoxelSet::clear() noexcept {
  for (Level& level : levels_) {
    std::fill(level.bits.begin(), level.bits.end(), Block{0});
  }
}

void VoxelSet::copy(const VoxelSet& other) noexcept {
  for (int level = 0; level < kLevels; ++level) {
    std::copy(other.at(level).bits.begin(), other.at(level).bits.end(), at(level).bits.begin());
  }
}

std::int64_t VoxelSet::count() const noexcept {
  std::int64_t result = 0;
  for (const Block voxels : levels_[0].bits) {
    result += std::popcount(voxels);
  }
  return result;
}

void VoxelSet::set(int x, int y, int z) noexcept {
  for (Level& level : levels_) {
    level.bits[index(level, x >> 2, y >> 2, z >> 2)] |= Block{1} << bit(x, y, z);
    x >>= 2;
    y >>= 2;
    z >>= 2;
  }
}

void VoxelSet::remove(int x, int y, int z, Block voxels) noexcept {
  for (Level& level : levels_) {
    Block& bits = level.bits[index(level, x, y, z)];
    bits &= ~voxels;
    if (bits != 0) {
      return;
    }
    voxels = Block{1} << bit(x, y, z);
    x >>= 2;
    y >>= 2;
    z >>= 2;
  }
}

void VoxelSet::rebuild() noexcept {
  for (int above = 1; above < kLevels; ++above) {
    Level& level = at(above);
    std::fill(level.bits.begin(), level.bits.end(), Block{0});
    const Block* bits = at(above - 1).bits.data();
    for (int z = 0; z < level.cells[2]; ++z) {
      for (int y = 0; y < level.cells[1]; ++y) {
        Block* row = &level.bits[index(level, 0, y >> 2, z >> 2)];
        for (int x = 0; x < level.cells[0]; ++x) {
          row[x >> 2] |= (*bits != 0 ? Block{1} : Block{0}) << bit(x, y, z);
          ++bits;
        }
      }
    }
  }
}

/// The finest level on which not too many cells lie along the extent.
int VoxelSet::level_for(double extent_m) const noexcept {
  int level = 0;
  double span_m = kSpan * voxel_m_;
  while (level + 1 < kLevels && extent_m > span_m) {
    ++level;
    span_m *= 4;
  }
  return level;
}

/// From and to lie in the region with their reach, relative to its low corner.
bool VoxelSet::meets_cells(int level, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                           double reach_m) const noexcept {
  const double cell_m = std::ldexp(voxel_m_, 2 * level);
  Cells cells;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    const int end = at(level).cells[axis] - 1;
    cells.first[axis] = std::clamp(static_cast<int>(std::floor((from[a] - reach_m) / cell_m)), 0, end);
    cells.last[axis] = std::clamp(static_cast<int>(std::floor((to[a] + reach_m) / cell_m)), 0, end);
  }
  // How far a cell is from the box along one axis.
  const auto gap = [&](int cell, Eigen::Index axis) {
    return std::max({cell * cell_m - to[axis], from[axis] - (cell + 1) * cell_m, 0.0});
  };
  std::array<int, 3> at_block{};
  for (at_block[2] = cells.first[2] >> 2; at_block[2] <= cells.last[2] >> 2; ++at_block[2]) {
    for (at_block[1] = cells.first[1] >> 2; at_block[1] <= cells.last[1] >> 2; ++at_block[1]) {
      for (at_block[0] = cells.first[0] >> 2; at_block[0] <= cells.last[0] >> 2; ++at_block[0]) {
        Block bits = block(level, at_block[0], at_block[1], at_block[2]);
        bits = bits != 0 ? bits & mask_of(cells, at_block) : bits;
        for (; bits != 0; bits &= bits - 1) {
          const int place = std::countr_zero(bits);
          const double square = squared(gap(4 * at_block[0] + (place & 3), 0)) +
                                squared(gap(4 * at_block[1] + ((place >> 2) & 3), 1)) +
                                squared(gap(4 * at_block[2] + (place >> 4), 2));
          if (square <= squared(reach_m)) {
            return true;
          }
        }
      }
    }
  }
  return false;
}

bool VoxelSet::may_meet(const Eigen::Vector3d& low_world, const Eigen::Vector3d& high_world,
                        double reach_m) const noexcept {
  const double reach = reach_m + kGuard;
  const Eigen::Vector3d from = low_world - low_;
  const Eigen::Vector3d to = high_world - low_;
  if (!((from.array() >= reach).all() && (to.array() + reach <= (high_ - low_).array()).all())) {
    return true;  // outside, or no number
  }
  return meets_cells(level_for((to - from).maxCoeff() + 2 * reach), from, to, reach);
}

bool VoxelSet::meets(const Eigen::Vector3d& low_world, const Eigen::Vector3d& high_world,
                     double reach_m) const noexcept {
  if (!may_meet(low_world, high_world, reach_m)) {
    return false;
  }
  const double reach = reach_m + kGuard;
  const Eigen::Vector3d from = low_world - low_;
  const Eigen::Vector3d to = high_world - low_;
  const bool inside = (from.array() >= reach).all() && (to.array() + reach <= (high_ - low_).array()).all();
  return !inside || level_for((to - from).maxCoeff() + 2 * reach) == 0 || meets_cells(0, from, to, reach);
}

}  // namespace depthgrid::memory
