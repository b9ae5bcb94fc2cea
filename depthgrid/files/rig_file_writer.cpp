#include <rapidjson/document.h>
#include <rapidjson/prettywriter.h>
#include <rapidjson/stringbuffer.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "depthgrid/core/error.hpp"
#include "depthgrid/files/depth_file_pattern.hpp"
#include "depthgrid/files/rig_file.hpp"
#include "depthgrid/files/text_file.hpp"

namespace depthgrid::files {
namespace {

using JsonWriter = rapidjson::PrettyWriter<rapidjson::StringBuffer>;

constexpr const char* kConvention =
    "p_world = T_world_cam * p_cam, rows of a 4x4 matrix, metres. Camera frame: x right, y down, z forward; pixel "
    "u = fx*x/z + cx, v = fy*y/z + cy with (0, 0) the centre of the top-left pixel.";

/// NaN and infinity make a call of the writer return false; all results are collected in good().
class Output {
 public:
  Output() : json_(buffer_) {
    json_.SetIndent(' ', 2);
    json_.SetFormatOptions(rapidjson::kFormatSingleLineArray);
  }

  void begin_object() { check(json_.StartObject()); }
  void end_object() { check(json_.EndObject()); }
  void begin_array() { check(json_.StartArray()); }
  void end_array() { check(json_.EndArray()); }
  void key(const char* name) { check(json_.Key(name)); }
  void null() { check(json_.Null()); }
  void value(double number) { check(json_.Double(number)); }
  void value(int number) { check(json_.Int(number)); }
  void value(bool truth) { check(json_.Bool(truth)); }
  void value(const std::string& text) {
    check(json_.String(text.data(), static_cast<rapidjson::SizeType>(text.size())));
  }
  template <class Value>
  void member(const char* name, const Value& content) {
    key(name);
    value(content);
  }

  [[nodiscard]] bool good() const noexcept { return good_; }
  [[nodiscard]] std::string text() const { return std::string(buffer_.GetString(), buffer_.GetSize()) + "\n"; }

 private:
  void check(bool written) noexcept { good_ = good_ && written; }

  rapidjson::StringBuffer buffer_;
  JsonWriter json_;
  bool good_ = true;
};

void write_pose(Output& out, const char* name, const Pose& pose) {
  out.key(name);
  out.begin_array();
  for (int row = 0; row < 4; ++row) {
    out.begin_array();
    for (int column = 0; column < 4; ++column) {
      out.value(pose.matrix()(row, column));
    }
    out.end_array();
  }
  out.end_array();
}

void write_distortion(Output& out, const Distortion& distortion) {
  std::string model = "none";
  std::size_t count = 0;
  if (distortion.model == Distortion::Model::plumb_bob) {
    model = "brown_conrady";
    count = 5;
  } else if (distortion.model == Distortion::Model::rational) {
    model = "rational";
    count = 8;
  } else if (distortion.model == Distortion::Model::equidistant) {
    model = "equidistant";
    count = 4;
  }
  out.key("distortion");
  out.begin_object();
  out.member("model", model);
  out.key("coeffs");
  out.begin_array();
  for (std::size_t k = 0; k < count; ++k) {
    out.value(distortion.coefficients[k]);
  }
  out.end_array();
  out.end_object();
}

/// With a sensor everything is said, because what is left out would be the sensor's.
void write_rule(Output& out, const MeasurementRule& rule, bool has_sensor) {
  out.key("invalid_values");
  out.begin_array();
  for (const std::uint16_t unit : rule.invalid_units) {
    out.value(static_cast<int>(unit));
  }
  out.end_array();
  if (rule.near_m != 0 || has_sensor) {
    out.member("near_m", rule.near_m);
  }
  if (!(std::isinf(rule.far_m) && rule.far_m > 0)) {
    out.member("far_m", rule.far_m);
  } else if (has_sensor) {
    out.key("far_m");
    out.null();
  }
  if (rule.clamp_beyond_far || has_sensor) {
    out.member("clamp_beyond_far", rule.clamp_beyond_far);
  }
}

void write_margins(Output& out, const CameraMargins& margins) {
  out.key("margins");
  out.begin_object();
  out.member("noise_constant_m", margins.sensor.constant_m);
  out.member("noise_linear", margins.sensor.linear);
  out.member("noise_quadratic_per_m", margins.sensor.quadratic_per_m);
  out.member("lateral_px", margins.sensor.lateral_px);
  out.member("translation_m", margins.translation_m);
  out.member("rotation_rad", margins.rotation_rad);
  out.member("half_exposure_s", margins.half_exposure_s);
  out.member("time_uncertainty_s", margins.time_uncertainty_s);
  if (!std::isnan(margins.smallest_obstacle_m)) {
    out.member("smallest_obstacle_m", margins.smallest_obstacle_m);
  }
  if (margins.second_view_x_m != 0) {
    out.member("second_view_x_m", margins.second_view_x_m);
  }
  out.end_object();
}

void write_path(Output& out, const char* key, const std::string& path) {
  if (!path.empty()) {
    out.member(key, path);
  }
}

void write_camera(Output& out, const RigCamera& camera, const std::string& depth_files, const CameraTrack& track) {
  const Eigen::Vector2d principal_point = principal_point_opencv(camera.intrinsics);
  out.begin_object();
  out.member("id", camera.id);
  out.member("width", camera.intrinsics.width_px);
  out.member("height", camera.intrinsics.height_px);
  out.member("fx", camera.intrinsics.fx_px);
  out.member("fy", camera.intrinsics.fy_px);
  out.member("cx", principal_point.x());
  out.member("cy", principal_point.y());
  write_distortion(out, camera.distortion);
  out.member("metres_per_unit", camera.metres_per_unit);
  write_rule(out, camera.rule, !camera.sensor.empty());
  if (!camera.sensor.empty()) {
    out.member("sensor", camera.sensor);
  }
  if (camera.margins) {
    write_margins(out, *camera.margins);
  }
  if (!track.moves()) {
    write_pose(out, "T_world_cam", camera.T_world_camera);
  } else {
    write_path(out, "trajectory", track.trajectory);
    write_path(out, "pose_files", track.pose_files);
    write_pose(out, "T_body_cam", track.T_body_camera);
  }
  write_path(out, "depth_files", depth_files);
  write_path(out, "depth_list", track.depth_list);
  out.end_object();
}

void write_frames(Output& out, const RigFile& file) {
  out.key("frames");
  out.begin_object();
  out.member("first", file.first_frame);
  // Where folders and lists say how many images there are, the count would be a limit.
  const auto is_listed = [](const std::string& files) {
    return files.empty() || names_folder(files) || checked_conversion(files) == kTimeConversion;
  };
  if (file.count_stated || std::none_of(file.depth_files.begin(), file.depth_files.end(), is_listed)) {
    out.member("count", file.frame_count);
  }
  out.member("simultaneous", file.simultaneous);
  if (file.rate_hz) {
    out.member("rate_hz", *file.rate_hz);
  }
  if (file.tolerance_s) {
    out.member("tolerance_s", *file.tolerance_s);
  }
  if (file.pose_gap_s) {
    out.member("pose_gap_s", *file.pose_gap_s);
  }
  if (file.shared_clock) {
    out.member("shared_clock", *file.shared_clock);
  }
  out.end_object();
}

}  // namespace

std::string to_json(const RigFile& rig_file) {
  const Rig& rig = rig_file.rig;
  validate(rig);
  if (rig_file.depth_files.size() != rig.cameras.size()) {
    fail("rig '", rig.name, "': ", rig_file.depth_files.size(), " entries in depth_files for ", rig.cameras.size(),
         " cameras, needs one a camera (empty where there are no images)");
  }
  if (!rig_file.tracks.empty() && rig_file.tracks.size() != rig.cameras.size()) {
    fail("rig '", rig.name, "': ", rig_file.tracks.size(), " tracks for ", rig.cameras.size(),
         " cameras, needs one a camera or none");
  }
  Output out;
  out.begin_object();
  out.member("name", rig.name);
  out.member("convention", std::string(kConvention));
  write_frames(out, rig_file);
  if (rig.T_floor_world) {
    write_pose(out, "T_floor_world", *rig.T_floor_world);
  }
  out.key("cameras");
  out.begin_array();
  for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
    write_camera(out, rig.cameras[k], rig_file.depth_files[k],
                 rig_file.tracks.empty() ? CameraTrack{} : rig_file.tracks[k]);
  }
  out.end_array();
  out.end_object();
  if (!out.good()) {
    fail("rig '", rig.name, "': holds NaN or infinity, which JSON cannot hold");
  }
  std::string text = out.text();
  parse_rig(text, "rig '" + rig.name + "'");  // one place knows the file's rules: the reader
  return text;
}

void save_rig(const RigFile& rig_file, const std::filesystem::path& file) { write_text_file(file, to_json(rig_file)); }

}  // namespace depthgrid::files
