#include "depthgrid/views/view_store.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "depthgrid/core/blind_layer.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/views/held_slots.hpp"

namespace depthgrid::views {
namespace {

/// Moves the space of interest farther than any distance between two places in it (cf. kLargestTranslation): a camera
/// whose time is not known frees nothing.
constexpr double kUnboundedMotion = 1e9;

constexpr FrameUpdate kNoCamera{UpdateResult::unusable, "the rig has no such camera"};

/// What pose_from_matrix() and validate(Rig) accept, without throwing.
bool is_valid(const Pose& pose) noexcept {
  const Eigen::Matrix3d rotation = pose.linear();
  return pose.matrix().allFinite() && pose.matrix().row(3) == Eigen::RowVector4d(0, 0, 0, 1) &&
         (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= kRotationTolerance &&
         rotation.determinant() > 0 && pose.translation().cwiseAbs().maxCoeff() <= kLargestTranslation;
}

}  // namespace

// How snapshots stay whole while images arrive.
//
// `newest` names the newest buffer of all cameras in one word, so what one load returns was newest at one instant.
// A snapshot loads the word, adds one to the reference count of each named buffer, and loads the word again: only if it
// is still the same does it use the buffers. A writer (one a camera) fills a buffer that is not its camera's newest and
// has no references, then replaces its camera's bits. All these operations are sequentially consistent.
//
// Claim: a buffer of a confirmed snapshot was completely written before and is not written again until released.
// Let buffer b of camera k be in the confirmed word; "add" < "confirm" are the snapshot's operations. Any writing of b
// is enclosed by the writer's steps "another buffer becomes newest" < "look at b's count, find 0" < write < "b becomes
// newest"; between the first and the last of them the word does not name b. At "confirm" the word names b, so it lies
// outside of every such enclosure: those before it are complete, and visible because "confirm" read what they published
// or something later. One after it looks at the count after "confirm", hence after "add", and finds b referenced until
// the snapshot is released. That the word may have changed and come back between the two loads (ABA) does no harm: the
// argument uses only its value at "confirm". The count of 0 that the writer read includes all releases, so what readers
// did with b before is complete.
//
// Progress: a snapshot repeats only because some camera published an image in between.
struct ViewStore::State {
  struct alignas(64) Camera {
    std::vector<View> views;
    mutable SlotReferences references{};
  };

  State(const Rig& rig_in, Settings settings_in, int held_snapshots)
      : rig(checked_rig(rig_in, "view store")), settings(std::move(settings_in)), cameras(rig.cameras.size()) {
    views::validate(settings, rig);
    const std::size_t slots = slots_for(held_snapshots, "view store");
    for (std::size_t k = 0; k < cameras.size(); ++k) {
      // Buffer 0 is the newest at first; without a frame it frees nothing.
      for (std::size_t slot = 0; slot < slots; ++slot) {
        cameras[k].views.emplace_back(rig.cameras[k], settings.margins[k], settings.policies);
      }
    }
  }

  /// For the camera's writer, or whoever holds it.
  [[nodiscard]] const View& newest_view(std::size_t camera) const noexcept {
    return cameras[camera].views[slot_of(newest.load(), camera)];
  }

  /// With a pose that is not a rigid transform the camera stays where it was.
  FrameUpdate update(std::size_t camera, const Frame& frame, const Pose& T_world_camera) noexcept {
    std::vector<View>& views = cameras[camera].views;
    const std::size_t slot = free_slot(cameras[camera].references, views.size(), slot_of(newest.load(), camera));
    if (slot == views.size()) {
      return {UpdateResult::dropped, "held snapshots occupy every buffer of this camera"};
    }
    const char* reason = views[slot].why_unusable(frame);
    if (is_valid(T_world_camera)) {
      // Does not throw or allocate, because is_valid() has checked the same rules.
      (void)views[slot].update(frame, pose_from_matrix(T_world_camera.matrix()));
    } else {
      (void)views[slot].update(Frame{}, newest_view(camera).T_world_camera());
      reason = reason != nullptr
                   ? reason
                   : "the pose is not a rigid transform: not finite, not a rotation, or farther than the largest "
                     "translation";
    }
    make_newest(newest, camera, slot);
    return reason == nullptr ? FrameUpdate{} : FrameUpdate{UpdateResult::unusable, reason};
  }

  [[nodiscard]] std::uint64_t acquire() const noexcept {
    return hold_newest(
        newest, [this](std::uint64_t slots) { hold(slots); }, [this](std::uint64_t slots) { release(slots); });
  }

  void hold(std::uint64_t slots) const noexcept {
    for (std::size_t k = 0; k < cameras.size(); ++k) {
      cameras[k].references[slot_of(slots, k)].fetch_add(1);
    }
  }

  void release(std::uint64_t slots) const noexcept {
    for (std::size_t k = 0; k < cameras.size(); ++k) {
      cameras[k].references[slot_of(slots, k)].fetch_sub(1);
    }
  }

  Rig rig;
  Settings settings;
  std::vector<Camera> cameras;
  std::atomic<std::uint64_t> newest{0};
};

static_assert(kMaxCameras * 4 <= 64, "the newest buffers of all cameras fit into one word");
static_assert(std::atomic<std::uint64_t>::is_always_lock_free && std::atomic<std::uint32_t>::is_always_lock_free);

ViewStore::ViewStore(const Rig& rig, const Settings& settings, int held_snapshots)
    : state_(std::make_unique<State>(rig, settings, held_snapshots)) {}
ViewStore::~ViewStore() = default;

FrameUpdate ViewStore::update(std::size_t camera, const Frame& frame) noexcept {
  return camera < state_->cameras.size() ? state_->update(camera, frame, state_->rig.cameras[camera].T_world_camera)
                                         : kNoCamera;
}

FrameUpdate ViewStore::update(std::size_t camera, const Frame& frame, const Pose& T_world_camera) noexcept {
  return camera < state_->cameras.size() ? state_->update(camera, frame, T_world_camera) : kNoCamera;
}

Snapshot ViewStore::snapshot() const noexcept { return snapshot(-std::numeric_limits<double>::infinity()); }
Snapshot ViewStore::snapshot(double oldest_s) const noexcept { return {*state_, oldest_s}; }
const Rig& ViewStore::rig() const noexcept { return state_->rig; }
const Settings& ViewStore::settings() const noexcept { return state_->settings; }

Snapshot::Snapshot(const ViewStore::State& state, double oldest_s) noexcept : state_(&state), slots_(state.acquire()) {
  const Settings& settings = state.settings;
  double newest_s = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < camera_count(); ++k) {
    if (view(k).present() && std::isfinite(view(k).time_s())) {
      newest_s = std::max(newest_s, view(k).time_s());
    }
  }
  reference_time_s_ = std::isfinite(newest_s) ? newest_s : std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 0; k < camera_count(); ++k) {
    const CameraMargins& margins = settings.margins[k];
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    const double age_s = std::isfinite(view(k).time_s()) ? reference_time_s_ - view(k).time_s() : kUnknown;
    const double motion_m =
        motion_margin_m(margins, settings.v_max_m_s * (age_s + margins.half_exposure_s + margins.time_uncertainty_s));
    const double bounded_m = motion_m <= kUnboundedMotion ? motion_m : kUnboundedMotion;
    // With a clock to ask, an image that does not say when it was taken may be of any age.
    const bool timeless = std::isfinite(oldest_s) && !std::isfinite(view(k).time_s());
    const bool is_late = view(k).present() && (timeless || view(k).time_s() < oldest_s);
    late_ |= is_late ? std::uint32_t{1} << k : 0;
    // What does not move is where it was, whenever that was; but nobody knows for how long that holds.
    const double moved_m = is_late ? kUnboundedMotion : settings.v_max_m_s > 0 ? bounded_m : 0.0;
    pose_margins_[k] = {margins.translation_m, margins.rotation_rad, moved_m};
    blind_m_ = thicker(blind_m_, view(k).blind_m());
    stale_ = stale_ || is_late || !view(k).present() || !(age_s <= settings.max_frame_age_s);
  }
}

Snapshot::Snapshot(Snapshot&& other) noexcept
    : state_(std::exchange(other.state_, nullptr)),
      slots_(other.slots_),
      pose_margins_(other.pose_margins_),
      reference_time_s_(other.reference_time_s_),
      blind_m_(other.blind_m_),
      late_(other.late_),
      stale_(other.stale_) {}

Snapshot& Snapshot::operator=(Snapshot&& other) noexcept {
  if (this != &other) {
    release();
    state_ = std::exchange(other.state_, nullptr);
    slots_ = other.slots_;
    pose_margins_ = other.pose_margins_;
    reference_time_s_ = other.reference_time_s_;
    blind_m_ = other.blind_m_;
    late_ = other.late_;
    stale_ = other.stale_;
  }
  return *this;
}

Snapshot::~Snapshot() { release(); }

void Snapshot::release() noexcept {
  if (state_ != nullptr) {
    state_->release(slots_);
    state_ = nullptr;
  }
}

std::size_t Snapshot::camera_count() const noexcept { return state_ != nullptr ? state_->cameras.size() : 0; }
const Pose& Snapshot::T_world_camera(std::size_t camera) const noexcept { return view(camera).T_world_camera(); }
const View& Snapshot::view(std::size_t camera) const noexcept {
  return state_->cameras[camera].views[slot_of(slots_, camera)];
}
const PoseMargin& Snapshot::pose_margin(std::size_t camera) const noexcept { return pose_margins_[camera]; }
const RigCamera& Snapshot::camera(std::size_t camera) const noexcept { return state_->rig.cameras[camera]; }
const Settings& Snapshot::settings() const noexcept { return state_->settings; }

}  // namespace depthgrid::views
