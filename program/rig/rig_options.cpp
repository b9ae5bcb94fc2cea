#include "program/rig/rig_options.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>

#include "depthgrid/core/number_parsing.hpp"
#include "depthgrid/core/plausibility.hpp"
#include "depthgrid/core/sensor_models.hpp"
#include "program/pose_option.hpp"
#include "program/usage_error.hpp"

namespace depthgrid::program {

namespace {

/// Values for all cameras or, behind "ID=", for one.
class PerCamera {
 public:
  PerCamera(const char* option, const std::vector<std::string>& texts, const Rig& rig) : option_(option) {
    for (const std::string& text : texts) {
      const std::size_t equals = text.find('=');
      const std::string id = equals == std::string::npos ? std::string() : text.substr(0, equals);
      const bool known = id.empty() || std::any_of(rig.cameras.begin(), rig.cameras.end(),
                                                   [&id](const RigCamera& camera) { return camera.id == id; });
      if (!known) {
        fail_usage(option, " ", text, ": there is no camera '", id, "', there are ", ids(rig));
      }
      if (!seen_.insert(id).second) {
        fail_usage(option, " ", text, ": given twice for ", id.empty() ? "all cameras" : "camera '" + id + "'");
      }
      values_.emplace_back(id, equals == std::string::npos ? text : text.substr(equals + 1));
    }
  }

  /// Whether there is one for this camera alone.
  [[nodiscard]] bool names(const std::string& id) const { return seen_.contains(id); }

  /// The camera's own, else that for all.
  [[nodiscard]] std::optional<std::string> of(const std::string& id) const {
    std::optional<std::string> result;
    for (const auto& [whose, value] : values_) {
      if (whose == id || (whose.empty() && !result)) {
        result = value;
      }
    }
    return result;
  }

 private:
  static std::string ids(const Rig& rig) {
    std::string text;
    for (const RigCamera& camera : rig.cameras) {
      text += (text.empty() ? "" : ", ") + camera.id;
    }
    return text;
  }

  const char* option_;
  std::set<std::string> seen_;
  std::vector<std::pair<std::string, std::string>> values_;
};

/// x,y,z,qx,qy,qz,qw as ROS prints it, or 16 numbers, row after row.
Pose pose_of(const std::string& text) {
  if (text == "identity") {
    return Pose::Identity();
  }
  constexpr std::size_t kQuaternion = 7;
  constexpr std::size_t kMatrix = 16;
  const std::vector<double> n = numbers_of("--pose", text);
  if (n.size() == kMatrix) {
    return as_usage([&n] {
      return pose_from_matrix(Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(n.data()), "--pose");
    });
  }
  if (n.size() != kQuaternion) {
    fail_usage("--pose ", text, ": ", n.size(), " numbers, must be 7 (x,y,z,qx,qy,qz,qw), 16 (four rows) or identity");
  }
  return pose_of_quaternion("--pose", text, n);
}

double scale_of(const std::string& text) {
  const std::vector<double> numbers = numbers_of("--metres-per-unit", text);
  if (numbers.size() != 1) {
    fail_usage("--metres-per-unit ", text, ": ", numbers.size(), " numbers, must be 1; for one camera write ID=M");
  }
  as_usage([&] { check_plausible_scale(numbers.front(), "--metres-per-unit"); });
  return numbers.front();
}

/// Collects what is missing, so that one message names it all.
class Missing {
 public:
  void add(const std::string& option, const std::string& what) {
    if (std::find(options_.begin(), options_.end(), option) == options_.end()) {
      options_.push_back(option);
      text_ += (text_.empty() ? "" : "; ") + option + " " + what;
    }
  }
  void report() const {
    if (!text_.empty()) {
      fail_usage("the files do not say everything, give ", text_);
    }
  }

 private:
  std::vector<std::string> options_;
  std::string text_;
};

void set_sensor(RigCamera& camera, const std::string& name) {
  if (name == "none") {
    return;
  }
  try {
    const SensorModel& model = sensor_model(name);
    camera.sensor = model.name;
    camera.rule = model.rule;
    camera.margins = sensor_margins(model, camera.intrinsics, camera.metres_per_unit);
  } catch (const Error& error) {
    fail_usage("--sensor ", name, ": ", error.what(), ", or none");
  }
}

void set_frames(files::RigFile& file, const std::string& text) {
  if (text.empty()) {
    return;
  }
  const std::size_t colon = text.find(':');
  const auto first = parse_number<int>(std::string_view(text).substr(0, colon));
  const auto last = colon == std::string::npos ? first : parse_number<int>(std::string_view(text).substr(colon + 1));
  constexpr int kLast = 1'000'000'000;
  if (!first || !last || *first < 0 || *last < *first || *last > kLast) {
    fail_usage("--frames ", text, ": must be FIRST:LAST, whole numbers from 0");
  }
  file.first_frame = *first;
  file.frame_count = *last - *first + 1;
}

files::RigFile without_values(const std::vector<ImportedCamera>& cameras, const RigOptions& options) {
  if (!options.ids.empty() && options.ids.size() != cameras.size()) {
    fail_usage("--ids: ", options.ids.size(), " given, the files hold ", cameras.size(), " cameras");
  }
  files::RigFile file;
  file.rig.name = std::filesystem::path(options.output).stem().string();
  std::set<std::string> seen;
  for (std::size_t k = 0; k < cameras.size(); ++k) {
    RigCamera camera;
    camera.id = options.ids.empty() ? cameras[k].id : options.ids[k];
    if (!seen.insert(camera.id).second) {
      fail_usage("two cameras are called '", camera.id, "'; name all ", cameras.size(), " with --ids a,b,...");
    }
    camera.intrinsics = cameras[k].intrinsics;
    camera.distortion = cameras[k].distortion;
    file.rig.cameras.push_back(camera);
  }
  file.depth_files.resize(cameras.size());
  return file;
}

void refuse_depth_mode_without_effect(const std::vector<ImportedCamera>& cameras, const RigOptions& options) {
  const bool azure = std::any_of(cameras.begin(), cameras.end(), [](const ImportedCamera& camera) {
    return camera.format.starts_with("Azure Kinect");
  });
  if (!options.import.depth_mode.empty() && !azure) {
    fail_usage("--depth-mode has no effect: it is for an Azure Kinect's calibration, and there is none");
  }
}

/// The camera's images; a number in their names asks for --frames.
std::string depth_files_of(const std::optional<std::string>& pattern, const RigOptions& options, Missing& missing) {
  if (pattern && options.frames.empty() && pattern->find('%') != std::string::npos) {
    missing.add("--frames", "FIRST:LAST (the numbers in the names of --depth-files)");
  }
  return pattern.value_or("");
}

}  // namespace

files::RigFile make_rig(const std::vector<ImportedCamera>& cameras, const RigOptions& options) {
  refuse_depth_mode_without_effect(cameras, options);
  files::RigFile file = without_values(cameras, options);
  const PerCamera scales("--metres-per-unit", options.metres_per_unit, file.rig);
  const PerCamera sensors("--sensor", options.sensors, file.rig);
  const PerCamera poses("--pose", options.poses, file.rig);
  const PerCamera patterns("--depth-files", options.depth_files, file.rig);
  if (const auto placed = std::count_if(cameras.begin(), cameras.end(),
                                        [](const ImportedCamera& camera) { return !camera.T_previous_camera; });
      placed > 1 && poses.names("")) {
    fail_usage("--pose without a camera, but ", placed, " cameras stand somewhere of their own; write --pose ID=...");
  }
  Missing missing;
  for (std::size_t k = 0; k < cameras.size(); ++k) {
    RigCamera& camera = file.rig.cameras[k];
    if (const auto scale = scales.of(camera.id)) {
      camera.metres_per_unit = scale_of(*scale);
    } else {
      missing.add("--metres-per-unit", "M (metres of one unit of the 16-bit images, 0.001 for millimetres)");
    }
    const bool chained = cameras[k].T_previous_camera && k > 0;
    if (chained && poses.names(camera.id)) {
      fail_usage("--pose for camera '", camera.id, "': its chain says where it stands; give the first camera's only");
    }
    if (const auto pose = poses.of(camera.id); pose && !chained) {
      if (cameras[k].T_world_camera) {
        fail_usage("--pose for camera '", camera.id, "': its file says where it stands; take one of the two out");
      }
      camera.T_world_camera = pose_of(*pose);
      check_plausible_option("--pose " + *pose, camera.T_world_camera);
    } else if (chained) {
      camera.T_world_camera = file.rig.cameras[k - 1].T_world_camera * *cameras[k].T_previous_camera;
    } else if (cameras[k].T_world_camera) {
      camera.T_world_camera = *cameras[k].T_world_camera;
    } else {
      missing.add("--pose " + camera.id + "=x,y,z,qx,qy,qz,qw",
                  "(where the camera stands in the world; identity: the world is its frame)");
    }
    file.depth_files[k] = depth_files_of(patterns.of(camera.id), options, missing);
  }
  for (RigCamera& camera : file.rig.cameras) {
    if (const auto sensor = sensors.of(camera.id)) {
      set_sensor(camera, *sensor);
    } else {
      missing.add("--sensor", "NAME (its range and errors, docs/sensor-models.md; none: state them later)");
    }
  }
  missing.report();
  set_frames(file, options.frames);
  return file;
}

}  // namespace depthgrid::program
