#include "depthgrid/monitor/record_file.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/monitor/monitor.hpp"
#include "depthgrid/monitor/ros2_messages.hpp"

namespace depthgrid::monitor {
namespace {

using messages::type_of;

void check_recorded_name(const std::string& name) {
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

files::McapWriterOptions only_new() {
  files::McapWriterOptions options;
  options.only_new = true;
  return options;
}

/// Throws before there is a file.
const RecorderSettings& checked(const RecorderSettings& settings) {
  for (const RigCamera& camera : settings.rig.cameras) {
    check_recorded_name(camera.id);
  }
  return settings;
}

}  // namespace

RecordFile::RecordFile(const RecorderSettings& settings)
    : settings_(checked(settings)), clock_{.ahead_ns = system_ahead_ns()}, writer_(settings.file, only_new()) {
  try {
    begin();
  } catch (...) {  // the file is ours, and nothing is in it
    std::error_code ignored;
    std::filesystem::remove(settings.file, ignored);
    throw;
  }
}

void RecordFile::begin() {
  const messages::Time now = clock_.stamp(sensors::clock_now_s());
  writer_.add_metadata(kRecordedMetadata, {{"version", "1"},
                                           {"clock_ahead_ns", std::to_string(clock_.ahead_ns)},
                                           {"cell_file", settings_.cell_file.string()},
                                           {"cell", settings_.cell_text},
                                           {"rig", to_string(settings_.rig)}});
  for (const RigCamera& camera : settings_.rig.cameras) {
    CameraTopics topics;
    const std::string images_topic = recorded_images(camera.id);
    topics.image = writer_.add_channel(images_topic, type_of<messages::Image>());
    topics.info = writer_.add_channel(images_topic.substr(0, images_topic.rfind('/')) + "/camera_info",
                                      type_of<messages::CameraInfo>());
    topics.calibration = messages::camera_info({.intrinsics = camera.intrinsics, .distortion = {}},
                                               {.stamp = now, .frame_id = camera.id});
    cameras_.push_back(std::move(topics));
  }
  const std::uint16_t places = writer_.add_channel("/tf_static", type_of<messages::Transforms>(), true);
  frames_ = writer_.add_channel(kRecordedFrames, type_of<messages::Transforms>());
  joint_states_ = writer_.add_channel(kRecordedJoints, type_of<messages::JointState>());
  distances_ = writer_.add_channel(kRecordedDistances, type_of<messages::Distances>());
  happenings_ = writer_.add_channel(kRecordedEvents, type_of<messages::Text>());
  write(places, now, camera_frames(settings_.standing, {.stamp = now, .frame_id = settings_.frame}));
  if (!settings_.robot_description.empty()) {
    const std::uint16_t description = writer_.add_channel(kRecordedDescription, type_of<messages::Text>(), true);
    write(description, now, messages::Text{settings_.robot_description});
  }
  writer_.flush();
}

void RecordFile::image(std::size_t camera, const messages::Image& taken, double time_s, double joints_s,
                       const std::optional<messages::Transform>& moved) {
  CameraTopics& topics = cameras_[camera];
  const messages::Header header{.stamp = clock_.stamp(time_s), .frame_id = settings_.rig.cameras[camera].id};
  if (moved) {
    messages::Transforms place;
    place.transforms.push_back({.header = {.stamp = header.stamp, .frame_id = settings_.frame},
                                .child_frame_id = header.frame_id,
                                .transform = *moved});
    write(frames_, header.stamp, place);
  }
  topics.calibration.header = header;
  write(topics.info, header.stamp, topics.calibration);
  messages::Image image = taken;
  image.header = header;
  write(topics.image, header.stamp, image);
  topics.known.push_back({.image_s = time_s, .joints_s = joints_s});
  if (topics.known.size() > 2 * kRecordedImagesWait) {
    topics.known.pop_front();
  }
}

void RecordFile::joints(double time_s, const std::vector<double>& q) {
  messages::JointState state;
  state.header.stamp = clock_.stamp(time_s);
  state.name = settings_.joints;
  state.position = q;
  write(joint_states_, state.header.stamp, state);
}

void RecordFile::answer(const CellAnswer& answer) {
  const messages::Header header{.stamp = clock_.stamp(answer.time_s), .frame_id = settings_.frame};
  messages::Distances message = distances_message(answer, settings_.names, header);
  tell_basis(
      answer, [this](double time_s) { return clock_.stamp(time_s); }, message);
  for (std::size_t k = 0; k < cameras_.size(); ++k) {
    const std::deque<Known>& known = cameras_[k].known;
    const auto of = std::find_if(known.rbegin(), known.rend(),
                                 [&](const Known& image) { return image.image_s == answer.cameras.at(k).image_s; });
    message.image_joint_stamps.push_back(of != known.rend() ? clock_.stamp(of->joints_s) : messages::Time{});
  }
  write(distances_, header.stamp, message);
}

void RecordFile::event(const Event& event) {
  write(happenings_, clock_.stamp(event.time_s), messages::Text{event_line(event, settings_.names)});
}

void RecordFile::finish(std::uint64_t lost_images, std::uint64_t lost_joint_states, std::uint64_t lost_answers) {
  writer_.add_metadata(kRecordedEnd, {{"dropped_images", std::to_string(lost_images)},
                                      {"dropped_joint_states", std::to_string(lost_joint_states)},
                                      {"dropped_answers", std::to_string(lost_answers)}});
  writer_.close();
}

}  // namespace depthgrid::monitor
