#include "program/distances/distances_command.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "depthgrid/files/recording.hpp"
#include "depthgrid/grid/grid_evaluator.hpp"
#include "depthgrid/search/search_evaluator.hpp"
#include "program/distances/answer_writer.hpp"
#include "program/distances/evaluation_options.hpp"
#include "program/distances/frame_picture.hpp"
#include "program/distances/point_options.hpp"
#include "program/distances/recorded_grid.hpp"
#include "program/distances/search_options.hpp"
#include "program/frame_selection.hpp"
#include "program/output_file.hpp"
#include "program/sensor_options.hpp"
#include "program/usage_error.hpp"
#include "report/progress_line.hpp"

namespace depthgrid::program {

namespace {

struct DistancesOptions {
  std::string recording;
  std::vector<std::string> cameras;
  std::string principal;
  PointOptions points;
  std::string frame_of_points = "world";
  std::string frames;
  bool static_scene = false;
  std::string map_file;
  std::string format = "csv";
  std::string output = "-";
  std::string pictures;
  EvaluationOptions evaluation;
  SensorOptions sensor;
  SearchOptions search;
};

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

std::filesystem::path picture_file(const std::string& folder, int frame_number) {
  std::string number = std::to_string(frame_number);
  number.insert(0, number.size() < 4 ? 4 - number.size() : 0, '0');
  return std::filesystem::path(folder) / ("frame_" + number + ".png");
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

std::vector<Answer> evaluate(DistanceEvaluator& evaluator, const std::vector<files::ControlPoint>& points_world,
                             double now_s, bool searches) {
  std::vector<Capsule> capsules;
  capsules.reserve(points_world.size());
  for (const files::ControlPoint& point : points_world) {
    if (!searches && (point.has_end || grid::why_refused(point.capsule) != nullptr)) {
      fail("control point '", point.id, "' has a ", point.has_end ? "second end" : "radius",
           ", which only --method search knows");
    }
    capsules.push_back(point.capsule);
  }
  std::vector<Answer> answers(capsules.size());
  evaluator.evaluate(capsules, now_s, answers);
  return answers;
}

void run(const DistancesOptions& options) {
  check_method(options);
  const bool searches = options.evaluation.method == "search";
  const Points points = control_points(options.points);

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
  const Rig rig = searches ? moved(recording.rig(), T_output_rig) : recording.rig();
  const Pose T_output_world = searches ? Pose::Identity() : T_output_rig;
  const int first = recording.frame_number(0);
  std::vector<int> indices = select_frames(options.frames, first, recording.frame_count());
  for (int& index : indices) {
    index -= first;
  }

  const bool hybrid = options.evaluation.collect == "hybrid";
  const auto evaluator =
      searches ? make_search_evaluator(rig, search_settings(options.search, options.evaluation, principal, margins),
                                       search_budget(options.search), hybrid)
               : make_grid_evaluator(recording, indices, options.evaluation, {options.map_file, principal},
                                     evaluation_settings(options.evaluation, margins));
  const auto format = options.format == "csv" ? AnswerFormat::csv : AnswerFormat::json_lines;
  const AnswerWriter writer(format, rig, T_output_world,
                            {.hybrid_direction = hybrid, .obstacle_points = hybrid && !searches, .shapes = searches});
  OutputFile output(options.output);
  if (!options.pictures.empty()) {
    make_output_directory(options.pictures);
  }
  output.write(writer.header());

  report::ProgressLine progress("frame", indices.size());
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const int index = indices[i];
    const int number = recording.frame_number(index);
    const auto points_now = points.at(number);
    const auto frames = recording.read(index);
    for (std::size_t k = 0; k < frames.size(); ++k) {
      if (const FrameUpdate update = evaluator->update(k, frames[k]); !update.taken()) {
        fail("frame ", number, ", camera '", rig.cameras[k].id, "': ", update.reason);
      }
    }
    const auto time_s =
        recording.rate_hz() ? std::optional<double>(index / *recording.rate_hz()) : std::optional<double>();
    const auto points_world = in_world(points_now, T_output_world.inverse());
    const std::vector<Answer> answers = evaluate(*evaluator, points_world, frames.front().time_s, searches);
    std::vector<PictureLine> picture;
    for (std::size_t k = 0; k < points_now.size(); ++k) {
      output.write(writer.line(number, time_s, points_now[k], answers[k]));
      const bool on_axis = answers[k].on_axis_world.allFinite();
      picture.push_back({on_axis ? answers[k].on_axis_world : points_world[k].capsule.a, answers[k].nearest});
    }
    if (!options.pictures.empty()) {
      save_frame_picture(picture_file(options.pictures, number), rig.name + ", frame " + std::to_string(number), rig,
                         frames, picture, options.evaluation.rho_m);
    }
    progress.update(i + 1);
  }
  output.commit();
}

void add_input_options(CLI::App& command, DistancesOptions& options) {
  command.add_option("RECORDING", options.recording, "folder with a rig.json, or a rig file")->required();
  command.add_option("--cameras", options.cameras, "ids of the cameras to use, for instance cam1,cam3 (default: all)")
      ->delimiter(',')
      ->allow_extra_args(false);
  command.add_option("--principal", options.principal,
                     "camera whose view is the space of interest (default: the first of the cameras used)");
  command
      .add_option("--point", options.points.texts,
                  "control point x,y,z or name=x,y,z, metres; repeatable. For the search also a sphere x,y,z,radius "
                  "or a capsule x,y,z,radius,x2,y2,z2")
      ->allow_extra_args(false);
  command.add_option("--points", options.points.file,
                     "CSV file of control points: id,x,y,z or frame,id,x,y,z; with a header also radius and x2,y2,z2");
  command.add_option("--in", options.frame_of_points, "frame of the points, and of all coordinates written")
      ->check(CLI::IsMember({"world", "floor"}))
      ->capture_default_str();
  command.add_option("--frames", options.frames, "frames: 5, 0:80 (both included), 0:80:8 or 1,4,9 (default: all)");
  command.add_flag("--static-scene", options.static_scene,
                   "the scene does not move: frames of different times may be combined");
}

void add_map_option(CLI::App& command, DistancesOptions& options) {
  command
      .add_option("--map", options.map_file,
                  "map file of 'depthgrid map build' for --method letter; its depth cells are used")
      ->group("Depth grid");
}

void add_output_options(CLI::App& command, DistancesOptions& options) {
  command.add_option("--format", options.format, "csv, or jsonl: one JSON object a line")
      ->check(CLI::IsMember({"csv", "jsonl"}))
      ->capture_default_str();
  command.add_option("--output", options.output, "file to write, - for standard output")->capture_default_str();
  command.add_option("--pictures", options.pictures,
                     "folder for a picture of every frame: depth, points and distances");
}

}  // namespace

void add_distances_command(CLI::App& app) {
  auto options = std::make_shared<DistancesOptions>();
  CLI::App* command = app.add_subcommand("distances", "distances from control points to obstacles in a recording");
  add_input_options(*command, *options);
  add_output_options(*command, *options);
  add_evaluation_options(*command, options->evaluation);
  add_sensor_options(*command, options->sensor);
  add_search_options(*command, options->search);
  add_map_option(*command, *options);
  command->footer(
      "Examples:\n"
      "  depthgrid distances ../shared/data/kinect3_ball --point hand=0.1,2.6,1.2 --in floor --frames 0:80:8\n"
      "  depthgrid distances rig.json --cameras cam1,cam3 --principal cam3 --points points.csv \\\n"
      "      --sensor kinect_v1 --format jsonl --output distances.jsonl\n"
      "  depthgrid distances ../shared/data/kinect3_ball --point=-0.2,-0.8,2.9,0.05 --frames 0:80:8 \\\n"
      "      --method search --sensor kinect_v1 --margin-translation 0.05 --v-max 2 --box=-3,-3,0.5,3,3,6 \\\n"
      "      --unobserved obstacle --outside ignored --robot-pockets obstacle\n"
      "One line a frame and point. distance_m is empty (null) where it is not known; see docs/command.md.");
  command->callback([options] { run(*options); });
}

}  // namespace depthgrid::program
