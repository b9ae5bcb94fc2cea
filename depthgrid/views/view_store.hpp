// The newest image of every camera, shared between the threads that deliver images and those that ask.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/frame_update.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/views/settings.hpp"
#include "depthgrid/views/view.hpp"

namespace depthgrid::views {

class Snapshot;

/// - Takes: depth images of the rig's sizes; poses camera to world; seconds on one clock for all cameras.
/// - Gives: snapshots, each the newest image of every camera at one instant.
/// - Errors: the constructor throws Error; update() says what became of a frame.
/// - Threads: update() one at a time for each camera, different cameras at once; snapshot() any number meanwhile.
/// - Both are lock-free and allocate nothing.
///
/// It holds a few prepared images of each camera.
class ViewStore {
 public:
  /// `held_snapshots`: how many different snapshots may be held at once before a camera's next frame is dropped (1-13);
  /// each costs one prepared image a camera. Images must be free of lens distortion. Throws Error when rig or settings
  /// are invalid.
  ViewStore(const Rig& rig, const Settings& settings, int held_snapshots = 2);
  ~ViewStore();
  ViewStore(const ViewStore&) = delete;
  ViewStore& operator=(const ViewStore&) = delete;

  /// Takes a frame of one camera. With `T_world_camera` the camera has moved; without, it is where the rig says.
  /// Unusable: no data, wrong size or scale, rows that overlap, half a robot view, a pose that is not a rigid
  /// transform, no such camera. Dropped: held snapshots occupy every buffer of this camera.
  [[nodiscard]] FrameUpdate update(std::size_t camera, const Frame& frame) noexcept;
  [[nodiscard]] FrameUpdate update(std::size_t camera, const Frame& frame, const Pose& T_world_camera) noexcept;

  /// The newest image of every camera, all published at one instant. To a camera without a frame so far nothing is
  /// known free.
  /// t_ref is the newest exposure. The store must outlive the snapshot.
  [[nodiscard]] Snapshot snapshot() const noexcept;
  /// Images that were exposed before `oldest_s` are late: they free nothing, and the snapshot is stale. So is an
  /// image without a time, unless oldest_s is not finite.
  [[nodiscard]] Snapshot snapshot(double oldest_s) const noexcept;

  [[nodiscard]] const Rig& rig() const noexcept;
  [[nodiscard]] const Settings& settings() const noexcept;

 private:
  friend class Snapshot;
  struct State;
  std::unique_ptr<State> state_;
};

/// A consistent set of views, held until it is destroyed.
/// - Threads: queries on one snapshot from any number of threads. Movable.
class Snapshot {
 public:
  Snapshot(Snapshot&& other) noexcept;
  Snapshot& operator=(Snapshot&& other) noexcept;
  Snapshot(const Snapshot&) = delete;
  Snapshot& operator=(const Snapshot&) = delete;
  ~Snapshot();

  [[nodiscard]] std::size_t camera_count() const noexcept;
  [[nodiscard]] const View& view(std::size_t camera) const noexcept;
  /// e_k of this snapshot; time_m = (1 + rotation) v_max (|t_k - t_ref| + half exposure + time
  /// uncertainty), see motion_margin_m().
  [[nodiscard]] const PoseMargin& pose_margin(std::size_t camera) const noexcept;
  /// Its image is older than was asked for, so it frees nothing.
  [[nodiscard]] bool late(std::size_t camera) const noexcept { return ((late_ >> camera) & 1U) != 0; }
  /// A bit a camera: late().
  [[nodiscard]] std::uint32_t late_cameras() const noexcept { return late_; }
  [[nodiscard]] const RigCamera& camera(std::size_t camera) const noexcept;
  /// Where the camera was at its newest frame, usable or not; where the rig says while there is none.
  [[nodiscard]] const Pose& T_world_camera(std::size_t camera) const noexcept;
  [[nodiscard]] const Settings& settings() const noexcept;
  /// Newest exposure of all cameras present; NaN when there is none.
  [[nodiscard]] double reference_time_s() const noexcept { return reference_time_s_; }
  /// A camera is missing, late, has no finite time, or is older than the newest by more than max_frame_age_s.
  [[nodiscard]] bool stale() const noexcept { return stale_; }
  /// Answer::blind_m of everything asked of this snapshot: the thickest layer of its images.
  [[nodiscard]] double blind_m() const noexcept { return blind_m_; }

 private:
  friend class ViewStore;
  Snapshot(const ViewStore::State& state, double oldest_s) noexcept;
  void release() noexcept;

  const ViewStore::State* state_ = nullptr;
  std::uint64_t slots_ = 0;
  std::array<PoseMargin, kMaxCameras> pose_margins_{};
  double reference_time_s_ = 0;
  double blind_m_ = 0;
  std::uint32_t late_ = 0;
  bool stale_ = false;
};

}  // namespace depthgrid::views
