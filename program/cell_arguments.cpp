#include "program/cell_arguments.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <variant>

#include "depthgrid/cell/cell_file.hpp"
#include "depthgrid/core/number_parsing.hpp"
#include "depthgrid/files/recording.hpp"
#include "program/usage_error.hpp"
#include "program/warning.hpp"

namespace depthgrid::program {
namespace {

std::string numbers_text(std::initializer_list<double> values) {
  std::string text;
  for (const double value : values) {
    text += (text.empty() ? "" : ",") + number_text(value);
  }
  return text;
}

/// Sets options that the command line leaves open, and tells of the others.
class Taker {
 public:
  Taker(const CLI::App& command, std::string file) : command_(command), file_(std::move(file)) {}

  /// Whether the cell's value is to be taken.
  [[nodiscard]] bool takes(const char* option, const char* key) const {
    if (command_.count(option) == 0) {
      return true;
    }
    warn(std::string(option) + " in place of " + key + " of " + file_);
    return false;
  }
  template <class Target, class Value>
  void take(const char* option, const char* key, const Value& value, Target& target) const {
    if (takes(option, key)) {
      target = value;
    }
  }
  template <class Target, class Value>
  void take_if(const char* option, const char* key, const std::optional<Value>& value, Target& target) const {
    if (value) {
      take(option, key, *value, target);
    }
  }

 private:
  const CLI::App& command_;
  std::string file_;
};

std::string word_of(views::Policy policy) { return policy == views::Policy::ignored ? "ignored" : "obstacle"; }

bool same_errors(const cell::CameraEntry& a, const cell::CameraEntry& b) {
  const cell::MarginEntry& m = a.margins;
  const cell::MarginEntry& n = b.margins;
  return a.sensor == b.sensor && m.constant_m == n.constant_m && m.linear == n.linear &&
         m.quadratic_per_m == n.quadratic_per_m && m.lateral_px == n.lateral_px && m.translation_m == n.translation_m &&
         m.rotation_rad == n.rotation_rad && m.half_exposure_s == n.half_exposure_s &&
         m.time_uncertainty_s == n.time_uncertainty_s && a.smallest_obstacle_m == b.smallest_obstacle_m;
}

/// One statement for all cameras, as options are.
const cell::CameraEntry& errors_of(const cell::Cell& cell) {
  const cell::CameraEntry& first = cell.cameras.front();
  for (const cell::CameraEntry& camera : cell.cameras) {
    if (!same_errors(camera, first)) {
      fail_usage(camera.place, ": sensor, margins and smallest_obstacle_m differ from those of camera '", first.name,
                 "': distances takes the same for all; state them in the rig file");
    }
    if (camera.margins.second_view_x_m) {
      fail_usage(camera.place, ": margins: second_view_x_m: distances takes it from the rig file");
    }
  }
  return first;
}

void take_errors(const Taker& taker, const cell::CameraEntry& camera, DistancesOptions& options) {
  SensorOptions& sensor = options.sensor;
  if (!camera.sensor.empty()) {
    taker.take("--sensor", "sensor", camera.sensor, sensor.sensor);
  }
  const cell::MarginEntry& margins = camera.margins;
  taker.take_if("--margin-constant", "constant_m", margins.constant_m, sensor.margin_constant_m);
  taker.take_if("--margin-linear", "linear", margins.linear, sensor.margin_linear);
  taker.take_if("--margin-quadratic", "quadratic_per_m", margins.quadratic_per_m, sensor.margin_quadratic_per_m);
  taker.take_if("--margin-lateral", "lateral_px", margins.lateral_px, sensor.margin_lateral_px);
  taker.take_if("--margin-translation", "translation_m", margins.translation_m, sensor.margin_translation_m);
  taker.take_if("--margin-rotation", "rotation_deg", margins.rotation_rad, sensor.margin_rotation_rad);
  taker.take_if("--half-exposure", "half_exposure_s", margins.half_exposure_s, sensor.half_exposure_s);
  taker.take_if("--time-uncertainty", "time_uncertainty_s", margins.time_uncertainty_s, sensor.time_uncertainty_s);
  taker.take("--smallest-obstacle", "smallest_obstacle_m", camera.smallest_obstacle_m,
             options.search.smallest_obstacle_m);
}

void take_search(const Taker& taker, const cell::Cell& cell, DistancesOptions& options) {
  SearchOptions& search = options.search;
  taker.take("--unobserved", "policies", word_of(cell.policies.unobserved), search.unobserved);
  taker.take("--outside", "policies", word_of(cell.policies.outside), options.evaluation.outside);
  taker.take("--robot-pockets", "policies", word_of(cell.policies.robot_pockets), search.robot_pockets);
  if (cell.policies.robot_pockets == views::Policy::ignored) {
    taker.take("--ignored-pocket", "policies", cell.policies.ignored_pocket_m, search.ignored_pocket_m);
  }
  taker.take("--v-max", "v_max_m_s", cell.v_max_m_s, search.v_max_m_s);
  taker.take("--rho", "ask: rho_m", cell.ask.rho_m, options.evaluation.rho_m);
  taker.take("--resolution", "ask: resolution_m", cell.ask.resolution_m, search.resolution_m);
  const Eigen::Vector3d& low = cell.space.low_world;
  const Eigen::Vector3d& high = cell.space.high_world;
  taker.take("--box", "space", numbers_text({low.x(), low.y(), low.z(), high.x(), high.y(), high.z()}), search.box);
  if (cell.memory) {
    const bool empty = std::holds_alternative<memory::StartEmpty>(cell.memory->start);
    taker.take("--memory", "memory", std::string(empty ? "empty" : "unknown"), search.memory);
    taker.take("--memory-voxel", "memory", cell.memory->voxel_m, search.memory_voxel_m);
    if (cell.memory->thinnest_hidden_m != memory::MemorySettings{}.thinnest_hidden_m) {
      fail_usage(cell.file.string(), ": memory: thinnest_hidden_m: no option of distances says it");
    }
  }
}

void take_robot(const Taker& taker, const cell::Cell& cell, RecordedRobotOptions& options) {
  const cell::RobotEntry& robot = *cell.robot;
  if (robot.joints.source != cell::SourceKind::recording) {
    fail_usage(robot.place, ": joints: distances takes those of a recording: {source: recording, file: joints.csv}");
  }
  if (robot.is_built_in) {
    fail_usage(robot.place, ": urdf: ", robot.urdf, " is built in for running cells; distances takes a file");
  }
  if (robot.margin_in_test) {
    fail_usage(robot.place, ": margin_in_test: distances has no such option");
  }
  if (robot.joint_acceleration) {
    warn(robot.place + ": joint_acceleration_deg_s2 is not used here: joints may move at full speed");
  }
  taker.take("--urdf", "urdf", robot.urdf, options.robot.file);
  taker.take("--joints", "joints", robot.joints.file.string(), options.joints_file);
  taker.take("--joint-time-error", "joints: time_error_s", robot.joints.time_error_s, options.joint_time_error_s);
  const Eigen::Vector3d t = robot.T_world_base.translation();
  const Eigen::Quaterniond q(robot.T_world_base.linear());
  const bool is_turned = !robot.T_world_base.linear().isIdentity(0);
  taker.take(
      "--base", "base",
      is_turned ? numbers_text({t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) : numbers_text({t.x(), t.y(), t.z()}),
      options.base);
  if (!options.least_padding) {
    taker.take("--robot-padding", "padding_m", robot.padding_m, options.padding_m);
  }
}

void take_points(const Taker& taker, const cell::Cell& cell, DistancesOptions& options) {
  if (!cell.ask.links.empty()) {
    fail_usage(cell.file.string(), ": ask: links: distances asks all that move: links: moving");
  }
  if (cell.ask.points.empty() || !taker.takes("--point", "ask: points") || !taker.takes("--points", "ask: points")) {
    return;
  }
  if (cell.ask.moving_links) {
    warn(cell.file.string() + ": ask: distances asks links or points; here the links (--point asks points)");
    return;
  }
  for (const cell::PointEntry& point : cell.ask.points) {
    const Eigen::Vector3d& at = point.at_world_m;
    options.points.texts.push_back(point.name + "=" + numbers_text({at.x(), at.y(), at.z(), point.radius_m}));
  }
}

}  // namespace

bool is_cell_file(const std::string& path) {
  const std::filesystem::path extension = std::filesystem::path(path).extension();
  return extension == ".yaml" || extension == ".yml";
}

CellRecordingChoice recording_of(const cell::Cell& cell) {
  CellRecordingChoice choice;
  choice.recording = cell.cameras.front().recording.string();
  for (const cell::CameraEntry& camera : cell.cameras) {
    if (camera.source != cell::SourceKind::recording) {
      fail_usage(camera.place, ": source: ", to_string(camera.source),
                 ": this command takes recordings; depthgrid run takes the others, and --record makes one");
    }
    if (camera.recording.string() != choice.recording) {
      fail_usage(camera.place, ": recording: ", camera.recording.string(), " is another than ", choice.recording,
                 "; this command takes one");
    }
    if (camera.intrinsics || camera.T_world_camera || !camera.rig_file.empty() || !camera.info_topic.empty()) {
      fail_usage(camera.place,
                 ": rig, intrinsics, pose, camera_info: here those of the recording count; leave them out",
                 ", or give --rig");
    }
    choice.cameras.push_back(camera.recorded_as);
    if (!camera.device.empty()) {
      choice.topics.push_back(camera.recorded_as + "=" + camera.device);
    }
  }
  return choice;
}

void take_cell_file(const CLI::App& command, DistancesOptions& options) {
  if (!is_cell_file(options.recording)) {
    return;
  }
  const cell::Cell cell = cell::load_cell(options.recording);
  const Taker taker(command, options.recording);
  if (command.count("--method") > 0 && options.evaluation.method != "search") {
    fail_usage("--method ", options.evaluation.method, ": a cell file describes the search: leave it out");
  }
  options.evaluation.method = "search";
  const CellRecordingChoice choice = recording_of(cell);
  options.recording = choice.recording;
  taker.take("--cameras", "cameras", choice.cameras, options.cameras);
  if (!choice.topics.empty()) {
    taker.take("--depth-topics", "topic", choice.topics, options.mcap.depth_topics);
  }
  take_errors(taker, errors_of(cell), options);
  take_search(taker, cell, options);
  if (cell.robot) {
    take_robot(taker, cell, options.robot);
  }
  take_points(taker, cell, options);
}

}  // namespace depthgrid::program
