#include "depthgrid/monitor/recorder.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <string>
#include <utility>

#include "depthgrid/monitor/record_file.hpp"
#include "depthgrid/monitor/record_ring.hpp"
#include "depthgrid/monitor/recorded_format.hpp"
#include "depthgrid/sensors/clock.hpp"

namespace depthgrid::monitor {
namespace {

// Two seconds of them, where images wait for half a one.
constexpr std::size_t kJointRoom = 2048;
constexpr std::size_t kAnswerRoom = 1024;
/// What a program that dies loses of its recording.
constexpr double kFlush_s = 1;
constexpr double kLook_s = 0.005;

struct WaitingImage {
  messages::DepthPixels pixels;
  messages::Image image;  ///< of the pixels
  double time_s = 0;
  double joints_s = 0;
  std::optional<messages::Transform> moved{};
};

struct WaitingJoints {
  double time_s = 0;
  std::vector<double> q;
};

WaitingImage image_slot(const Rig& rig) {
  std::size_t most = 0;
  for (const RigCamera& camera : rig.cameras) {
    most = std::max(most, static_cast<std::size_t>(camera.intrinsics.width_px) *
                              static_cast<std::size_t>(camera.intrinsics.height_px));
  }
  WaitingImage slot;
  slot.pixels.units.resize(most);
  return slot;
}

CellAnswer answer_slot(const RecorderSettings& settings) {
  CellAnswer slot;
  slot.parts.resize(settings.names.parts.size());
  slot.parts_world.resize(settings.names.parts.size());
  return slot;
}

}  // namespace

struct Recorder::State {
  explicit State(const RecorderSettings& wanted)
      : settings(wanted),
        joints(kJointRoom, {.time_s = 0, .q = std::vector<double>(wanted.joints.size())}),
        answers(kAnswerRoom, answer_slot(wanted)),
        to(std::make_unique<RecordFile>(wanted)) {}

  /// One of each that waits; what a disk that is full does not take is dropped. False: nothing was there.
  bool work();
  template <class T, class Write>
  bool drain(RecordRing<T>& ring, std::size_t most, std::atomic<std::uint64_t>& written, const Write& write);
  /// Runs it; where it fails nothing more is written.
  template <class Action>
  bool attempt(const Action& action) noexcept;
  void finish();

  RecorderSettings settings;
  std::vector<std::unique_ptr<RecordRing<WaitingImage>>> images;
  RecordRing<WaitingJoints> joints;
  RecordRing<CellAnswer> answers;
  std::vector<std::unique_ptr<EventQueue>> events;
  EventQueue told;
  std::unique_ptr<RecordFile> to;  ///< null: it has failed, or is closed
  std::atomic<std::uint64_t> written_images{0};
  std::atomic<std::uint64_t> written_joints{0};
  std::atomic<std::uint64_t> written_answers{0};
  std::atomic<bool> failed{false};
};

template <class Action>
bool Recorder::State::attempt(const Action& action) noexcept {
  if (to == nullptr) {
    return false;
  }
  std::string why = "unknown error";
  try {
    action();
    return true;
  } catch (const std::exception& error) {
    why = error.what();
  } catch (...) {  // told below
  }
  to.reset();  // what was written so far stays readable
  failed = true;
  Event event;
  event.time_s = sensors::clock_now_s();
  event.kind = EventKind::recording_failed;
  event.say(why + "; nothing more is recorded");
  told.push(event);
  return false;
}

template <class T, class Write>
bool Recorder::State::drain(RecordRing<T>& ring, std::size_t most, std::atomic<std::uint64_t>& written,
                            const Write& write) {
  bool any = false;
  for (const T* waiting = ring.front(); waiting != nullptr && most > 0; waiting = ring.front(), --most) {
    if (attempt([&] { write(*waiting); })) {
      written.fetch_add(1, std::memory_order_relaxed);
    } else {
      ring.drop();
    }
    ring.pop();
    any = true;
  }
  return any;
}

// What an answer stands on was put into its queue before the answer was: so it is written first.
bool Recorder::State::work() {
  const std::size_t count = answers.size();
  bool any = drain(joints, kJointRoom, written_joints,
                   [this](const WaitingJoints& state) { to->joints(state.time_s, state.q); });
  for (std::size_t k = 0; k < images.size(); ++k) {
    any = drain(*images[k], kRecordedImagesWait, written_images,
                [&](const WaitingImage& waiting) {
                  to->image(k, waiting.image, waiting.time_s, waiting.joints_s, waiting.moved);
                }) ||
          any;
  }
  for (const std::unique_ptr<EventQueue>& queue : events) {
    Event event;
    while (queue->pop(event)) {
      (void)attempt([&] { to->event(event); });
    }
  }
  return drain(answers, count, written_answers, [this](const CellAnswer& answer) { to->answer(answer); }) || any;
}

void Recorder::State::finish() {
  std::uint64_t lost_images = 0;
  for (const auto& ring : images) {
    lost_images += ring->dropped();
  }
  to->finish(lost_images, joints.dropped(), answers.dropped());
}

Recorder::Recorder(const RecorderSettings& settings) : state_(std::make_unique<State>(settings)) {
  const WaitingImage slot = image_slot(settings.rig);
  for (std::size_t k = 0; k < settings.rig.cameras.size(); ++k) {
    state_->images.push_back(std::make_unique<RecordRing<WaitingImage>>(kRecordedImagesWait, slot));
  }
}

Recorder::~Recorder() = default;

void Recorder::image(std::size_t camera, const DepthView& depth, double time_s,
                     const std::optional<Pose>& T_world_camera, double joints_s) noexcept {
  RecordRing<WaitingImage>& ring = *state_->images[camera];
  WaitingImage* const waiting = ring.back();
  if (waiting == nullptr) {
    return;
  }
  try {
    waiting->image = messages::image_of(depth, state_->settings.rig.cameras[camera].rule, waiting->pixels);
  } catch (...) {  // no memory
    ring.drop();
    return;
  }
  waiting->time_s = time_s;
  waiting->joints_s = joints_s;
  waiting->moved = T_world_camera ? std::optional(recorded_pose(*T_world_camera)) : std::nullopt;
  ring.publish();
}

void Recorder::joints(double time_s, std::span<const double> q) noexcept {
  WaitingJoints* const waiting = state_->joints.back();
  if (waiting != nullptr) {
    waiting->time_s = time_s;
    std::copy_n(q.begin(), std::min(q.size(), waiting->q.size()), waiting->q.begin());
    state_->joints.publish();
  }
}

void Recorder::answer(const CellAnswer& answer) noexcept {
  CellAnswer* const waiting = state_->answers.back();
  if (waiting != nullptr) {
    *waiting = answer;  // of the same size, so nothing is allocated
    state_->answers.publish();
  }
}

EventQueue& Recorder::events() { return *state_->events.emplace_back(std::make_unique<EventQueue>()); }

void Recorder::run(const std::stop_token& stop) noexcept {
  State& state = *state_;
  double flush_s = sensors::clock_now_s() + kFlush_s;
  while (!stop.stop_requested()) {
    const bool any = state.work();
    const double now_s = sensors::clock_now_s();
    if (now_s >= flush_s) {
      flush_s = now_s + kFlush_s;
      (void)state.attempt([&] { state.to->flush(); });
    }
    if (!any) {
      (void)sensors::wait_until(now_s + kLook_s, kLook_s);
    }
  }
  while (state.work()) {
  }
  if (state.attempt([&] { state.finish(); })) {
    state.to.reset();
  }
}

RecorderCounts Recorder::counts() const noexcept {
  const State& state = *state_;
  RecorderCounts counts;
  counts.images = state.written_images.load(std::memory_order_relaxed);
  counts.joint_states = state.written_joints.load(std::memory_order_relaxed);
  counts.answers = state.written_answers.load(std::memory_order_relaxed);
  for (const auto& ring : state.images) {
    counts.dropped_images += ring->dropped();
  }
  counts.dropped_joint_states = state.joints.dropped();
  counts.dropped_answers = state.answers.dropped();
  counts.failed = state.failed.load(std::memory_order_relaxed);
  return counts;
}

EventQueue& Recorder::told() noexcept { return state_->told; }
const std::filesystem::path& Recorder::file() const noexcept { return state_->settings.file; }

}  // namespace depthgrid::monitor
