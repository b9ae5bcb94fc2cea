#include "program/distances/distances_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "depthgrid/search/search_evaluator.hpp"
#include "program/distances/frame_picture.hpp"
#include "program/distances/recorded_grid.hpp"
#include "program/distances/smallest_obstacle.hpp"
#include "program/frame_selection.hpp"
#include "program/open_recording.hpp"
#include "program/output_check.hpp"
#include "program/usage_error.hpp"

namespace depthgrid::program {

namespace {

/// World to the frame in which the user speaks.
Pose output_frame(const std::string& name, const Rig& rig) {
  if (name == "world") {
    return Pose::Identity();
  }
  if (!rig.T_floor_world) {
    fail_usage("--in floor: the rig file has no T_floor_world, so there is no floor frame; use --in world");
  }
  return *rig.T_floor_world;
}

/// The rig with `T_output_world`'s target as its world frame.
Rig moved(Rig rig, const Pose& T_output_world) {
  for (RigCamera& camera : rig.cameras) {
    camera.T_world_camera = T_output_world * camera.T_world_camera;
  }
  return rig;
}

/// Options of one method are not passed over in silence by another.
void check_method(const DistancesOptions& options) {
  const std::string& method = options.evaluation.method;
  const bool searches = method == "search";
  if (searches) {
    refuse_grid_options(options.evaluation);
  } else {
    refuse_search_options(options.search, method);
  }
  if (!options.map_file.empty() && method != "letter") {
    fail_usage("--map has no effect with --method ", method, ", which ",
               searches ? "has no depth grid" : "looks at whole cells", "; use --method letter");
  }
  if (method == "letter" && names_margins(options.sensor)) {
    fail_usage("--margin-... has no effect with --method letter, which knows no margins; use --method corrected");
  }
  if (!searches && (options.sensor.half_exposure_s || options.sensor.time_uncertainty_s)) {
    fail_usage(
        "--half-exposure and --time-uncertainty have no effect with --method corrected, which knows no speed of "
        "obstacles; use --margin-time, or --method search with --v-max");
  }
}

/// Whether the margins allow for what moves between the images of one frame. The search knows the times of images with
/// time stamps, if they are of one clock.
bool covers_other_times(const DistancesOptions& options, const files::Recording& recording,
                        const std::vector<CameraMargins>& margins) {
  const bool knows_times = recording.has_time_stamps() && recording.shared_clock().value_or(true);
  return options.sensor.margin_time_m.value_or(0) > 0 ||
         (options.search.v_max_m_s.value_or(0) > 0 &&
          (knows_times ||
           std::all_of(margins.begin(), margins.end(), [](const auto& m) { return m.time_uncertainty_s > 0; })));
}

/// Whether anything says how long the camera takes for an image: the command line, a sensor model, or the rig file.
bool states_exposure(const SensorOptions& options, const RigCamera& camera) {
  return options.half_exposure_s || options.sensor || !camera.sensor.empty() ||
         (camera.margins && camera.margins->half_exposure_s > 0);
}

/// What the rig file says and what the user says must fit together.
void check(const files::Recording& recording, const DistancesOptions& options,
           const std::vector<CameraMargins>& margins) {
  const auto& cameras = recording.rig().cameras;
  for (std::size_t k = 0; k < cameras.size(); ++k) {
    if (recording.moves(k) && options.evaluation.method != "search") {
      fail_usage("camera '", cameras[k].id, "' moves, and --method ", options.evaluation.method,
                 " needs cameras that stand still; use --method search");
    }
  }
  if (std::any_of(cameras.begin(), cameras.end(),
                  [](const auto& c) { return c.rule.clamp_beyond_far && !std::isfinite(c.rule.far_m); })) {
    fail_usage("--beyond-far clamp needs a farthest measurable depth: give --far");
  }
  for (const RigCamera& camera : cameras) {
    if (options.search.v_max_m_s.value_or(0) > 0 && !states_exposure(options.sensor, camera)) {
      fail_usage("camera '", camera.id, "': obstacles move (--v-max ", *options.search.v_max_m_s,
                 ") and nothing says for how long an image is exposed; give --half-exposure S or --sensor NAME");
    }
  }
  // Space that one camera saw free may be occupied when another one looks.
  if (!recording.simultaneous() && cameras.size() > 1 && !options.static_scene &&
      !covers_other_times(options, recording, margins)) {
    fail_usage(recording.has_time_stamps()
                   ? "the time stamps say that images of one frame are of different times"
                   : "the rig file says \"simultaneous\": false, so images of one number are of "
                     "different times",
               "; give --static-scene if nothing moves, or --margin-time with how far an obstacle moves between them");
  }
  if (recording.has_trajectory() && !recording.shared_clock().value_or(true)) {
    fail(
        "the rig file says \"shared_clock\": false, so the trajectory does not say where the camera was when it took "
        "an "
        "image; correct the time stamps first");
  }
}

/// Every pose is there before work begins.
void check_places(const files::Recording& recording, const std::vector<int>& indices) {
  for (std::size_t k = 0; k < recording.rig().cameras.size(); ++k) {
    if (recording.moves(k)) {
      for (const int index : indices) {
        if (recording.has_image(index, k)) {
          (void)recording.T_world_camera(index, k);
        }
      }
    }
  }
}

/// Its view is the space of interest, which cannot be nowhere.
void check_images_of_principal(const files::Recording& recording, const std::vector<int>& indices,
                               std::size_t principal) {
  for (const int index : indices) {
    if (!recording.has_image(index, principal)) {
      fail_usage("--principal ", recording.rig().cameras[principal].id,
                 ": its view is the space of interest, and it has no image "
                 "within tolerance_s in frame ",
                 recording.frame_number(index), "; give --box, or name it first in --cameras");
    }
  }
}

/// Time stamps of two sources are compared as if they were of one clock.
void warn_of_clocks(const files::Recording& recording, std::vector<std::string>& warnings) {
  const std::size_t sources = recording.rig().cameras.size() + (recording.has_trajectory() ? 1 : 0);
  if (recording.has_time_stamps() && sources > 1 && !recording.shared_clock()) {
    warnings.emplace_back(
        "the rig file does not say that all time stamps are of one clock (\"shared_clock\": true in \"frames\"); they "
        "are "
        "compared as if they were");
  }
}

void warn_of_missing_images(const files::Recording& recording, const std::vector<int>& indices,
                            std::vector<std::string>& warnings) {
  for (std::size_t k = 0; recording.has_time_stamps() && k < recording.rig().cameras.size(); ++k) {
    const auto missing =
        std::count_if(indices.begin(), indices.end(), [&](int index) { return !recording.has_image(index, k); });
    if (missing > 0) {
      warnings.push_back("camera '" + recording.rig().cameras[k].id + "' has no image within tolerance_s in " +
                         std::to_string(missing) + " of " + std::to_string(indices.size()) +
                         " frames; it frees nothing there");
    }
  }
}

/// A recording has no clock: what its images are from, they are asked about.
constexpr double kRecordedAge_s = 3600;

/// Without times nobody knows how far things have moved from frame to frame.
void check_memory(const DistancesOptions& options, const files::Recording& recording, const std::vector<int>& indices) {
  if (options.search.memory && !recording.time_s(indices.front())) {
    fail_usage("--memory: the recording says no times of its images (\"rate_hz\" in its rig file)");
  }
}

/// What the least padding is asked with; nothing where it is not asked for.
std::optional<avoidance::LeastPaddingSettings> least_padding_settings(const DistancesOptions& options, bool asks_links,
                                                                      const files::Recording& recording,
                                                                      std::size_t frames) {
  if (!options.robot.least_padding) {
    return std::nullopt;
  }
  if (!asks_links || options.evaluation.method != "search") {
    fail_usage("--least-padding asks for the robot's links: give --method search, and no --point and --points");
  }
  // The links of a frame stand where they are at one time, for cameras that stand.
  if (recording.moves() || recording.has_time_stamps()) {
    fail_usage("--least-padding takes cameras that stand still and numbered images; this recording has ",
               recording.moves() ? "a camera that moves" : "time stamps");
  }
  const std::array<std::pair<bool, const char*>, 5> of_distances{
      {{!options.pictures.empty(), "--pictures"},
       {options.reasons, "--reasons"},
       {options.format != "csv", "--format"},
       {options.evaluation.collect == "hybrid", "--collect"},
       {options.search.budget_nodes.has_value(), "--budget-nodes"}}};
  for (const auto& [is_given, name] : of_distances) {
    if (is_given) {
      fail_usage(name, " has no effect with --least-padding, which answers no distances");
    }
  }
  constexpr std::size_t kMostFrames = 100;  // all are kept, and looked at with every padding
  if (frames > kMostFrames) {
    fail_usage("--least-padding: ", frames, " frames, at most ", kMostFrames, "; choose some with --frames");
  }
  avoidance::LeastPaddingSettings settings;
  settings.robot_within_m = options.robot.robot_within_m;
  settings.evaluator.memory = search_memory(options.search);
  settings.evaluator.max_image_age_s = kRecordedAge_s;
  // The last quarter counts where the others fill a memory.
  settings.warm_up = settings.evaluator.memory ? frames - std::max<std::size_t>(1, frames / 4) : 0;
  return settings;
}

std::unique_ptr<DistanceEvaluator> make_search_evaluator(const Rig& rig, const views::Settings& settings,
                                                         const SearchOptions& options, bool hybrid) {
  as_usage([&] { views::validate(settings, rig); });
  const std::size_t directions = hybrid ? std::numeric_limits<std::size_t>::max() : 0;
  search::EvaluatorOptions evaluator;
  evaluator.directions = directions;
  evaluator.budget = search_budget(options);
  evaluator.memory = search_memory(options);
  evaluator.max_image_age_s = kRecordedAge_s;
  return std::make_unique<search::SearchEvaluator>(rig, settings, evaluator);
}

/// With one camera the letter takes the robot out of the image; otherwise the others are asked what is behind it.
grid::EvaluationSettings grid_settings(const DistancesOptions& options, const Rig& rig,
                                       const std::vector<CameraMargins>& margins) {
  grid::EvaluationSettings settings = evaluation_settings(options.evaluation, margins);
  if (options.evaluation.method == "letter" && rig.cameras.size() == 1) {
    settings.robot_pixels = grid::RobotPixels::removed;
  }
  settings.max_image_age_s = kRecordedAge_s;
  return settings;
}

/// Control points, or none where the robot's links are asked for instead.
Points asked_points(const DistancesOptions& options) {
  if (!options.robot.has_robot() || !options.points.texts.empty() || !options.points.file.empty()) {
    return control_points(options.points);
  }
  if (options.evaluation.method != "search") {
    fail_usage("--method ", options.evaluation.method,
               " knows points only: give --point or --points, or --method search, which asks for the robot's links");
  }
  return {};
}

/// The robot in the frames of `rig`, whose cameras err by `margins`; the letter knows no margins.
std::unique_ptr<RecordedRobot> recorded_robot(const DistancesOptions& options, const files::Recording& recording,
                                              Rig rig, const std::vector<CameraMargins>& margins,
                                              const Pose& T_world_rig) {
  if (!options.robot.has_robot()) {
    return nullptr;
  }
  for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
    rig.cameras[k].margins = margins[k];
    if (options.evaluation.method == "letter") {
      rig.cameras[k].sensor.clear();
      rig.cameras[k].margins.reset();
    }
  }
  const bool stamped = recording.has_time_stamps();
  return std::make_unique<RecordedRobot>(
      options.robot, rig, T_world_rig,
      ImageTimes{.known = stamped || recording.rate_hz(), .stamped = stamped, .start_s = recording.start_s()});
}

std::vector<NamedFile> outputs_of(const DistancesOptions& options, const files::Recording& recording,
                                  const std::vector<int>& indices) {
  std::vector<NamedFile> outputs{{"--output", options.output}};
  if (!options.pictures.empty()) {
    for (const int index : indices) {
      outputs.push_back({"the picture of --pictures", picture_file(options.pictures, recording.frame_number(index))});
    }
  }
  return outputs;
}

std::vector<NamedFile> inputs_of(const DistancesOptions& options, const files::Recording& recording) {
  std::vector<NamedFile> inputs = recording_inputs(recording);
  inputs.push_back({"the file of control points", options.points.file});
  inputs.push_back({"the map file", options.map_file});
  if (options.robot.has_robot()) {
    const std::vector<NamedFile> robot = robot_inputs(options.robot.robot);
    inputs.insert(inputs.end(), robot.begin(), robot.end());
  }
  inputs.push_back({"the file of joint positions", options.robot.joints_file});
  return inputs;
}

std::string quoted_ids(const Rig& rig, const std::function<bool(const RigCamera&)>& chosen) {
  std::string ids;
  for (const RigCamera& camera : rig.cameras) {
    if (chosen(camera)) {
      ids += (ids.empty() ? "'" : ", '") + camera.id + "'";
    }
  }
  return ids;
}

/// Real cameras err. Where nobody says by how much the answers may be too large, and the user should know: in one line.
std::vector<std::string> warnings_of(const DistancesOptions& options, const Rig& rig) {
  const SensorOptions& said = options.sensor;
  if (said.sensor == "ideal") {
    return {};
  }
  if (options.evaluation.method == "letter") {
    return {
        "--method letter allows for no errors of readings and calibration, so distances may be too large; "
        "--method corrected and search do (--sensor ideal: there are none)"};
  }
  const std::string ids = quoted_ids(rig, [](const RigCamera& camera) { return !camera.margins; });
  if (ids.empty()) {
    return {};
  }
  if (said.sensor && !said.margin_translation_m && !said.margin_rotation_rad) {
    return {"nothing says how far the calibration of " + ids +
            " may err, so it counts as exact and distances may be too large; give --margin-translation and "
            "--margin-rotation (0: it is exact)"};
  }
  if (said.sensor || names_margins(said)) {
    return {};
  }
  return {
      "nothing says how far the readings of " + ids +
      " may err, so they count as exact and distances may be too large; give --sensor NAME (ideal: they are exact)"};
}

}  // namespace

DistancesPlan plan_distances(const DistancesOptions& options) {
  check_method(options);
  check_robot_options(options.robot);
  const bool searches = options.evaluation.method == "search";
  Points points = asked_points(options);
  const bool asks_links = points.of_command_line.empty() && options.points.file.empty();

  files::RecordingOptions recording_options;
  recording_options.camera_ids = options.cameras;
  recording_options.near_m = near_limit_m(options.sensor);
  recording_options.far_m = far_limit_m(options.sensor);
  recording_options.clamp_beyond_far = clamp_beyond_far(options.sensor);
  recording_options.lateral_px = filter_radius_px(options.sensor);
  recording_options.mcap = options.mcap;
  files::Recording recording = open_recording(options.recording, recording_options);
  auto margins = as_usage([&] { return camera_margins(options.sensor, recording.rig(), searches); });
  std::vector<std::string> assumptions;
  if (searches) {
    assumptions.push_back(declare_smallest_obstacles(options.search.smallest_obstacle_m, options.sensor.sensor,
                                                     recording.rig(), margins));
  }
  check(recording, options, margins);

  const std::size_t principal =
      options.principal.empty() ? 0 : as_usage([&] { return camera_index(recording.rig(), options.principal); });
  const Pose T_output_rig = output_frame(options.frame_of_points, recording.rig());
  // The search's box stands upright in the frame of the points, so that frame is its world.
  Rig rig = searches ? moved(recording.rig(), T_output_rig) : recording.rig();
  const Pose T_output_world = searches ? Pose::Identity() : T_output_rig;
  std::vector<int> indices = select_frames(options.frames, recording);
  check_places(recording, indices);
  check_memory(options, recording, indices);
  if (searches && !options.search.box) {
    check_images_of_principal(recording, indices, principal);
  }

  if (!searches) {
    refuse_shapes(points);
  }
  refuse_overwriting(outputs_of(options, recording, indices), inputs_of(options, recording));
  std::vector<std::string> warnings = warnings_of(options, recording.rig());
  warn_of_clocks(recording, warnings);
  warn_of_missing_images(recording, indices, warnings);

  auto robot = recorded_robot(options, recording, rig, margins, searches ? T_output_rig : Pose::Identity());
  const bool hybrid = options.evaluation.collect == "hybrid";
  auto least_padding = least_padding_settings(options, asks_links, recording, indices.size());
  if (least_padding) {
    least_padding->search = search_settings(options.search, options.evaluation, principal, margins);
    least_padding->least_joints = robot->least_joints();
  }
  auto evaluator =
      searches ? make_search_evaluator(rig, search_settings(options.search, options.evaluation, principal, margins),
                                       options.search, hybrid)
               : make_grid_evaluator(recording, indices, options.evaluation, {options.map_file, principal},
                                     as_usage([&] { return grid_settings(options, recording.rig(), margins); }));
  const auto format = options.format == "csv" ? AnswerFormat::csv : AnswerFormat::json_lines;
  const AnswerColumns columns{.hybrid_direction = hybrid,
                              .obstacle_points = hybrid && !searches,
                              .reasons = options.reasons,
                              .shapes = searches};
  return {.recording = std::move(recording),
          .rig = std::move(rig),
          .T_output_world = T_output_world,
          .T_world_recording = searches ? T_output_rig : Pose::Identity(),
          .frames = std::move(indices),
          .points = std::move(points),
          .robot = std::move(robot),
          .evaluator = std::move(evaluator),
          .least_padding = std::move(least_padding),
          .asks_links = asks_links,
          .takes_shapes = searches,
          .format = format,
          .columns = columns,
          .rho_m = options.evaluation.rho_m,
          .output = options.output,
          .pictures = options.pictures,
          .assumptions = std::move(assumptions),
          .warnings = std::move(warnings)};
}

}  // namespace depthgrid::program
