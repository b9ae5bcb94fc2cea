#include "depthgrid/files/rig_file.hpp"

#include <rapidjson/document.h>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/plausibility.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/files/depth_file_pattern.hpp"
#include "depthgrid/files/foreign_recording.hpp"
#include "depthgrid/files/json_check.hpp"
#include "depthgrid/files/rig_margins.hpp"
#include "depthgrid/files/text_file.hpp"

namespace depthgrid::files {
namespace {

using rapidjson::Value;

constexpr std::uint64_t kLargestRigText = std::uint64_t{16} << 20U;  // some ten times that as a document in memory

/// Runs a check of the library and puts the place in front of its message.
template <class Check>
auto at_place(const std::string& name, const std::string& place, const Check& check) {
  try {
    return check();
  } catch (const Error& error) {
    fail(name, ": ", place, ": ", error.what());
  }
}

const Value* find(const Value& object, const char* key) {
  const auto member = object.FindMember(key);
  return member != object.MemberEnd() ? &member->value : nullptr;
}

std::string name_text(const Value& string) { return {string.GetString(), string.GetStringLength()}; }

/// Names go into messages, tables and file names: one line, no NUL.
std::string name_of(const Value& string) {
  std::string text = name_text(string);
  if (!is_printable(text)) {
    fail("\"", printable(text), "\" holds a control character, names must not");
  }
  return text;
}

Pose pose_of(const Value& rows) {
  Eigen::Matrix4d matrix;
  for (rapidjson::SizeType row = 0; row < 4; ++row) {
    for (rapidjson::SizeType column = 0; column < 4; ++column) {
      matrix(row, column) = rows[row][column].GetDouble();
    }
  }
  Pose pose = pose_from_matrix(matrix, "matrix");
  check_plausible(pose, "matrix");
  return pose;
}

Distortion distortion_of(const Value& value) {
  std::vector<double> coefficients;
  if (const Value* given = find(value, "coeffs")) {
    for (const Value& coefficient : given->GetArray()) {
      coefficients.push_back(coefficient.GetDouble());
    }
  }
  return make_distortion(distortion_model(name_text(value["model"])).value(), coefficients);  // the schema knows it
}

/// What the file says for all its cameras.
struct Defaults {
  const Value* metres_per_unit = nullptr;
  const Value* invalid_values = nullptr;
};

/// What the sensor model says holds where the file itself says nothing.
MeasurementRule rule_of(const Value& value, const Defaults& defaults, const SensorModel* sensor) {
  MeasurementRule rule = sensor != nullptr ? sensor->rule : MeasurementRule{};
  if (const Value* near_m = find(value, "near_m")) {
    rule.near_m = near_m->GetDouble();
  }
  if (const Value* far_m = find(value, "far_m")) {
    rule.far_m = far_m->IsNull() ? std::numeric_limits<double>::infinity() : far_m->GetDouble();
    rule.clamp_beyond_far = false;  // that was the model's opinion of its own limit
  }
  if (const Value* clamp = find(value, "clamp_beyond_far")) {
    rule.clamp_beyond_far = clamp->GetBool();
  }
  const Value* own = find(value, "invalid_values");
  if (const Value* invalid = own != nullptr ? own : defaults.invalid_values) {
    for (const Value& unit : invalid->GetArray()) {
      rule.invalid_units.push_back(static_cast<std::uint16_t>(unit.GetUint()));
    }
  }
  validate(rule, "depth range");
  return rule;
}

RigCamera camera_of(const Value& value, const Defaults& defaults, const std::string& name, const std::string& place) {
  RigCamera camera;
  camera.id = at_place(name, place + "/id", [&] { return name_of(value["id"]); });
  camera.intrinsics = from_opencv(value["width"].GetInt(), value["height"].GetInt(), value["fx"].GetDouble(),
                                  value["fy"].GetDouble(), value["cx"].GetDouble(), value["cy"].GetDouble());
  if (const Value* distortion = find(value, "distortion")) {
    camera.distortion = at_place(name, place + "/distortion", [&] { return distortion_of(*distortion); });
  }
  at_place(name, place, [&] { check_plausible(camera.intrinsics, camera.distortion, "intrinsics"); });
  const Value* own_scale = find(value, "metres_per_unit");
  const Value* scale = own_scale != nullptr ? own_scale : defaults.metres_per_unit;
  if (scale == nullptr) {
    fail(name, ": ", place, ": metres_per_unit is given neither here nor in /depth, depth values need a scale");
  }
  camera.metres_per_unit = scale->GetDouble();
  const SensorModel* sensor = at_place(name, place + "/sensor", [&] { return sensor_of(value); });
  camera.sensor = sensor != nullptr ? sensor->name : std::string_view();
  camera.margins = at_place(name, place + "/margins", [&] { return margins_of(value, sensor, camera); });
  camera.rule = at_place(name, place, [&] { return rule_of(value, defaults, sensor); });
  at_place(name, place, [&] { check_plausible(camera.rule); });
  if (const Value* pose = find(value, "T_world_cam")) {
    camera.T_world_camera = at_place(name, place + "/T_world_cam", [&] { return pose_of(*pose); });
  }
  return camera;
}

/// A path of the camera's entry, empty where there is none.
std::string path_under(const Value& camera, const char* key, const std::string& name, const std::string& place) {
  const Value* given = find(camera, key);
  return given == nullptr ? std::string() : at_place(name, place + "/" + key, [&] {
    std::string path = name_of(*given);
    check_stays_inside(path);
    return path;
  });
}

/// What moves has no pose of its own, and what stands still has one.
CameraTrack track_of(const Value& camera, const std::string& name, const std::string& place) {
  CameraTrack track;
  track.depth_list = path_under(camera, "depth_list", name, place);
  track.trajectory = path_under(camera, "trajectory", name, place);
  track.pose_files = path_under(camera, "pose_files", name, place);
  const bool has_pose = find(camera, "T_world_cam") != nullptr;
  if (!track.depth_list.empty() && find(camera, "depth_files") != nullptr) {
    fail(name, ": ", place, ": has depth_files and depth_list, must have one of them");
  }
  if (!track.trajectory.empty() && !track.pose_files.empty()) {
    fail(name, ": ", place, ": has trajectory and pose_files, must have one of them");
  }
  if (track.moves() && has_pose) {
    fail(name, ": ", place, ": has T_world_cam, where it stands, and ",
         track.trajectory.empty() ? "pose_files" : "trajectory",
         ", where it moves; must have one of them (a camera on a moving body: T_body_cam)");
  }
  if (!track.moves() && !has_pose) {
    fail(name, ": ", place,
         ": key \"T_world_cam\" is missing; a camera that moves has \"trajectory\" or \"pose_files\" in "
         "its place");
  }
  if (const Value* body = find(camera, "T_body_cam")) {
    if (!track.moves()) {
      fail(name, ": ", place, ": has T_body_cam, which is for cameras that move, with trajectory or pose_files");
    }
    track.T_body_camera = at_place(name, place + "/T_body_cam", [&] { return pose_of(*body); });
  }
  if (!track.pose_files.empty()) {
    const std::string conversion =
        at_place(name, place + "/pose_files", [&] { return checked_conversion(track.pose_files); });
    if (conversion.empty() || conversion == kTimeConversion) {
      fail(name, ": ", place, "/pose_files: '", track.pose_files, "' has no %d or %0Nd for the number of the frame");
    }
  }
  return track;
}

/// Only where some camera has one.
bool says_more(const CameraTrack& track) { return track.moves() || !track.depth_list.empty(); }

/// A trajectory says where the camera was at a time, so the images must say theirs.
void check_times(const CameraTrack& track, const std::string& depth_files, const std::string& name,
                 const std::string& place) {
  const bool may_have_times =
      !track.depth_list.empty() || names_folder(depth_files) || checked_conversion(depth_files) == kTimeConversion;
  if (!track.trajectory.empty() && !may_have_times) {
    fail(name, ": ", place,
         ": has a trajectory, and its images have numbers, not times; give a depth_list (time_s file)");
  }
}

/// The camera's image names, checked against the number of frames and the conversion that /frames announces.
std::string depth_files_of(const Value& camera, int frame_count, const std::string& announced) {
  const Value* given = find(camera, "depth_files");
  if (given == nullptr) {
    return {};
  }
  std::string pattern = name_of(*given);
  const std::string conversion = checked_conversion(pattern);
  if (conversion.empty() && frame_count > 1 && !names_folder(pattern)) {
    fail("'", pattern, "' has no %d or %0Nd, but /frames/count is ", frame_count);
  }
  if (!conversion.empty() && !announced.empty() && conversion != announced) {
    fail("'", pattern, "' has ", conversion, ", but /frames/pattern is '", announced, "'");
  }
  return pattern;
}

/// Fills the numbering of the frames; returns the announced conversion, empty where there is none.
std::string read_frames(const Value& frames, RigFile& file, const std::string& name) {
  if (const Value* first = find(frames, "first")) {
    file.first_frame = first->GetInt();
  }
  if (const Value* count = find(frames, "count")) {
    file.frame_count = count->GetInt();
    file.count_stated = true;
  }
  if (const Value* simultaneous = find(frames, "simultaneous")) {
    file.simultaneous = simultaneous->GetBool();
  }
  if (const Value* rate = find(frames, "rate_hz"); rate != nullptr && rate->IsNumber()) {
    file.rate_hz = rate->GetDouble();
  }
  if (const Value* tolerance = find(frames, "tolerance_s")) {
    file.tolerance_s = tolerance->GetDouble();
  }
  if (const Value* gap = find(frames, "pose_gap_s")) {
    file.pose_gap_s = gap->GetDouble();
  }
  if (const Value* clock = find(frames, "shared_clock")) {
    file.shared_clock = clock->GetBool();
  }
  const Value* pattern = find(frames, "pattern");
  if (pattern == nullptr) {
    return {};
  }
  std::string announced = name_text(*pattern);
  if (announced == kTimeConversion ||
      at_place(name, "/frames/pattern", [&] { return checked_conversion(announced); }) != announced) {
    fail(name, ": /frames/pattern: '", announced, "' is not a conversion %d or %0Nd and nothing else");
  }
  return announced;
}

void read_cameras(const Value& cameras, const Defaults& defaults, const std::string& announced, const std::string& name,
                  RigFile& file) {
  std::map<std::string, std::string> place_of_id;
  for (rapidjson::SizeType k = 0; k < cameras.Size(); ++k) {
    const std::string place = "/cameras/" + std::to_string(k);
    file.rig.cameras.push_back(camera_of(cameras[k], defaults, name, place));
    const std::string& id = file.rig.cameras.back().id;
    if (const auto [other, is_new] = place_of_id.emplace(id, place); !is_new) {
      fail(name, ": ", place, "/id: '", id, "' is also the id of ", other->second, ", ids must be distinct");
    }
    file.depth_files.push_back(at_place(name, place + "/depth_files",
                                        [&] { return depth_files_of(cameras[k], file.frame_count, announced); }));
    file.tracks.push_back(track_of(cameras[k], name, place));
    check_times(file.tracks.back(), file.depth_files.back(), name, place);
  }
  if (std::none_of(file.tracks.begin(), file.tracks.end(), says_more)) {
    file.tracks.clear();
  }
}

const rapidjson::Document& schema() {
  static const rapidjson::Document kSchema = parse_json(rig_schema(), "rig schema");
  return kSchema;
}

}  // namespace

RigFile parse_rig(std::string_view text, const std::string& name) {
  const rapidjson::Document document = parse_json(text, name);
  check_schema(document, schema(), name);
  RigFile file;
  if (const Value* rig_name = find(document, "name")) {
    file.rig.name = at_place(name, "/name", [&] { return name_of(*rig_name); });
  }
  if (const Value* floor = find(document, "T_floor_world")) {
    file.rig.T_floor_world = at_place(name, "/T_floor_world", [&] { return pose_of(*floor); });
  }
  Defaults defaults;
  if (const Value* depth = find(document, "depth")) {
    defaults = {find(*depth, "metres_per_unit"), find(*depth, "invalid_values")};
  }
  const Value* frames = find(document, "frames");
  const std::string announced = frames != nullptr ? read_frames(*frames, file, name) : std::string();
  read_cameras(document["cameras"], defaults, announced, name, file);
  at_place(name, "/cameras", [&] { validate(file.rig); });
  std::vector<Pose> poses;
  for (const RigCamera& camera : file.rig.cameras) {
    poses.push_back(camera.T_world_camera);
  }
  at_place(name, "/cameras", [&] { check_plausible_distances(poses); });
  return file;
}

RigFile load_rig(const std::filesystem::path& file) {
  refuse_foreign_recording(file);
  return parse_rig(read_text_file(file, kLargestRigText), file.string());
}

}  // namespace depthgrid::files
