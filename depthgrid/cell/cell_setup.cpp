#include "depthgrid/cell/cell_setup.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/sensor_models.hpp"
#include "depthgrid/files/recording.hpp"
#include "depthgrid/files/rig_file.hpp"
#include "depthgrid/robot/kuka_lwr4.hpp"
#include "depthgrid/robot/robot_parts.hpp"
#include "depthgrid/robot/urdf.hpp"

namespace depthgrid::cell {
namespace {

std::string words(double value) {
  std::ostringstream text;
  text.precision(6);
  text << value;
  return text.str();
}

/// What a recording or a rig file says of the camera; without one, nothing but the id.
RigCamera stated_elsewhere(const CameraEntry& entry, std::string& origin) {
  if (entry.source == SourceKind::recording) {
    origin = entry.recording.string();
    return files::Recording(entry.recording, recording_options(entry)).rig().cameras.front();
  }
  if (!entry.rig_file.empty()) {
    origin = entry.rig_file.string();
    const Rig rig = files::load_rig(entry.rig_file).rig;
    return rig.cameras[camera_index(rig, entry.name)];
  }
  RigCamera camera;
  camera.id = entry.name;
  return camera;
}

void take(const std::optional<double>& stated, double& value) { value = stated.value_or(value); }

CameraMargins margins_of(const CameraEntry& entry, const RigCamera& camera) {
  const MarginEntry& stated = entry.margins;
  CameraMargins margins;
  if (!entry.sensor.empty()) {
    margins = sensor_margins(sensor_model(entry.sensor), camera.intrinsics, camera.metres_per_unit);
  } else if (camera.margins) {
    margins = *camera.margins;
  } else if (!stated.constant_m && !stated.linear && !stated.quadratic_per_m) {
    fail(entry.place, ": says nothing about how far the camera's readings may err: sensor: with a model's name (",
         sensor_models()[0].name, ", ", sensor_models()[1].name,
         ", ...), or margins: {constant_m, linear, quadratic_per_m}");
  }
  take(stated.constant_m, margins.sensor.constant_m);
  take(stated.linear, margins.sensor.linear);
  take(stated.quadratic_per_m, margins.sensor.quadratic_per_m);
  margins.sensor.lateral_px = stated.lateral_px.value_or(margins.sensor.lateral_px);
  take(stated.translation_m, margins.translation_m);
  take(stated.rotation_rad, margins.rotation_rad);
  take(stated.half_exposure_s, margins.half_exposure_s);
  take(stated.time_uncertainty_s, margins.time_uncertainty_s);
  take(stated.second_view_x_m, margins.second_view_x_m);
  margins.smallest_obstacle_m = entry.smallest_obstacle_m;
  return margins;
}

/// Of a camera that moves: where it may have been within the time that its images may be off by.
void add_motion(const CameraEntry& entry, const std::string& key, CameraMargins& margins,
                std::vector<ShownValue>& shown) {
  const double time_s = margins.half_exposure_s + margins.time_uncertainty_s;
  if (entry.frame.empty() || time_s == 0) {
    return;
  }
  if (!entry.frame_speed_m_s || !entry.frame_turn_rad_s) {
    fail(
        entry.place, ": its images are sure to ", time_s, " s (margins: half_exposure_s, time_uncertainty_s), and ",
        "nothing says how far the camera moves in that time: pose: {frame, max_speed_m_s, max_turn_deg_s}; 0 and 0 of ",
        "one that stands");
  }
  margins.translation_m += *entry.frame_speed_m_s * time_s;
  margins.rotation_rad += *entry.frame_turn_rad_s * time_s;
  shown.push_back({key + ".margins.translation_m with its motion", words(margins.translation_m), "m", entry.frame});
  shown.push_back({key + ".margins.rotation_rad with its motion", words(margins.rotation_rad), "rad", entry.frame});
}

void show_camera(const CameraEntry& entry, const RigCamera& camera, const std::string& key, const std::string& origin,
                 std::vector<ShownValue>& shown) {
  const PinholeCamera& image = camera.intrinsics;
  if (!entry.intrinsics) {
    shown.push_back({key + ".intrinsics",
                     std::to_string(image.width_px) + " x " + std::to_string(image.height_px) + ", fx " +
                         words(image.fx_px) + ", fy " + words(image.fy_px),
                     "px", origin});
  }
  const CameraMargins& margins = *camera.margins;
  const std::string model = entry.sensor.empty() ? origin : "model " + entry.sensor;
  const auto show = [&](const char* name, double value, const char* unit, bool in_file) {
    if (!in_file) {
      shown.push_back({key + ".margins." + name, words(value), unit, model.empty() ? "default" : model});
    }
  };
  show("constant_m", margins.sensor.constant_m, "m", entry.margins.constant_m.has_value());
  show("linear", margins.sensor.linear, "", entry.margins.linear.has_value());
  show("quadratic_per_m", margins.sensor.quadratic_per_m, "1/m", entry.margins.quadratic_per_m.has_value());
  show("lateral_px", margins.sensor.lateral_px, "px", entry.margins.lateral_px.has_value());
  show("half_exposure_s", margins.half_exposure_s, "s", entry.margins.half_exposure_s.has_value());
  show("time_uncertainty_s", margins.time_uncertainty_s, "s", entry.margins.time_uncertainty_s.has_value());
  const std::string no_calibration = entry.sensor.empty() && !origin.empty() ? origin : "default";
  const auto show_calibration = [&](const char* name, double value, const char* unit, bool in_file) {
    if (!in_file) {
      shown.push_back({key + ".margins." + name, words(value), unit, no_calibration});
    }
  };
  show_calibration("translation_m", margins.translation_m, "m", entry.margins.translation_m.has_value());
  show_calibration("rotation_rad", margins.rotation_rad, "rad", entry.margins.rotation_rad.has_value());
  shown.push_back({key + ".range", words(camera.rule.near_m) + " ... " + words(camera.rule.far_m), "m",
                   model.empty() ? "default" : model});
}

RigCamera camera_of(const CameraEntry& entry, std::size_t index, std::vector<ShownValue>& shown) {
  std::string origin;
  RigCamera camera = stated_elsewhere(entry, origin);
  camera.id = entry.name;
  camera.intrinsics = entry.intrinsics.value_or(camera.intrinsics);
  camera.metres_per_unit = entry.metres_per_unit.value_or(camera.metres_per_unit);
  camera.T_world_camera = entry.T_world_camera.value_or(camera.T_world_camera);
  if (camera.intrinsics.width_px == 0) {
    fail(entry.place,
         ": nothing says the camera's intrinsics before it is opened: intrinsics: {width_px, ...}, or rig:; depthgrid "
         "cell new writes those of the cameras that it finds");
  }
  if (!entry.sensor.empty()) {
    camera.sensor = sensor_model(entry.sensor).name;
    camera.rule = sensor_model(entry.sensor).rule;
  }
  camera.margins = margins_of(entry, camera);
  const std::string key = "cameras[" + std::to_string(index) + "]";
  show_camera(entry, camera, key, origin, shown);
  add_motion(entry, key, *camera.margins, shown);
  return camera;
}

void add_link(const robot::RobotModel& model, const robot::LinkCapsule& part, std::vector<AskedPart>& parts) {
  parts.push_back({model.links()[part.link].name, part, {}});
}

/// A link that is asked for and has no shape would be answered for by nobody.
void refuse_without_shape(const Cell& cell, const robot::RobotModel& model,
                          const std::vector<robot::LinkCapsule>& capsules) {
  for (const std::string& name : cell.ask.links) {
    const std::size_t link = model.link_index(name);
    if (std::none_of(capsules.begin(), capsules.end(), [&](const auto& part) { return part.link == link; })) {
      fail(cell.file.string(), ": ask: links: ", name, " has no shape in the robot's file, so no distance can be said ",
           "of it: leave it out, or add a <collision> to the file");
    }
  }
}

std::vector<AskedPart> parts_of(const Cell& cell, const std::optional<robot::PlacedRobot>& robot) {
  std::vector<AskedPart> parts;
  if (robot && (cell.ask.moving_links || !cell.ask.links.empty())) {
    const robot::RobotModel& model = robot->model;
    std::vector<robot::LinkCapsule> asked =
        cell.ask.moving_links ? robot::moving_capsules(model) : robot::link_capsules(model);
    if (!cell.ask.moving_links) {
      std::vector<std::size_t> links;
      for (const std::string& name : cell.ask.links) {
        links.push_back(model.link_index(name));
      }
      refuse_without_shape(cell, model, asked);
      std::erase_if(asked, [&](const robot::LinkCapsule& part) {
        return std::find(links.begin(), links.end(), part.link) == links.end();
      });
    }
    if (!cell.robot->tool.empty()) {
      asked = robot::tip_first(std::move(asked), model.link_index(cell.robot->tool));
    }
    for (const robot::LinkCapsule& part : asked) {
      add_link(model, part, parts);
    }
  }
  for (const PointEntry& point : cell.ask.points) {
    parts.push_back({point.name, std::nullopt, Capsule::sphere(point.at_world_m, point.radius_m)});
  }
  if (parts.empty()) {
    fail(cell.file.string(), ": ask: none of the links that are asked for has a shape");
  }
  return parts;
}

}  // namespace

files::RecordingOptions recording_options(const CameraEntry& entry) {
  files::RecordingOptions options;
  options.camera_ids = {entry.recorded_as};
  if (files::is_mcap(entry.recording)) {
    if (!entry.device.empty()) {
      options.mcap.depth_topics = {entry.recorded_as + "=" + entry.device};
    }
    options.mcap.info_topic = entry.info_topic;
    options.mcap.intrinsics = entry.intrinsics;
    options.mcap.T_world_camera = entry.T_world_camera;
  } else if (!entry.device.empty() || !entry.info_topic.empty()) {
    fail(entry.place, ": topic, camera_info: are of MCAP files, and ", entry.recording.string(),
         " is none: remove them");
  }
  return options;
}

robot::RobotModel robot_model(const RobotEntry& entry) {
  return entry.is_built_in ? robot::kuka_lwr4() : robot::RobotModel(robot::load_urdf(entry.urdf));
}

CellSetup setup(const Cell& cell) {
  CellSetup result;
  result.rig.name = cell.name;
  for (std::size_t k = 0; k < cell.cameras.size(); ++k) {
    result.rig.cameras.push_back(camera_of(cell.cameras[k], k, result.shown));
  }
  result.rig = checked_rig(std::move(result.rig), "the cell");
  views::Settings& settings = result.settings;
  settings.space = cell.space;
  settings.policies = cell.policies;
  settings.margins = camera_margins(result.rig);
  settings.rho_m = cell.ask.rho_m;
  settings.resolution_m = cell.ask.resolution_m;
  settings.v_max_m_s = cell.v_max_m_s;
  views::validate(settings, result.rig);
  result.options.max_image_age_s = cell.ages.image_s;
  result.options.memory = cell.memory;
  if (cell.robot) {
    result.robot = robot::PlacedRobot{robot_model(*cell.robot), cell.robot->T_world_base};
    result.exposure.removal = {
        .padding_m = cell.robot->padding_m, .whole_pixels = true, .margin_in_test = cell.robot->margin_in_test};
    result.exposure.time_error_s = cell.robot->joints.time_error_s;
    if (cell.robot->joint_acceleration) {
      result.exposure.joint_accelerations.assign(result.robot->model.joints().size(), *cell.robot->joint_acceleration);
    }
  }
  result.parts = parts_of(cell, result.robot);
  return result;
}

std::vector<std::string> implausible(const Cell& cell, const CellSetup& setup) {
  std::vector<std::string> lines;
  const auto say = [&](const auto&... parts) {
    std::ostringstream text;
    text.precision(4);
    (text << ... << parts);
    lines.push_back(text.str());
  };
  for (std::size_t k = 0; k < cell.cameras.size(); ++k) {
    const CameraEntry& entry = cell.cameras[k];
    const RigCamera& camera = setup.rig.cameras[k];
    if (camera.margins->translation_m == 0 && camera.margins->rotation_rad == 0 &&
        entry.source != SourceKind::simulated) {
      say(entry.place, ": nothing says how well the camera's pose is known: margins: {translation_m, rotation_deg}");
    }
    if (camera.margins->half_exposure_s == 0 && cell.v_max_m_s > 0 && entry.source != SourceKind::simulated) {
      say(entry.place,
          ": nothing says how long the camera exposes, so it counts as no time: margins: {half_exposure_s}");
    }
    const Eigen::Vector3d middle = 0.5 * (cell.space.low_world + cell.space.high_world);
    const DepthPoint seen = project(camera.intrinsics, camera.T_world_camera.inverse(Eigen::Isometry) * middle);
    if (!entry.frame.empty()) {
      continue;  // nobody knows yet where it stands
    }
    if (!(seen.depth_m > 0) ||
        !camera.intrinsics.contains(static_cast<int>(std::floor(std::clamp(seen.x_px, -1e6, 1e6))),
                                    static_cast<int>(std::floor(std::clamp(seen.y_px, -1e6, 1e6))))) {
      say(entry.place, ": the middle of the space of interest is not in the camera's image: look at its pose");
    }
    if (cell.robot && !cell.robot->margin_in_test) {
      const double depth_m = (camera.T_world_camera.translation() - cell.robot->T_world_base.translation()).norm();
      const double margin_m = depth_margin_m(camera.margins->sensor, depth_m);
      if (cell.robot->padding_m < margin_m) {
        say(cell.robot->place, ": padding_m: ", cell.robot->padding_m, " m is less than what camera '", entry.name,
            "' may err at the robot, ", margin_m, " m: the robot may be its own obstacle; see margin_in_test");
      }
    }
  }
  const double stopping_m = cell.v_max_m_s * cell.ask.stopping_s.value_or(0);
  if (cell.ask.stop_m < stopping_m) {
    say(cell.file.string(), ": ask.stop_m: ", cell.ask.stop_m, " m is less than what moves while the robot stops, ",
        stopping_m, " m");
  }
  const double ages_m = cell.v_max_m_s * cell.ages.image_s;
  if (ages_m > cell.ask.rho_m) {
    say(cell.file.string(), ": ask.rho_m: ", cell.ask.rho_m, " m is less than what moves within ages.image_s, ", ages_m,
        " m: old images then say nothing");
  }
  return lines;
}

}  // namespace depthgrid::cell
