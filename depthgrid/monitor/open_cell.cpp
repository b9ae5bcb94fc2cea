#include "depthgrid/monitor/open_cell.hpp"

#include <algorithm>
#include <array>
#include <ctime>
#include <string>
#include <string_view>
#include <system_error>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/whole_file.hpp"
#include "depthgrid/monitor/device_camera.hpp"
#include "depthgrid/monitor/ros2_output.hpp"
#include "depthgrid/network/datagram_writer.hpp"
#include "depthgrid/network/udp_sender.hpp"
#include "depthgrid/sensors/recorded_camera.hpp"
#include "depthgrid/sensors/recorded_joints.hpp"
#include "depthgrid/sensors/ros2_camera.hpp"
#include "depthgrid/sensors/ros2_joints.hpp"
#include "depthgrid/sensors/simulated_camera.hpp"
#include "depthgrid/sensors/simulated_joints.hpp"

namespace depthgrid::monitor {
namespace {

using cell::SourceKind;

sensors::Ros2Place place_of(const cell::CameraEntry& camera, const std::string& world) {
  sensors::Ros2Place place{
      .world = world, .frame = camera.frame, .max_age_s = camera.frame_age_s, .image_frame = camera.image_frame};
  place.max_speed_m_s = camera.frame_speed_m_s.value_or(place.max_speed_m_s);
  place.max_turn_rad_s = camera.frame_turn_rad_s.value_or(place.max_turn_rad_s);
  return place;
}

/// Of a recorded cell, a camera that gave no image: blind, as it was.
class SilentCamera final : public sensors::DepthSource {
 public:
  void open() override {}
  void close() noexcept override {}
  [[nodiscard]] const sensors::SourceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] std::string_view reason() const noexcept override { return {}; }
  [[nodiscard]] sensors::Reading next(sensors::DepthReading& /*reading*/, double /*longest_s*/) noexcept override {
    return sensors::Reading::ended;
  }

 private:
  sensors::SourceInfo info_{.name = "no image in the recording", .serial = {}, .clock = {}};
};

/// One for everything that is recorded; null where nothing is.
std::shared_ptr<const sensors::Playback> playback_of(const cell::Cell& cell, const cell::CellSetup& setup) {
  double first_s = std::numeric_limits<double>::infinity();
  double last_s = -std::numeric_limits<double>::infinity();
  bool repeats = false;
  bool is_first = true;
  const auto repeat_all = [&](bool repeat, const std::string& place) {
    if (!is_first && repeat != repeats) {
      fail(place, ": repeat: all recordings of a cell begin anew together, or none of them");
    }
    repeats = repeat;
    is_first = false;
    if (repeats && cell.memory) {
      fail(place, ": repeat: what was seen free at the end would be remembered at the beginning; memory: none");
    }
  };
  for (std::size_t k = 0; k < cell.cameras.size(); ++k) {
    const cell::CameraEntry& camera = cell.cameras[k];
    if (!camera.recording.empty() && !camera.is_silent) {
      const sensors::RecordedSpan span = span_of(camera, setup.rig.cameras[k], cell);
      first_s = std::min(first_s, span.first_s);
      last_s = std::max(last_s, span.last_s);
      repeat_all(camera.repeat, camera.place);
    }
  }
  if (cell.robot && cell.robot->joints.source == SourceKind::recording) {
    repeat_all(cell.robot->joints.repeat, cell.robot->place + ": joints");
  }
  return first_s <= last_s ? std::make_shared<const sensors::Playback>(first_s, last_s, repeats) : nullptr;
}

std::unique_ptr<sensors::JointSource> joints_of(const cell::Cell& cell, const cell::CellSetup& setup,
                                                const std::shared_ptr<const sensors::SimulatedCell>& simulated,
                                                const std::shared_ptr<const sensors::Playback>& playback,
                                                const std::shared_ptr<dds::Node>& ros2) {
  const cell::JointsEntry& joints = cell.robot->joints;
  std::vector<std::string> names;
  for (const robot::Joint& joint : setup.robot->model.joints()) {
    names.push_back(joint.name);
  }
  switch (joints.source) {
    case SourceKind::simulated:
      return std::make_unique<sensors::SimulatedJoints>(simulated, joints.rate_hz);
    case SourceKind::recording:
      if (playback == nullptr) {
        fail(cell.robot->place, ": joints: a recording of joints is played beside a camera's, and no camera has one");
      }
      return std::make_unique<sensors::RecordedJoints>(joints.file, names, playback, joints.topic);
    case SourceKind::ros2:
      return std::make_unique<sensors::Ros2Joints>(ros2, joints.topic, names);
    default:
      fail(cell.robot->place, ": joints: source: ", to_string(joints.source),
           " is not part of this build: recording, simulated, ros2");
  }
}

}  // namespace

std::shared_ptr<dds::Node> ros2_node(const cell::Cell& cell) {
  const bool has_camera = std::any_of(cell.cameras.begin(), cell.cameras.end(),
                                      [](const auto& camera) { return camera.source == SourceKind::ros2; });
  const bool has_joints = cell.robot && cell.robot->joints.source == SourceKind::ros2;
  if (!has_camera && !has_joints && !cell.outputs.ros2) {
    return nullptr;
  }
  try {
    dds::NodeSettings settings;
    settings.name = cell.ros2.node;
    settings.name_space = cell.ros2.name_space;
    settings.domain = cell.ros2.domain;
    return std::make_shared<dds::Node>(settings);
  } catch (const Error& error) {
    fail(cell.file.string(), ": ros2: ", error.what());
  }
}

Sources make_sources(const cell::Cell& cell, const cell::CellSetup& setup, const std::shared_ptr<dds::Node>& ros2) {
  const auto playback = playback_of(cell, setup);
  const bool simulated_joints = cell.robot && cell.robot->joints.source == SourceKind::simulated;
  const bool is_simulated =
      simulated_joints || std::any_of(cell.cameras.begin(), cell.cameras.end(),
                                      [](const auto& camera) { return camera.source == SourceKind::simulated; });
  sensors::SimulatedCellSettings scene;
  scene.robot = setup.robot;
  const auto simulated = is_simulated ? std::make_shared<const sensors::SimulatedCell>(scene) : nullptr;
  Sources sources;
  for (std::size_t k = 0; k < cell.cameras.size(); ++k) {
    const cell::CameraEntry& camera = cell.cameras[k];
    switch (camera.source) {
      case SourceKind::simulated:
        sources.cameras.push_back(
            std::make_unique<sensors::SimulatedCamera>(simulated, setup.rig.cameras[k], camera.rate_hz, k));
        break;
      case SourceKind::recording:
        if (camera.is_silent) {
          sources.cameras.push_back(std::make_unique<SilentCamera>());
          break;
        }
        sources.cameras.push_back(
            std::make_unique<sensors::RecordedCamera>(camera.recording, cell::recording_options(camera), playback));
        break;
      case SourceKind::ros2:
        sources.cameras.push_back(
            std::make_unique<sensors::Ros2Camera>(ros2, camera.device, place_of(camera, cell.ros2.frame)));
        break;
      default:
        sources.cameras.push_back(device_camera(camera, setup.rig.cameras[k], playback));
        break;
    }
  }
  if (cell.robot) {
    sources.joints = joints_of(cell, setup, simulated, playback, ros2);
  }
  return sources;
}

MonitorSettings monitor_settings(const cell::Cell& cell) {
  MonitorSettings settings;
  settings.rate_hz = cell.ask.rate_hz;
  settings.stop_m = cell.ask.stop_m;
  settings.hold_s = cell.ask.hold_s;
  settings.max_joints_age_s = cell.ages.joints_s;
  for (const cell::CameraEntry& camera : cell.cameras) {
    settings.equal_images.push_back(camera.equal_images);
  }
  return settings;
}

depthgrid_answer datagram_answer(const CellAnswer& answer) noexcept {
  using network::rounded_down;
  using network::rounded_up;
  depthgrid_answer result{};
  result.sequence = answer.sequence;
  result.time_s = answer.time_s;
  result.exposure_s = answer.exposure_s;
  result.state = static_cast<std::uint8_t>(answer.reason.limit);
  result.stop = answer.stop ? 1 : 0;
  result.cameras = static_cast<std::uint8_t>(answer.camera_count);
  result.parts = static_cast<std::uint8_t>(std::min<std::size_t>(answer.parts.size(), DEPTHGRID_MAX_PARTS));
  result.distance_m = rounded_down(answer.distance_m);
  result.clear_m = rounded_down(answer.clear_m);
  result.blind_m = rounded_up(answer.blind_m);
  result.skew_s = rounded_up(answer.skew_s);
  result.joints_age_s = rounded_up(answer.joints_age_s);
  result.latency_s = rounded_up(answer.done_s - answer.exposure_s);
  for (std::size_t k = 0; k < answer.camera_count; ++k) {
    result.image_age_s[k] = rounded_up(answer.cameras[k].age_s);
    result.without_reading[k] = rounded_up(answer.cameras[k].without_reading);
    result.late_cameras |= answer.cameras[k].late ? 1U << k : 0U;
  }
  for (std::size_t i = 0; i < result.parts; ++i) {
    const Answer& part = answer.parts[i];
    result.part[i].distance_m = rounded_down(part.distance_now_m);
    for (int axis = 0; axis < 3; ++axis) {
      result.part[i].nearest_m[axis] = static_cast<float>(part.nearest.nearest_world[axis]);
    }
    result.part[i].state = static_cast<std::uint8_t>(part.nearest.state);
  }
  return result;
}

namespace {

class UdpOutput final : public Output {
 public:
  explicit UdpOutput(const cell::UdpEntry& to) : sender_(to.host, to.port) {}
  void take(const CellAnswer& answer) override {
    if (!sender_.send(network::write_datagram(datagram_answer(answer)))) {
      fail("a datagram was not sent");
    }
  }

 private:
  network::UdpSender sender_;
};

/// The text of the robot's file; empty for one that is built in, and without a robot.
std::string robot_description(const cell::Cell& cell) {
  constexpr std::uint64_t kLargestUrdf = std::uint64_t{16} << 20U;
  return cell.robot && !cell.robot->is_built_in ? read_whole_file(cell.robot->urdf, kLargestUrdf) : std::string();
}

/// The cameras whose places the cell's file says: of the others /tf tells.
Rig standing(const cell::Cell& cell, const cell::CellSetup& setup) {
  Rig rig = setup.rig;
  rig.cameras.clear();
  for (std::size_t k = 0; k < setup.rig.cameras.size(); ++k) {
    if (cell.cameras.at(k).frame.empty()) {
      rig.cameras.push_back(setup.rig.cameras[k]);
    }
  }
  return rig;
}

std::filesystem::path with_time(const std::filesystem::path& file) {
  constexpr std::string_view kPlace = "{time}";
  std::string name = file.string();
  const std::size_t at = name.find(kPlace);
  if (at != std::string::npos) {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    std::array<char, 32> text{};
    (void)::gmtime_r(&now, &utc);
    name.replace(at, kPlace.size(), text.data(), std::strftime(text.data(), text.size(), "%Y%m%dT%H%M%SZ", &utc));
  }
  return name;
}

}  // namespace

std::unique_ptr<Output> ros2_output(const cell::Cell& cell, const cell::CellSetup& setup, const Names& names,
                                    std::shared_ptr<dds::Node> ros2) {
  const Ros2OutputSettings settings{.names = names,
                                    .rig = standing(cell, setup),
                                    .frame = cell.ros2.frame,
                                    .robot_description = robot_description(cell)};
  return ros2_output(std::move(ros2), settings);
}

std::unique_ptr<Recorder> recorder(const cell::Cell& cell, const cell::CellSetup& setup, const Names& names) {
  RecorderSettings settings;
  settings.file = with_time(cell.outputs.record);
  settings.names = names;
  settings.rig = setup.rig;
  settings.standing = standing(cell, setup);
  if (setup.robot) {
    for (const robot::Joint& joint : setup.robot->model.joints()) {
      settings.joints.push_back(joint.name);
    }
  }
  settings.frame = cell.ros2.frame;
  settings.robot_description = robot_description(cell);
  std::error_code ignored;
  settings.cell_file = std::filesystem::absolute(cell.file, ignored);
  settings.cell_text = cell.text;
  return std::make_unique<Recorder>(settings);
}

std::unique_ptr<Output> udp_output(const cell::UdpEntry& to) { return std::make_unique<UdpOutput>(to); }

static_assert(static_cast<int>(avoidance::MotionLimit::clock) == DEPTHGRID_CLOCK);
static_assert(static_cast<int>(avoidance::MotionLimit::blind_layer) == DEPTHGRID_BLIND_LAYER);
static_assert(static_cast<int>(ProximityState::beyond_rho) == DEPTHGRID_BEYOND_RHO);
static_assert(static_cast<int>(ProximityState::outside) == DEPTHGRID_OUTSIDE);

}  // namespace depthgrid::monitor
