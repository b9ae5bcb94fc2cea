// Since when something may be where, and until when nothing could: a time for each voxel of a memory. Internal.
//
// Nothing of it decides what may be where.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "depthgrid/core/past.hpp"
#include "depthgrid/memory/voxel_set.hpp"

namespace depthgrid::memory {

/// - Memory: 8 bytes a voxel, allocated by the constructor.
/// - Threads: note() and begin_anew() by one at a time, which writes the memory; past() by any number meanwhile. What
/// is
///   noted while somebody asks is told as before or as after, voxel by voxel.
class History {
 public:
  /// Of a memory that begins with this set. What is not in it counts as declared empty.
  explicit History(const VoxelSet& first);

  /// The set is this from time_s on. `grown`: what is new in it came from the voxels beside; else it was put in. Steps
  /// are told apart, by up to kStep_s, whatever their times.
  void note(const VoxelSet& set, double time_s, bool grown) noexcept;
  /// The memory begins anew, with the set that was noted last: times are of another clock.
  void begin_anew(double time_s) noexcept;

  /// Of the voxel that is nearest to a place, of those that are in the newest set and within reach_m of it.
  [[nodiscard]] Past past(const Eigen::Vector3d& x_world, double reach_m) const noexcept;

  static constexpr double kStep_s = 1e-3;

 private:
  /// When something was noted: twice the time in kStep_s, or a little more, and odd where voxels grew. 0: never.
  using Step = std::uint32_t;
  static constexpr Step kDeclared = 1;  ///< taken out before the first image
  static constexpr Step kLongAgo = 2;   ///< came in before what is remembered
  static constexpr Step kFirst = 4;
  struct Voxel {
    int x, y, z;
  };
  struct Stamp {
    Step added, removed;
    [[nodiscard]] bool is_set() const noexcept { return removed == 0 || added > removed; }
    /// Whether it was in the set right before a step; not known to be where the set has changed twice since.
    [[nodiscard]] bool was_set_before(Step step) const noexcept {
      return added < step && (removed == 0 || added > removed || removed >= step);
    }
  };

  [[nodiscard]] bool inside(const Voxel& v) const noexcept {
    return v.x >= 0 && v.y >= 0 && v.z >= 0 && v.x < count_[0] && v.y < count_[1] && v.z < count_[2];
  }
  [[nodiscard]] Stamp stamp(const Voxel& v) const noexcept;
  [[nodiscard]] double time_of(Step step) const noexcept;
  void trace(Voxel at, Past& past) const noexcept;
  void forget_times() noexcept;

  std::array<int, 3> count_;
  std::array<int, 3> blocks_;
  Eigen::Vector3d low_world_;
  double voxel_m_;
  std::vector<Block> newest_;  ///< the set as it was noted last
  std::vector<std::atomic<Step>> added_;
  std::vector<std::atomic<Step>> removed_;
  Step last_ = kLongAgo;
  bool has_begun_ = false;
  std::atomic<double> begin_s_{0};  ///< the time of step kFirst
};

}  // namespace depthgrid::memory
