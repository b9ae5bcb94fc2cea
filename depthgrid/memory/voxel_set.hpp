// A set of voxels in a box, and whether something of it lies within reach of a box in the world.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace depthgrid::memory {

/// 4 x 4 x 4 cells of one level: bit x + 4 y + 16 z.
using Block = std::uint64_t;
inline constexpr Block kWholeBlock = ~Block{0};

/// Half the diagonal of a voxel, in its sides.
inline constexpr double kVoxelHalfDiagonal = 0.8660254037844387;

/// A bit for each voxel of a kept region; what lies outside of the region is in the set, always. Over the voxels stand
/// two coarser levels, each a bit for 4 x 4 x 4 cells of the level below.
/// - Frame and units: the region's axes are the world's; metres.
/// - Memory: allocated by the constructor; copying to a set of the same region does not allocate.
/// - Threads: as a std::vector.
class VoxelSet {
 public:
  static constexpr int kLevels = 3;
  /// Voxels along a side of a block of the last level.
  static constexpr int kLargestBlock = 64;

  /// The region from `low_world` to `high_world`, enlarged at its high end to whole blocks. Everything is set.
  VoxelSet(const Eigen::Vector3d& low_world, const Eigen::Vector3d& high_world, double voxel_m);

  [[nodiscard]] double voxel_m() const noexcept { return voxel_m_; }
  [[nodiscard]] const Eigen::Vector3d& low_world() const noexcept { return low_; }
  [[nodiscard]] const Eigen::Vector3d& high_world() const noexcept { return high_; }
  /// Along each axis.
  [[nodiscard]] const std::array<int, 3>& voxels() const noexcept { return levels_[0].cells; }
  /// Blocks of a level along each axis.
  [[nodiscard]] const std::array<int, 3>& blocks(int level) const noexcept { return at(level).blocks; }
  [[nodiscard]] Eigen::Vector3d centre_world(int x, int y, int z) const noexcept {
    return low_ + voxel_m_ * Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5);
  }

  void fill() noexcept;
  void clear() noexcept;
  /// Everything of a set of the same region.
  void copy(const VoxelSet& other) noexcept;
  /// How many voxels are set.
  [[nodiscard]] std::int64_t count() const noexcept;

  /// Of voxels in the region.
  [[nodiscard]] bool contains(int x, int y, int z) const noexcept {
    return ((block(0, x >> 2, y >> 2, z >> 2) >> bit(x, y, z)) & 1U) != 0;
  }
  void set(int x, int y, int z) noexcept;
  void reset(int x, int y, int z) noexcept { remove(x >> 2, y >> 2, z >> 2, Block{1} << bit(x, y, z)); }

  [[nodiscard]] Block block(int level, int x, int y, int z) const noexcept {
    return at(level).bits[index(at(level), x, y, z)];
  }
  /// Whoever writes to it sees to the levels above and below.
  [[nodiscard]] Block& block(int level, int x, int y, int z) noexcept {
    return at(level).bits[index(at(level), x, y, z)];
  }
  /// Takes these voxels out of a block of level 0; the levels above follow.
  void remove(int x, int y, int z, Block voxels) noexcept;
  /// The voxels themselves, block by block, x first. Whoever writes them calls rebuild() after.
  [[nodiscard]] std::vector<Block>& voxel_blocks() noexcept { return levels_[0].bits; }
  [[nodiscard]] const std::vector<Block>& voxel_blocks() const noexcept { return levels_[0].bits; }
  /// The levels over the voxels, from them.
  void rebuild() noexcept;

  /// Whether a point of the set, or of what lies outside of the region, is within reach_m of the box (all closed).
  /// Never false if there is one; true also where one is up to 1e-9 m too far.
  [[nodiscard]] bool meets(const Eigen::Vector3d& low_world, const Eigen::Vector3d& high_world,
                           double reach_m) const noexcept;
  /// In few look-ups: true also where something is in a cell of a coarser level that is within reach_m, if the box or
  /// its reach is large.
  [[nodiscard]] bool may_meet(const Eigen::Vector3d& low_world, const Eigen::Vector3d& high_world,
                              double reach_m) const noexcept;

  [[nodiscard]] static int bit(int x, int y, int z) noexcept { return (x & 3) + 4 * (y & 3) + 16 * (z & 3); }

 private:
  struct Level {
    std::array<int, 3> cells{};
    std::array<int, 3> blocks{};
    std::vector<Block> bits;
  };

  [[nodiscard]] int level_for(double extent_m) const noexcept;
  [[nodiscard]] bool meets_cells(int level, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                 double reach_m) const noexcept;
  [[nodiscard]] Level& at(int level) noexcept { return levels_[static_cast<std::size_t>(level)]; }
  [[nodiscard]] const Level& at(int level) const noexcept { return levels_[static_cast<std::size_t>(level)]; }
  [[nodiscard]] static std::size_t index(const Level& level, int x, int y, int z) noexcept {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(level.blocks[1]) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(level.blocks[0]) +
           static_cast<std::size_t>(x);
  }

  std::array<Level, kLevels> levels_;
  Eigen::Vector3d low_;
  Eigen::Vector3d high_;
  double voxel_m_;
};

}  // namespace depthgrid::memory
