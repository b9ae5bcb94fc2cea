// What may be where, remembered from image to image and shared between the threads that deliver images and those that
// ask.
//
// Assumed: nothing moves faster than v_max, and whatever enters the region comes through its border or through space
// that no camera saw free. Then what was seen free stays free until something could have come there through space
// that was not seen free meanwhile. docs/memory.md has the proof, and what happens when an assumption is broken.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "depthgrid/core/capsule.hpp"
#include "depthgrid/core/impossible_surfaces.hpp"
#include "depthgrid/core/past.hpp"
#include "depthgrid/memory/settings.hpp"
#include "depthgrid/views/view_store.hpp"

namespace depthgrid::memory {

class MemorySnapshot;
class VoxelSet;

/// What became of images and of what they showed.
struct MemoryCount {
  std::int64_t images = 0;   ///< that were looked at
  std::int64_t dropped = 0;  ///< a newer one came before there was time, or held snapshots occupied every buffer
  /// Voxels with a measured surface that were put back though nothing could have been there, errors and motion
  /// counted: v_max is too low, something was dropped, or a clock or a calibration is wrong.
  std::int64_t impossible = 0;
};

/// - Takes: the images of a ViewStore, each at its own exposure, in any order.
/// - Gives: snapshots of what may be where.
/// - Errors: the constructor throws Error.
/// - Threads: take() and occupy() from any threads at once; snapshot() any number meanwhile.
/// - All are lock-free and allocate nothing.
///
/// Images that are not looked at, late, or missing need nothing special: what they would have shown free ages.
class MemoryStore {
 public:
  /// Of the images in `views`, which has to outlive it; v_max and margins are those of its settings. `held_snapshots`:
  /// how many different snapshots may be held at once before images are dropped (1-13). take() holds a snapshot of
  /// `views` for a while. Throws Error when settings are invalid.
  MemoryStore(const views::ViewStore& views, const MemorySettings& settings, int held_snapshots = 2);
  ~MemoryStore();
  MemoryStore(const MemoryStore&) = delete;
  MemoryStore& operator=(const MemoryStore&) = delete;

  /// Looks at a camera's newest image. While another thread looks at one, that thread looks at this one as well, and
  /// the call returns at once.
  void take(std::size_t camera) noexcept;

  /// Something may be within distance_m of these capsules (world, metres): what the robot has put down or let go, and
  /// where it passed meanwhile. Images that were exposed before time_s take nothing out any more: to them it was part
  /// of the robot. False: another thread writes just now, or snapshots occupy every buffer; nothing has changed, ask
  /// again before it is let go.
  [[nodiscard]] bool occupy(std::span<const Capsule> capsules, double distance_m, double time_s) noexcept;

  /// The latest time_s of occupy(), minus infinity without one: to images from before it, what was let go is part of
  /// the robot still, so a search should not take them for new (ViewStore::snapshot(oldest_s)).
  [[nodiscard]] double released_s() const noexcept;

  /// What may be where, as of the image that was looked at last. The store must outlive the snapshot.
  [[nodiscard]] MemorySnapshot snapshot() const noexcept;

  /// Since when something may be at a place, and from where, as of the image that was looked at last: of the voxel of
  /// the set that is nearest to it. `within_m`: how far, beyond the set's reach, the place may lie from that voxel;
  /// from an answer's nearest point the search's resolution and v_max times the time between the answer and the newest
  /// image. For people: nothing of it decides what is answered. Lock-free; holds a snapshot meanwhile.
  [[nodiscard]] Past past(const Eigen::Vector3d& x_world, double within_m) const noexcept;

  [[nodiscard]] const MemorySettings& settings() const noexcept;
  /// So far.
  [[nodiscard]] MemoryCount count() const noexcept;

 private:
  friend class MemorySnapshot;
  struct State;
  std::unique_ptr<State> state_;
};

/// One state of the memory, unchanged until it is destroyed.
/// - Threads: questions from any number of threads. Movable.
class MemorySnapshot {
 public:
  MemorySnapshot(MemorySnapshot&& other) noexcept;
  MemorySnapshot& operator=(MemorySnapshot&& other) noexcept;
  MemorySnapshot(const MemorySnapshot&) = delete;
  MemorySnapshot& operator=(const MemorySnapshot&) = delete;
  ~MemorySnapshot();

  /// Every place where something may be at t_ref lies within this of a voxel of the set or of what lies outside of
  /// the region. Metres; infinite where no time is known, and then the memory says nothing.
  [[nodiscard]] double reach_m(double t_ref_s) const noexcept;
  [[nodiscard]] const VoxelSet& voxels() const noexcept;
  /// Of the newest image in it; NaN when there is none.
  [[nodiscard]] double time_s() const noexcept;
  /// Measured surfaces, so far, where by this memory nothing could have been.
  [[nodiscard]] const ImpossibleSurfaces& impossible() const noexcept;
  /// Differs between any two states of the process.
  [[nodiscard]] std::uint64_t version() const noexcept;

 private:
  friend class MemoryStore;
  explicit MemorySnapshot(const MemoryStore::State& state) noexcept;
  void release() noexcept;

  const MemoryStore::State* state_ = nullptr;
  std::uint32_t slot_ = 0;
};

}  // namespace depthgrid::memory
