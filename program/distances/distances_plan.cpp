#include "program/distances/distances_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "depthgrid/search/search_evaluator.hpp"
#include "program/distances/recorded_grid.hpp"
#include "program/frame_selection.hpp"
#include "program/usage_error.hpp"

namespace depthgrid::program {

namespace {

/// World to the frame in which the user speaks.
Pose output_frame(const std::string& name, const Rig& rig) {
  if (name == "world") {
    return Pose::Identity();
  }
  if (!rig.T_floor_world) {
    fail("--in floor: the rig file has no T_floor_world, so there is no floor frame; use --in world");
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

/// Whether the margins allow for what moves between the images of one number.
bool covers_other_times(const DistancesOptions& options, const std::vector<CameraMargins>& margins) {
  return options.sensor.margin_time_m.value_or(0) > 0 ||
         (options.search.v_max_m_s.value_or(0) > 0 &&
          std::all_of(margins.begin(), margins.end(), [](const auto& m) { return m.time_uncertainty_s > 0; }));
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
      !covers_other_times(options, margins)) {
    fail_usage(
        "the rig file says \"simultaneous\": false, so images of one number are of different times; give "
        "--static-scene if nothing moves, or --margin-time with how far an obstacle moves between them");
  }
}

std::unique_ptr<DistanceEvaluator> make_search_evaluator(const Rig& rig, const views::Settings& settings,
                                                         const search::Budget& budget, bool hybrid) {
  const std::size_t directions = hybrid ? std::numeric_limits<std::size_t>::max() : 0;
  return std::make_unique<search::SearchEvaluator>(
      rig, settings, search::EvaluatorOptions{.directions = directions, .budget = budget});
}

}  // namespace

DistancesPlan plan_distances(const DistancesOptions& options) {
  check_method(options);
  const bool searches = options.evaluation.method == "search";
  Points points = control_points(options.points);

  files::RecordingOptions recording_options;
  recording_options.camera_ids = options.cameras;
  recording_options.near_m = near_limit_m(options.sensor);
  recording_options.far_m = far_limit_m(options.sensor);
  recording_options.clamp_beyond_far = clamp_beyond_far(options.sensor);
  files::Recording recording(options.recording, recording_options);
  const auto margins = camera_margins(options.sensor, recording.rig(), searches);
  check(recording, options, margins);

  const std::size_t principal = options.principal.empty() ? 0 : camera_index(recording.rig(), options.principal);
  const Pose T_output_rig = output_frame(options.frame_of_points, recording.rig());
  // The search's box stands upright in the frame of the points, so that frame is its world.
  Rig rig = searches ? moved(recording.rig(), T_output_rig) : recording.rig();
  const Pose T_output_world = searches ? Pose::Identity() : T_output_rig;
  const int first = recording.frame_number(0);
  std::vector<int> indices = select_frames(options.frames, first, recording.frame_count());
  for (int& index : indices) {
    index -= first;
  }

  const bool hybrid = options.evaluation.collect == "hybrid";
  auto evaluator =
      searches ? make_search_evaluator(rig, search_settings(options.search, options.evaluation, principal, margins),
                                       search_budget(options.search), hybrid)
               : make_grid_evaluator(recording, indices, options.evaluation, {options.map_file, principal},
                                     evaluation_settings(options.evaluation, margins));
  const auto format = options.format == "csv" ? AnswerFormat::csv : AnswerFormat::json_lines;
  const AnswerColumns columns{.hybrid_direction = hybrid, .obstacle_points = hybrid && !searches, .shapes = searches};
  return {.recording = std::move(recording),
          .rig = std::move(rig),
          .T_output_world = T_output_world,
          .frames = std::move(indices),
          .points = std::move(points),
          .evaluator = std::move(evaluator),
          .takes_shapes = searches,
          .format = format,
          .columns = columns,
          .rho_m = options.evaluation.rho_m,
          .output = options.output,
          .pictures = options.pictures};
}

}  // namespace depthgrid::program
