#include "depthgrid/cell/cell_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "depthgrid/cell/section.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/core/sensor_models.hpp"
#include "depthgrid/core/whole_file.hpp"

namespace depthgrid::cell {
namespace {

constexpr double kLongestAge_s = 3600;
constexpr double kDegree = std::numbers::pi / 180;

constexpr std::array<std::string_view, 12> kCellKeys{
    "name",   "cameras", "robot", "space", "policies", "v_max_m_s", "smallest_obstacle_m",
    "memory", "ask",     "ages",  "ros2",  "outputs"};
constexpr std::array<std::string_view, 19> kCameraKeys{
    "camera_info", "name",    "source",          "recording",           "recorded_as", "repeat", "serial",
    "topic",       "rate_hz", "metres_per_unit", "arrival_lag_s",       "mirrored",    "rig",    "intrinsics",
    "pose",        "sensor",  "margins",         "smallest_obstacle_m", "equal_images"};
constexpr std::array<std::string_view, 6> kIntrinsicsKeys{"width_px", "height_px", "fx_px", "fy_px", "cx_px", "cy_px"};
constexpr std::array<std::string_view, 10> kPoseKeys{"position_m",      "look_at_m",     "up",        "rpy_deg",
                                                     "quaternion_xyzw", "frame",         "max_age_s", "image_frame",
                                                     "max_speed_m_s",   "max_turn_deg_s"};
/// Those that belong to the first.
constexpr std::array<std::string_view, 5> kFrameKeys{"frame", "max_age_s", "image_frame", "max_speed_m_s",
                                                     "max_turn_deg_s"};
constexpr std::array<std::string_view, 9> kMarginKeys{
    "constant_m",   "linear",          "quadratic_per_m",    "lateral_px",     "translation_m",
    "rotation_deg", "half_exposure_s", "time_uncertainty_s", "second_view_x_m"};
constexpr std::array<std::string_view, 7> kRobotKeys{
    "urdf", "base", "joints", "padding_m", "margin_in_test", "joint_acceleration_deg_s2", "tool"};
constexpr std::array<std::string_view, 6> kJointsKeys{"source", "file", "topic", "repeat", "rate_hz", "time_error_s"};
constexpr std::array<std::string_view, 2> kSpaceKeys{"low_m", "high_m"};
constexpr std::array<std::string_view, 4> kPolicyKeys{"unobserved", "outside", "robot_pockets", "ignored_pocket_m"};
constexpr std::array<std::string_view, 3> kMemoryKeys{"start", "voxel_m", "thinnest_hidden_m"};
constexpr std::array<std::string_view, 8> kAskKeys{"hold_s", "rate_hz",    "rho_m", "resolution_m",
                                                   "stop_m", "stopping_s", "links", "points"};
constexpr std::array<std::string_view, 3> kPointKeys{"name", "at_m", "radius_m"};
constexpr std::array<std::string_view, 2> kAgeKeys{"image_s", "joints_s"};
constexpr std::array<std::string_view, 7> kOutputKeys{"udp",        "jsonl",    "record", "log",
                                                      "prometheus", "terminal", "ros2"};
constexpr std::array<std::string_view, 4> kRos2Keys{"node", "namespace", "domain", "frame"};
constexpr std::array<std::string_view, 2> kUdpKeys{"host", "port"};

constexpr std::array<std::string_view, 6> kSources{"recording", "simulated", "realsense", "freenect", "openni", "ros2"};
constexpr std::array<std::string_view, 3> kJointSources{"recording", "simulated", "ros2"};
constexpr std::array<std::string_view, 2> kPolicyWords{"obstacle", "ignored"};

constexpr std::string_view kPoseHint =
    "pose: {position_m: [x, y, z], look_at_m: [x, y, z]}, or rpy_deg or quaternion_xyzw in place of look_at_m";

SourceKind kind_of(std::string_view word) {
  const auto* at = std::find(kSources.begin(), kSources.end(), word);
  return static_cast<SourceKind>(at - kSources.begin());
}

Pose rotated(const Section& section) {
  if (section.has("rpy_deg")) {
    const std::vector<double> rpy = section.numbers("rpy_deg", 3, 360, "deg", "roll, pitch, yaw as in a URDF");
    return Pose(Eigen::AngleAxisd(rpy[2] * kDegree, Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(rpy[1] * kDegree, Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(rpy[0] * kDegree, Eigen::Vector3d::UnitX()));
  }
  if (section.has("quaternion_xyzw")) {
    const std::vector<double> q = section.numbers("quaternion_xyzw", 4, 1.01, "", "x, y, z, w of unit length");
    const Eigen::Quaterniond turn(q[3], q[0], q[1], q[2]);
    if (!(std::abs(turn.norm() - 1) < kRotationTolerance)) {
      section.refuse("quaternion_xyzw", "has length ", turn.norm(), ", must be 1: x, y, z, w in this order");
    }
    return Pose(turn.normalized());
  }
  return Pose::Identity();
}

Pose pose_of(const Section& section, bool is_camera) {
  const Eigen::Vector3d position = section.vector("position_m", kPoseHint);
  int ways = 0;
  for (const std::string_view key : {"look_at_m", "rpy_deg", "quaternion_xyzw"}) {
    ways += section.has(key) ? 1 : 0;
  }
  if (ways > 1 || (is_camera && ways == 0)) {
    section.refuse("", "states ", ways, " of look_at_m, rpy_deg and quaternion_xyzw, must state ",
                   is_camera ? "one: where the camera looks" : "at most one");
  }
  if (!section.has("look_at_m")) {
    if (section.has("up")) {
      section.refuse("up", "belongs to look_at_m, remove it");
    }
    return Eigen::Translation3d(position) * rotated(section);
  }
  const Eigen::Vector3d target = section.vector("look_at_m", "a point in the world that the camera looks at");
  const Eigen::Vector3d up =
      section.has("up") ? section.vector("up", "the image's up direction in the world") : Eigen::Vector3d::UnitZ();
  try {
    return look_at(position, target, up);
  } catch (const Error& error) {
    section.refuse("look_at_m", error.what());
  }
}

PinholeCamera intrinsics_of(const Section& section) {
  constexpr double kLargest_px = 1e6;
  const Range focal{0, kLargest_px, true};
  const Range centre{-kLargest_px, kLargest_px};
  const std::string_view hint = "as OpenCV and ROS state them: the centre of the first pixel is 0";
  const int width_px = section.whole("width_px", 1, kLargestImageSide, "px", hint);
  const int height_px = section.whole("height_px", 1, kLargestImageSide, "px", hint);
  const double fx_px = section.number("fx_px", focal, "px", hint);
  const double fy_px = section.number("fy_px", focal, "px", hint);
  const double cx_px = section.number("cx_px", centre, "px", hint);
  const double cy_px = section.number("cy_px", centre, "px", hint);
  return from_opencv(width_px, height_px, fx_px, fy_px, cx_px, cy_px);
}

MarginEntry margins_of(const Section& section) {
  const Range length{0, 10};
  MarginEntry margins;
  margins.constant_m = section.number_if("constant_m", length, "m");
  margins.linear = section.number_if("linear", {0, 1}, "");
  margins.quadratic_per_m = section.number_if("quadratic_per_m", {0, 1}, "1/m");
  if (section.has("lateral_px")) {
    margins.lateral_px = section.whole("lateral_px", 0, 16, "px", "the filter's radius");
  }
  margins.translation_m = section.number_if("translation_m", length, "m");
  margins.rotation_rad = section.number_if("rotation_deg", {0, 45}, "deg");
  if (margins.rotation_rad) {
    margins.rotation_rad = *margins.rotation_rad * kDegree;
  }
  margins.half_exposure_s = section.number_if("half_exposure_s", {0, 10}, "s");
  margins.time_uncertainty_s = section.number_if("time_uncertainty_s", {0, 10}, "s");
  margins.second_view_x_m = section.number_if("second_view_x_m", {-10, 10}, "m");
  return margins;
}

/// What belongs to another source is a slip, not something to pass over.
void refuse_foreign(const Section& section, SourceKind kind, std::span<const std::string_view> foreign) {
  for (const std::string_view key : foreign) {
    if (section.has(key)) {
      section.refuse(key, "says nothing with source: ", to_string(kind), ", remove it or choose another source");
    }
  }
}

/// A camera with a driver of its own, or what was recorded with it.
void read_device(const Section& section, const std::filesystem::path& folder, CameraEntry& camera) {
  refuse_foreign(section, camera.source, std::array<std::string_view, 3>{"camera_info", "topic", "recorded_as"});
  if (camera.source != SourceKind::realsense) {
    refuse_foreign(section, camera.source, std::array<std::string_view, 1>{"rate_hz"});
  }
  if (camera.source == SourceKind::freenect) {
    refuse_foreign(section, camera.source, std::array<std::string_view, 2>{"recording", "metres_per_unit"});
  }
  camera.metres_per_unit = section.number_if("metres_per_unit", {0, 0.1, true}, "m");
  if (section.has("recording")) {
    for (const std::string_view key : {"serial", "rate_hz"}) {
      if (section.has(key)) {
        section.refuse(key, "says nothing of a recording, remove it");
      }
    }
    if (camera.source == SourceKind::openni && section.has("arrival_lag_s")) {
      section.refuse("arrival_lag_s", "says nothing of a recording whose times are of the camera's clock, remove it");
    }
    camera.arrival_lag_s = section.number_if("arrival_lag_s", {0, 1}, "s");
    camera.recording = folder / section.text("recording", "a file of its maker's software: .bag, .oni");
    camera.repeat = section.yes("repeat", false);
    if (camera.source == SourceKind::openni) {
      constexpr std::array<std::string_view, 2> kWords{"true", "false"};
      camera.mirrored = section.word("mirrored", kWords,
                                     "whether its images are mirrored, which OpenNI2 does unless it is told not to: "
                                     "true, or false; the file does not say it") == "true";
    } else if (section.has("mirrored")) {
      section.refuse("mirrored", "says nothing of this recording, remove it");
    }
    return;
  }
  for (const std::string_view key : {"repeat", "mirrored"}) {
    if (section.has(key)) {
      section.refuse(key, "says nothing of a camera that is there, remove it, or add recording:");
    }
  }
  camera.device = section.text("serial", "the serial number on the camera: it says which of several it is", "");
  if (camera.source == SourceKind::realsense) {
    camera.rate_hz = section.number("rate_hz", {0, 1000, true}, "Hz", "images a second", 30);
  }
  camera.arrival_lag_s = section.number_if("arrival_lag_s", {0, 1}, "s");
}

void read_source(const Section& section, const std::filesystem::path& folder, CameraEntry& camera) {
  camera.source = kind_of(section.word("source", kSources, "where the images come from: recording, simulated, ..."));
  switch (camera.source) {
    case SourceKind::recording:
      refuse_foreign(
          section, camera.source,
          std::array<std::string_view, 5>{"serial", "rate_hz", "arrival_lag_s", "mirrored", "metres_per_unit"});
      camera.recording = folder / section.text("recording", "the folder that holds a rig.json, or an MCAP file");
      camera.device = section.text("topic", "of the depth images in an MCAP file", "");
      camera.info_topic = section.text("camera_info", "of their calibration in an MCAP file", "");
      camera.recorded_as = section.text("recorded_as", "the camera's id in it", camera.name);
      camera.repeat = section.yes("repeat", false);
      break;
    case SourceKind::simulated:
      refuse_foreign(section, camera.source,
                     std::array<std::string_view, 9>{"camera_info", "serial", "topic", "recording", "recorded_as",
                                                     "repeat", "arrival_lag_s", "mirrored", "metres_per_unit"});
      camera.rate_hz = section.number("rate_hz", {0, 1000, true}, "Hz", "images a second", 30);
      break;
    case SourceKind::ros2:
      refuse_foreign(section, camera.source,
                     std::array<std::string_view, 9>{"camera_info", "serial", "recording", "recorded_as", "repeat",
                                                     "rate_hz", "arrival_lag_s", "mirrored", "metres_per_unit"});
      camera.device = section.text("topic", "of the depth images, for instance /left/depth/image_rect_raw");
      break;
    default:
      read_device(section, folder, camera);
  }
}

void read_pose(const Section& pose, CameraEntry& camera) {
  if (!pose.has("frame")) {
    for (const std::string_view key : kFrameKeys) {
      if (pose.has(key)) {
        pose.refuse(key, "belongs to frame, remove it");
      }
    }
    camera.T_world_camera = pose_of(pose, true);
    return;
  }
  if (camera.source != SourceKind::ros2) {
    pose.refuse("frame", "is looked up on /tf, which only source: ros2 has: position_m and look_at_m");
  }
  for (const std::string_view key : kPoseKeys) {
    if (std::find(kFrameKeys.begin(), kFrameKeys.end(), key) == kFrameKeys.end() && pose.has(key)) {
      pose.refuse(key, "says nothing beside frame, which is looked up on /tf: remove one of them");
    }
  }
  camera.frame = pose.text("frame", "the depth imager's optical frame");
  camera.frame_age_s = pose.number("max_age_s", {0, 10, true}, "s", "how old a transform of /tf may be", 0.1);
  camera.image_frame = pose.text("image_frame", "what the images say they are taken in, where it is another name", "");
  camera.frame_speed_m_s = pose.number_if("max_speed_m_s", {0, 100}, "m/s");
  camera.frame_turn_rad_s = pose.number_if("max_turn_deg_s", {0, 36000}, "deg/s");
  if (camera.frame_turn_rad_s) {
    camera.frame_turn_rad_s = *camera.frame_turn_rad_s * kDegree;
  }
}

void read_calibration(const Section& section, const std::filesystem::path& folder, CameraEntry& camera) {
  if (section.has("rig")) {
    if (camera.source == SourceKind::recording) {
      section.refuse("rig",
                     "says nothing with source: recording, which has a rig file or camera_info of its own: state "
                     "intrinsics: and pose: here, or change the recording's rig.json");
    }
    camera.rig_file = folder / section.text("rig", "");
  }
  if (section.has("intrinsics")) {
    camera.intrinsics = intrinsics_of(section.map("intrinsics", kIntrinsicsKeys, ""));
  }
  if (section.has("pose")) {
    read_pose(section.map("pose", kPoseKeys, kPoseHint), camera);
  }
  const bool in_rig = camera.source == SourceKind::recording || !camera.rig_file.empty();
  if (!in_rig && !camera.T_world_camera && camera.frame.empty()) {
    section.refuse("", "'pose' is missing: ", kPoseHint, ", or rig: with a rig file that states it");
  }
  if (!in_rig && !camera.intrinsics && camera.source == SourceKind::simulated) {
    section.refuse("", "'intrinsics' is missing: {width_px, height_px, fx_px, fy_px, cx_px, cy_px}, or rig:");
  }
}

CameraEntry camera_of(const Section& section, const std::filesystem::path& folder,
                      const std::optional<double>& smallest_obstacle_m) {
  CameraEntry camera;
  camera.place = section.place();
  camera.name = section.text("name", "what answers and messages call the camera");
  read_source(section, folder, camera);
  read_calibration(section, folder, camera);
  if (section.has("sensor")) {
    camera.sensor = section.text("sensor", "");
    try {
      (void)sensor_model(camera.sensor);
    } catch (const Error& error) {
      section.refuse("sensor", error.what());
    }
  }
  if (section.has("margins")) {
    camera.margins = margins_of(section.map("margins", kMarginKeys, ""));
  }
  const std::optional<double> own_m = section.number_if("smallest_obstacle_m", {0, 1}, "m");
  if (!own_m && !smallest_obstacle_m) {
    section.refuse("",
                   "'smallest_obstacle_m' is missing, here or for the whole cell: no obstacle is smaller than this, ",
                   "so that small holes in the image count as what surrounds them; 0 says nothing");
  }
  camera.smallest_obstacle_m = own_m ? *own_m : *smallest_obstacle_m;
  camera.equal_images = section.yes("equal_images", camera.sensor == "ideal");
  return camera;
}

JointsEntry joints_of(const Section& section, const std::filesystem::path& folder) {
  JointsEntry joints;
  joints.source = kind_of(section.word("source", kJointSources, "where joint positions come from"));
  if (joints.source == SourceKind::recording) {
    refuse_foreign(section, joints.source, std::array<std::string_view, 1>{"rate_hz"});
    joints.file = folder / section.text("file", "a table of joint positions with times, or an MCAP file");
    joints.topic = section.text("topic", "of joint states in an MCAP file", "");
    if (!joints.topic.empty() && joints.file.extension() != ".mcap") {
      section.refuse("topic", "is of an MCAP file, and the joints' file is none: remove it");
    }
    joints.repeat = section.yes("repeat", false);
  } else if (joints.source == SourceKind::ros2) {
    refuse_foreign(section, joints.source, std::array<std::string_view, 3>{"file", "repeat", "rate_hz"});
    joints.topic = section.text("topic", "of the joint states", "/joint_states");
  } else {
    refuse_foreign(section, joints.source, std::array<std::string_view, 3>{"file", "repeat", "topic"});
    joints.rate_hz = section.number("rate_hz", {0, 10000, true}, "Hz", "", 500);
  }
  joints.time_error_s = section.number(
      "time_error_s", {0, 1}, "s", "by how much an image's time may differ from the joints'; half the exposure too");
  return joints;
}

RobotEntry robot_of(const Section& section, const std::filesystem::path& folder) {
  RobotEntry robot;
  robot.place = section.place();
  robot.urdf = section.text("urdf", "the robot's file, or kuka_lwr4, which is built in");
  robot.is_built_in = robot.urdf == "kuka_lwr4";
  if (!robot.is_built_in) {
    robot.urdf = (folder / robot.urdf).string();
  }
  robot.T_world_base = pose_of(
      section.map("base", std::array<std::string_view, 3>{"position_m", "rpy_deg", "quaternion_xyzw"},
                  "where the robot's root link stands in the cameras' world: {position_m: [0, 0, 0]} in its origin"),
      false);
  robot.joints = joints_of(section.map("joints", kJointsKeys, "joints: {source: ..., time_error_s: 0.002}"), folder);
  robot.padding_m = section.number(
      "padding_m", {0, 1}, "m", "by how much the robot's capsules are thickened before it is taken out of the images");
  robot.margin_in_test = section.yes("margin_in_test", false);
  if (const auto most = section.number_if("joint_acceleration_deg_s2", {0, 1e6, true}, "deg/s^2")) {
    robot.joint_acceleration = *most * kDegree;
  }
  robot.tool = section.text("tool", "the link of the tool's tip", "");
  return robot;
}

void read_space(const Section& section, Cell& cell) {
  const std::string_view hint = "the space of interest is a box in the world: low_m and high_m, its corners";
  const Section space = section.map("space", kSpaceKeys, hint);
  cell.space = {space.vector("low_m", hint), space.vector("high_m", hint)};
  if (!((cell.space.high_world - cell.space.low_world).minCoeff() > 0)) {
    space.refuse("high_m", "must be above low_m in x, y and z: ", hint);
  }
}

views::Policy policy_of(const Section& section, std::string_view key, std::string_view hint) {
  return section.word(key, kPolicyWords, hint) == "obstacle" ? views::Policy::obstacle : views::Policy::ignored;
}

views::Policies policies_of(const Section& section) {
  views::Policies policies;
  policies.unobserved = policy_of(section, "unobserved", "space that no camera looks at: obstacle, or ignored");
  policies.outside = policy_of(section, "outside", "space outside of the box: obstacle, or ignored");
  policies.robot_pockets =
      policy_of(section, "robot_pockets", "the shadow right behind the robot: obstacle, or ignored");
  if (policies.robot_pockets == views::Policy::ignored) {
    policies.ignored_pocket_m =
        section.number("ignored_pocket_m", {0, 1, true}, "m", "how deep the shadow right behind the robot is ignored");
  } else if (section.has("ignored_pocket_m")) {
    section.refuse("ignored_pocket_m", "says nothing with robot_pockets: obstacle, remove it");
  }
  return policies;
}

std::optional<memory::MemorySettings> memory_of(const Section& section, const views::BoxSpace& space) {
  const std::string_view hint =
      "memory: none, or {start: unknown}: what was seen free stays free until something could have come there";
  if (!section.is_map("memory")) {
    constexpr std::array<std::string_view, 1> kNone{"none"};
    (void)section.word("memory", kNone, hint);
    return std::nullopt;
  }
  const Section map = section.map("memory", kMemoryKeys, hint);
  memory::MemorySettings memory;
  memory.low_world = space.low_world;
  memory.high_world = space.high_world;
  constexpr std::array<std::string_view, 2> kStarts{"unknown", "empty"};
  if (map.word("start", kStarts, "unknown, or empty: nothing was where no camera looked") == "unknown") {
    memory.start = memory::StartUnknown{};
  } else {
    memory.start = memory::StartEmpty{};
  }
  memory.voxel_m = map.number("voxel_m", {0.005, 1}, "m", "side of a voxel", memory.voxel_m);
  memory.thinnest_hidden_m = map.number("thinnest_hidden_m", {0, 1}, "m", "", memory.thinnest_hidden_m);
  return memory;
}

AskEntry ask_of(const Section& section, bool has_robot) {
  AskEntry ask;
  ask.rate_hz = section.number("rate_hz", {0, 10000, true}, "Hz", "answers a second", ask.rate_hz);
  ask.rho_m = section.number("rho_m", {0, 100, true}, "m", "how far around a part obstacles matter", ask.rho_m);
  ask.resolution_m = section.number("resolution_m", {0.0005, 1}, "m", "tightness", ask.resolution_m);
  ask.stop_m = section.number("stop_m", {0, ask.rho_m}, "m",
                              "a part that is not farther than this beyond its blind layer says stop", ask.stop_m);
  ask.hold_s = section.number("hold_s", {0, 60}, "s", "a stop lasts until all was clear for so long", ask.hold_s);
  ask.stopping_s = section.number_if("stopping_s", {0, 10}, "s");
  if (section.is_list("links")) {
    ask.links = section.texts("links", "names of links");
  } else if (section.has("links")) {
    constexpr std::array<std::string_view, 2> kWords{"moving", "none"};
    ask.moving_links = section.word("links", kWords, "moving, none, or a list of names") == "moving";
  }
  if ((ask.moving_links || !ask.links.empty()) && !has_robot) {
    section.refuse("links", "are asked for, but there is no 'robot' in the file");
  }
  if (section.has("points")) {
    for (const Section& point : section.maps("points", kPointKeys, "a list of {name, at_m, radius_m}")) {
      ask.points.push_back({point.text("name", "what answers call it"), point.vector("at_m", "in the world"),
                            point.number("radius_m", {0, 10}, "m", "of a ball", 0)});
    }
  }
  if (!ask.moving_links && ask.links.empty() && ask.points.empty()) {
    section.refuse("", "nothing is asked: links: moving, or points: [{name: hand, at_m: [0, 0, 1]}]");
  }
  return ask;
}

OutputEntry outputs_of(const Section& section, const std::filesystem::path& folder) {
  OutputEntry outputs;
  if (section.has("udp")) {
    const Section udp = section.map("udp", kUdpKeys, "{host: 127.0.0.1, port: 47000}");
    UdpEntry& to = outputs.udp.emplace();
    to.host = udp.text("host", "", "127.0.0.1");
    to.port = udp.whole("port", 1, 65535, "", "where the controller listens");
  }
  if (section.has("jsonl")) {
    outputs.jsonl = folder / section.text("jsonl", "a file, or - for standard output");
  }
  if (section.has("record")) {
    outputs.record = folder / section.text("record", "an MCAP file to be made: run-{time}.mcap");
  }
  if (section.has("log")) {
    outputs.log = folder / section.text("log", "a file that gets a line for each stop and go");
  }
  if (section.has("prometheus")) {
    outputs.prometheus = folder / section.text("prometheus", "a file that is replaced once a second: cell.prom");
  }
  outputs.terminal = section.yes("terminal", true);
  outputs.ros2 = section.yes("ros2", false);
  return outputs;
}

Ros2Entry ros2_of(const Section& section) {
  constexpr int kLastDomain = 232;
  Ros2Entry ros2;
  ros2.node = section.text("node", "a name of letters, digits and _", ros2.node);
  ros2.name_space = section.text("namespace", "/ or like /cell/left", ros2.name_space);
  if (section.has("domain")) {
    ros2.domain = section.whole("domain", 0, kLastDomain, "", "the ROS_DOMAIN_ID of the other nodes");
  }
  ros2.frame = section.text("frame", "what the world frame is called", ros2.frame);
  return ros2;
}

void refuse_equal_names(const Cell& cell) {
  std::set<std::string> names;
  for (const CameraEntry& camera : cell.cameras) {
    if (!names.insert(camera.name).second) {
      fail(camera.place, ": a camera is called '", camera.name, "' for the second time, names must differ");
    }
  }
}

}  // namespace

std::string_view to_string(SourceKind kind) noexcept { return kSources[static_cast<std::size_t>(kind)]; }

Cell parse_cell(std::string_view text, const std::filesystem::path& file) {
  const std::filesystem::path folder = file.parent_path();
  Cell cell;
  cell.file = file;
  cell.text = text;
  const Section section(text, file.string(), cell.shown, kCellKeys);
  cell.name = section.text("name", "what this cell is called");
  const std::optional<double> smallest_m = section.number_if("smallest_obstacle_m", {0, 1}, "m");
  const auto cameras = section.maps("cameras", kCameraKeys, "a list of cameras");
  if (cameras.size() > views::kMaxCameras) {
    section.refuse("cameras", "has ", cameras.size(), " cameras, must have at most ", views::kMaxCameras);
  }
  for (const Section& camera : cameras) {
    cell.cameras.push_back(camera_of(camera, folder, smallest_m));
  }
  refuse_equal_names(cell);
  if (section.has("robot")) {
    cell.robot = robot_of(section.map("robot", kRobotKeys, ""), folder);
  }
  read_space(section, cell);
  cell.policies = policies_of(section.map("policies", kPolicyKeys, "unobserved, outside, robot_pockets"));
  cell.v_max_m_s =
      section.number("v_max_m_s", {0, 100}, "m/s", "nothing in the cell moves faster; a person who walks: 1.6");
  cell.memory = memory_of(section, cell.space);
  cell.ask =
      ask_of(section.map("ask", kAskKeys, "what is asked: {links: moving} or {points: [...]}"), cell.robot.has_value());
  const Section ages = section.map_or_empty("ages", kAgeKeys);
  cell.ages.image_s = ages.number("image_s", {0, kLongestAge_s, true}, "s", "", cell.ages.image_s);
  cell.ages.joints_s = ages.number("joints_s", {0, kLongestAge_s, true}, "s", "", cell.ages.joints_s);
  cell.ros2 = ros2_of(section.map_or_empty("ros2", kRos2Keys));
  cell.outputs = outputs_of(section.map_or_empty("outputs", kOutputKeys), folder);
  return cell;
}

Cell load_cell(const std::filesystem::path& file) {
  constexpr std::uint64_t kLargestText = std::uint64_t{1} << 20U;
  return parse_cell(read_whole_file(file, kLargestText), file);
}

}  // namespace depthgrid::cell
