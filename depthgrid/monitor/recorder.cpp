#include "depthgrid/monitor/recorder.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <deque>
#include <exception>
#include <string_view>
#include <system_error>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/files/mcap_writer.hpp"
#include "depthgrid/messages/serialization.hpp"
#include "depthgrid/monitor/monitor.hpp"
#include "depthgrid/monitor/record_ring.hpp"
#include "depthgrid/monitor/recorded_format.hpp"
#include "depthgrid/monitor/ros2_messages.hpp"

namespace depthgrid::monitor {
namespace {

using messages::type_of;

// Half a second of images at 30 Hz, and two seconds of the others.
constexpr std::size_t kImageRoom = 16;
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

/// Of a camera's image: the newest joint state that was known.
struct Known {
  double image_s = 0;
  double joints_s = 0;
};

struct CameraTopics {
  std::uint16_t image = 0;
  std::uint16_t info = 0;
  messages::CameraInfo calibration;
  std::deque<Known> known;
};

void check_topic_name(const std::string& name) {
  const auto may_stand = [](unsigned char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '/';
  };
  if (name.empty() || !std::all_of(name.begin(), name.end(), may_stand)) {
    fail("recording: camera '", name, "': its name cannot be a topic's, which has letters, digits, _ and / only");
  }
}

std::int64_t system_ahead_ns() {
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(since_1970).count() -
         sensors::nanoseconds_of(sensors::clock_now_s());
}

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

files::McapWriterOptions only_new() {
  files::McapWriterOptions options;
  options.only_new = true;
  return options;
}

}  // namespace

struct Recorder::State {
  explicit State(const RecorderSettings& wanted)
      : settings(wanted),
        clock{.ahead_ns = system_ahead_ns()},
        joints(kJointRoom, {.time_s = 0, .q = std::vector<double>(wanted.joints.size())}),
        answers(kAnswerRoom, answer_slot(wanted)),
        writer(std::make_unique<files::McapWriter>(wanted.file, only_new())) {}

  void begin();
  void write(std::uint16_t channel, const messages::Time& stamp, const auto& message) {
    messages::to_bytes(message, bytes);
    const auto time_ns = static_cast<std::uint64_t>(std::max<std::int64_t>(0, messages::nanoseconds(stamp)));
    writer->write(channel, time_ns, time_ns, bytes);
  }
  void write_image(std::size_t camera, const WaitingImage& waiting);
  void write_joints(const WaitingJoints& waiting);
  void write_answer(const CellAnswer& answer);
  void write_event(const Event& event);
  /// One of each that waits; what a disk that is full does not take is dropped. False: nothing was there.
  bool work();
  template <class T, class Write>
  bool drain(RecordRing<T>& ring, std::size_t most, std::atomic<std::uint64_t>& written, const Write& write);
  /// Runs it; where it fails nothing more is written.
  template <class Action>
  bool attempt(const Action& action) noexcept;
  void finish();

  RecorderSettings settings;
  RecordedClock clock;
  std::vector<std::unique_ptr<RecordRing<WaitingImage>>> images;
  RecordRing<WaitingJoints> joints;
  RecordRing<CellAnswer> answers;
  std::vector<std::unique_ptr<EventQueue>> events;
  EventQueue told;
  std::unique_ptr<files::McapWriter> writer;  ///< null: it has failed, or is closed
  std::vector<CameraTopics> cameras;
  std::uint16_t frames = 0;
  std::uint16_t joint_states = 0;
  std::uint16_t distances = 0;
  std::uint16_t happenings = 0;
  std::vector<std::byte> bytes;
  std::atomic<std::uint64_t> written_images{0};
  std::atomic<std::uint64_t> written_joints{0};
  std::atomic<std::uint64_t> written_answers{0};
  std::atomic<bool> failed{false};
};

void Recorder::State::begin() {
  const messages::Time now = clock.stamp(sensors::clock_now_s());
  writer->add_metadata(kRecordedMetadata, {{"version", "1"},
                                           {"clock_ahead_ns", std::to_string(clock.ahead_ns)},
                                           {"cell_file", settings.cell_file.string()},
                                           {"cell", settings.cell_text},
                                           {"rig", to_string(settings.rig)}});
  for (const RigCamera& camera : settings.rig.cameras) {
    CameraTopics topics;
    const std::string images_topic = recorded_images(camera.id);
    topics.image = writer->add_channel(images_topic, type_of<messages::Image>());
    topics.info = writer->add_channel(images_topic.substr(0, images_topic.rfind('/')) + "/camera_info",
                                      type_of<messages::CameraInfo>());
    topics.calibration = messages::camera_info({.intrinsics = camera.intrinsics, .distortion = {}},
                                               {.stamp = now, .frame_id = camera.id});
    cameras.push_back(std::move(topics));
  }
  const std::uint16_t places = writer->add_channel("/tf_static", type_of<messages::Transforms>(), true);
  frames = writer->add_channel(kRecordedFrames, type_of<messages::Transforms>());
  joint_states = writer->add_channel(kRecordedJoints, type_of<messages::JointState>());
  distances = writer->add_channel(kRecordedDistances, type_of<messages::Distances>());
  happenings = writer->add_channel(kRecordedEvents, type_of<messages::Text>());
  write(places, now, camera_frames(settings.standing, {.stamp = now, .frame_id = settings.frame}));
  if (!settings.robot_description.empty()) {
    const std::uint16_t description = writer->add_channel(kRecordedDescription, type_of<messages::Text>(), true);
    write(description, now, messages::Text{settings.robot_description});
  }
  writer->flush();
}

void Recorder::State::write_image(std::size_t camera, const WaitingImage& waiting) {
  CameraTopics& topics = cameras[camera];
  const messages::Header header{.stamp = clock.stamp(waiting.time_s), .frame_id = settings.rig.cameras[camera].id};
  if (waiting.moved) {
    messages::Transforms place;
    place.transforms.push_back({.header = {.stamp = header.stamp, .frame_id = settings.frame},
                                .child_frame_id = header.frame_id,
                                .transform = *waiting.moved});
    write(frames, header.stamp, place);
  }
  topics.calibration.header = header;
  write(topics.info, header.stamp, topics.calibration);
  messages::Image image = waiting.image;
  image.header = header;
  write(topics.image, header.stamp, image);
  topics.known.push_back({.image_s = waiting.time_s, .joints_s = waiting.joints_s});
  if (topics.known.size() > 2 * kImageRoom) {
    topics.known.pop_front();
  }
}

void Recorder::State::write_joints(const WaitingJoints& waiting) {
  messages::JointState state;
  state.header.stamp = clock.stamp(waiting.time_s);
  state.name = settings.joints;
  state.position = waiting.q;
  write(joint_states, state.header.stamp, state);
}

void Recorder::State::write_answer(const CellAnswer& answer) {
  const messages::Header header{.stamp = clock.stamp(answer.time_s), .frame_id = settings.frame};
  messages::Distances message = distances_message(answer, settings.names, header);
  tell_basis(
      answer, [this](double time_s) { return clock.stamp(time_s); }, message);
  for (std::size_t k = 0; k < cameras.size(); ++k) {
    const std::deque<Known>& known = cameras[k].known;
    const auto of = std::find_if(known.rbegin(), known.rend(),
                                 [&](const Known& image) { return image.image_s == answer.cameras.at(k).image_s; });
    message.image_joint_stamps.push_back(of != known.rend() ? clock.stamp(of->joints_s) : messages::Time{});
  }
  write(distances, header.stamp, message);
}

void Recorder::State::write_event(const Event& event) {
  write(happenings, clock.stamp(event.time_s), messages::Text{event_line(event, settings.names)});
}

template <class Action>
bool Recorder::State::attempt(const Action& action) noexcept {
  if (writer == nullptr) {
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
  writer.reset();  // what was written so far stays readable
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
  bool any = drain(joints, kJointRoom, written_joints, [this](const WaitingJoints& state) { write_joints(state); });
  for (std::size_t k = 0; k < images.size(); ++k) {
    any =
        drain(*images[k], kImageRoom, written_images, [&](const WaitingImage& image) { write_image(k, image); }) || any;
  }
  for (const std::unique_ptr<EventQueue>& queue : events) {
    Event event;
    while (queue->pop(event)) {
      (void)attempt([&] { write_event(event); });
    }
  }
  return drain(answers, count, written_answers, [this](const CellAnswer& answer) { write_answer(answer); }) || any;
}

void Recorder::State::finish() {
  std::uint64_t lost_images = 0;
  for (const auto& ring : images) {
    lost_images += ring->dropped();
  }
  writer->add_metadata(kRecordedEnd, {{"dropped_images", std::to_string(lost_images)},
                                      {"dropped_joint_states", std::to_string(joints.dropped())},
                                      {"dropped_answers", std::to_string(answers.dropped())}});
  writer->close();
}

Recorder::Recorder(const RecorderSettings& settings) {
  for (const RigCamera& camera : settings.rig.cameras) {
    check_topic_name(camera.id);
  }
  state_ = std::make_unique<State>(settings);
  const WaitingImage slot = image_slot(settings.rig);
  for (std::size_t k = 0; k < settings.rig.cameras.size(); ++k) {
    state_->images.push_back(std::make_unique<RecordRing<WaitingImage>>(kImageRoom, slot));
  }
  try {
    state_->begin();
  } catch (...) {  // the file is ours, and nothing is in it
    state_->writer.reset();
    std::error_code ignored;
    std::filesystem::remove(settings.file, ignored);
    throw;
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
      (void)state.attempt([&] { state.writer->flush(); });
    }
    if (!any) {
      (void)sensors::wait_until(now_s + kLook_s, kLook_s);
    }
  }
  while (state.work()) {
  }
  if (state.attempt([&] { state.finish(); })) {
    state.writer.reset();
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
