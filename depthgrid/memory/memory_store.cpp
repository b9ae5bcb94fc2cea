#include "depthgrid/memory/memory_store.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/memory/declarations.hpp"
#include "depthgrid/memory/history.hpp"
#include "depthgrid/memory/image_intake.hpp"
#include "depthgrid/memory/one_writer.hpp"
#include "depthgrid/memory/possible_space.hpp"
#include "depthgrid/views/held_slots.hpp"

namespace depthgrid::memory {
namespace {

std::uint64_t next_version() noexcept {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

bool is_finite(std::span<const Capsule> capsules) noexcept {
  return std::all_of(capsules.begin(), capsules.end(), [](const Capsule& capsule) {
    return capsule.a.allFinite() && capsule.b.allFinite() && std::isfinite(capsule.radius_m);
  });
}

PossibleSpace first_space(const MemorySettings& settings) {
  validate(settings);
  PossibleSpace space{.voxels = VoxelSet(settings.low_world, settings.high_world, settings.voxel_m)};
  space.is_everything = true;
  space.version = next_version();
  if (const auto* start = std::get_if<StartEmptyAroundRobot>(&settings.start)) {
    take_out(start->robot_world, start->distance_m, settings.thinnest_hidden_m, space);
  } else if (std::holds_alternative<StartEmpty>(settings.start)) {
    space.voxels.clear();
    space.is_everything = false;
  }
  return space;
}

}  // namespace

// How snapshots stay whole while images arrive: as those of views::ViewStore, whose proof holds here with one "camera".
// `newest` names the newest buffer. A snapshot loads it, adds one to that buffer's references, and loads it again; only
// if it is still the same does it use the buffer. A writer fills a buffer that is not the newest and has no
// references, then makes it the newest.
// There is one writer at a time (OneWriter).
struct MemoryStore::State {
  State(const views::ViewStore& views_in, const MemorySettings& settings_in, int held_snapshots)
      : views(views_in),
        settings(settings_in),
        intake(views_in, settings_in),
        history(first_space(settings_in).voxels) {
    const views::Policies& policies = views.settings().policies;
    if (policies.robot_pockets == views::Policy::ignored && policies.ignored_pocket_m > 0) {
      fail("memory store: pockets behind the robot are ignored up to ", policies.ignored_pocket_m,
           " m, and would stay ignored where the robot has been; with a memory robot_pockets has to be obstacle");
    }
    slots.assign(views::slots_for(held_snapshots, "memory store"), first_space(settings));
  }

  /// For the writer: changes a copy of the newest space and publishes it. False where there is no buffer.
  template <class Change>
  bool write(Change&& change) noexcept {
    return write_newest(newest, references, slots.size(), [&](std::size_t newest_slot, std::size_t slot) {
      const PossibleSpace& before = slots[newest_slot];
      PossibleSpace& space = slots[slot];
      space.voxels.copy(before.voxels);
      space.pending_m = before.pending_m;
      space.time_s = before.time_s;
      space.is_everything = before.is_everything;
      space.impossible = before.impossible;
      change(space);
      space.version = next_version();
    });
  }

  void look_at(std::uint32_t cameras) noexcept {
    const views::Snapshot snapshot = views.snapshot();
    Intake result;
    if (write([&](PossibleSpace& space) { result = intake.take(snapshot, cameras, space, history); })) {
      images += result.images;
      impossible += result.impossible;
    } else {
      dropped += std::popcount(cameras);
    }
  }

  /// For the writer. False where there is no buffer.
  bool let_go(std::span<const Capsule> capsules, double distance_m, double time_s) noexcept {
    const bool written = write([&](PossibleSpace& space) {
      const double since_s = space.time_s - time_s;
      if (is_finite(capsules) && std::isfinite(distance_m) && std::isfinite(since_s)) {
        // The set is of the time of the newest image, which may be later.
        put_in(capsules, distance_m + views.settings().v_max_m_s * std::max(0.0, since_s), space);
      } else {
        space.voxels.fill();
        space.pending_m = 0;
        space.is_everything = true;
      }
      if (std::isfinite(space.time_s)) {
        history.note(space.voxels, space.time_s, false);
      }
    });
    if (written) {
      intake.ignore_before(time_s);
      released_s.store(std::max(released_s.load(), time_s));
    }
    return written;
  }

  [[nodiscard]] std::uint32_t acquire() const noexcept {
    return views::hold_newest(
        newest, [this](std::uint32_t slot) { references[slot].fetch_add(1); },
        [this](std::uint32_t slot) { references[slot].fetch_sub(1); });
  }

  const views::ViewStore& views;
  MemorySettings settings;
  std::vector<PossibleSpace> slots;
  mutable views::SlotReferences references{};
  std::atomic<std::uint32_t> newest{0};
  OneWriter<std::atomic<bool>, std::atomic<std::uint32_t>> writer;
  ImageIntake intake;  ///< the writer's
  History history;     ///< written by the writer
  std::atomic<double> released_s{-std::numeric_limits<double>::infinity()};
  std::atomic<std::int64_t> images{0}, dropped{0}, impossible{0};
};

static_assert(views::kMaxCameras <= 32, "the waiting cameras fit into one word");
static_assert(std::atomic<double>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free &&
              std::atomic<std::uint32_t>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

MemoryStore::MemoryStore(const views::ViewStore& views, const MemorySettings& settings, int held_snapshots)
    : state_(std::make_unique<State>(views, settings, held_snapshots)) {}
MemoryStore::~MemoryStore() = default;

void MemoryStore::take(std::size_t camera) noexcept {
  if (camera >= state_->views.rig().cameras.size()) {
    return;
  }
  const std::uint32_t bit = std::uint32_t{1} << camera;
  if (!state_->writer.leave(bit)) {
    ++state_->dropped;  // the one that waits is looked at no more: the camera has a newer one
  }
  state_->writer.look_at_waiting([this](std::uint32_t cameras) { state_->look_at(cameras); });
}

bool MemoryStore::occupy(std::span<const Capsule> capsules, double distance_m, double time_s) noexcept {
  bool written = false;
  const bool was_free = state_->writer.try_write([&] { written = state_->let_go(capsules, distance_m, time_s); },
                                                 [this](std::uint32_t cameras) { state_->look_at(cameras); });
  return was_free && written;
}

double MemoryStore::released_s() const noexcept { return state_->released_s.load(); }
MemorySnapshot MemoryStore::snapshot() const noexcept { return MemorySnapshot(*state_); }
Past MemoryStore::past(const Eigen::Vector3d& x_world, double within_m) const noexcept {
  const MemorySnapshot newest = snapshot();
  return state_->history.past(x_world, newest.reach_m(newest.time_s()) + within_m);
}
const MemorySettings& MemoryStore::settings() const noexcept { return state_->settings; }
MemoryCount MemoryStore::count() const noexcept {
  return {state_->images.load(), state_->dropped.load(), state_->impossible.load()};
}

MemorySnapshot::MemorySnapshot(const MemoryStore::State& state) noexcept : state_(&state), slot_(state.acquire()) {}

MemorySnapshot::MemorySnapshot(MemorySnapshot&& other) noexcept
    : state_(std::exchange(other.state_, nullptr)), slot_(other.slot_) {}

MemorySnapshot& MemorySnapshot::operator=(MemorySnapshot&& other) noexcept {
  if (this != &other) {
    release();
    state_ = std::exchange(other.state_, nullptr);
    slot_ = other.slot_;
  }
  return *this;
}

MemorySnapshot::~MemorySnapshot() { release(); }

void MemorySnapshot::release() noexcept {
  if (state_ != nullptr) {
    state_->references[slot_].fetch_sub(1);
    state_ = nullptr;
  }
}

double MemorySnapshot::reach_m(double t_ref_s) const noexcept {
  const PossibleSpace& space = state_->slots[slot_];
  const double age_s = std::abs(t_ref_s - space.time_s);
  if (!std::isfinite(age_s)) {
    return std::numeric_limits<double>::infinity();
  }
  return space.pending_m + 0.5 * state_->settings.thinnest_hidden_m + state_->views.settings().v_max_m_s * age_s;
}

const VoxelSet& MemorySnapshot::voxels() const noexcept { return state_->slots[slot_].voxels; }
double MemorySnapshot::time_s() const noexcept { return state_->slots[slot_].time_s; }
const ImpossibleSurfaces& MemorySnapshot::impossible() const noexcept { return state_->slots[slot_].impossible; }
std::uint64_t MemorySnapshot::version() const noexcept { return state_->slots[slot_].version; }

}  // namespace depthgrid::memory
