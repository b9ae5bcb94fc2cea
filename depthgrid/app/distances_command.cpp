#include "depthgrid/app/distances_command.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "depthgrid/app/answer_writer.hpp"
#include "depthgrid/app/evaluation_options.hpp"
#include "depthgrid/app/frame_picture.hpp"
#include "depthgrid/app/frame_selection.hpp"
#include "depthgrid/app/output_file.hpp"
#include "depthgrid/app/progress_line.hpp"
#include "depthgrid/app/usage_error.hpp"
#include "depthgrid/grid/evaluation.hpp"
#include "depthgrid/grid/map_file.hpp"
#include "depthgrid/input/control_points.hpp"
#include "depthgrid/input/recording.hpp"

namespace depthgrid::app {

namespace {

struct DistancesOptions {
  std::string recording;
  std::vector<std::string> cameras;
  std::string principal;
  std::vector<std::string> points;
  std::string points_file;
  std::string frame_of_points = "world";
  std::string frames;
  bool static_scene = false;
  std::string map_file;
  std::string format = "csv";
  std::string output = "-";
  std::string pictures;
  EvaluationOptions evaluation;
};

/// Control points of the command line, in every frame, and those of a file, which may move.
struct Points {
  std::vector<input::ControlPoint> of_command_line;
  input::ControlPoints of_file;

  [[nodiscard]] std::vector<input::ControlPoint> at(int frame_number) const {
    std::vector<input::ControlPoint> points = of_command_line;
    const auto more = of_file.at(frame_number);
    points.insert(points.end(), more.begin(), more.end());
    return points;
  }
};

input::ControlPoint command_line_point(const std::string& text, std::size_t number) {
  std::string id = "p" + std::to_string(number);
  std::string coordinates = text;
  if (const auto equals = text.find('='); equals != std::string::npos) {
    id = text.substr(0, equals);
    coordinates = text.substr(equals + 1);
    if (id.empty()) {
      fail_usage("--point ", text, ": the name before '=' is empty");
    }
  }
  try {
    return input::parse_control_point(coordinates, id);
  } catch (const Error& error) {
    throw UsageError("--point " + text + ": " + error.what());
  }
}

Points control_points(const DistancesOptions& options) {
  Points points;
  for (const auto& text : options.points) {
    points.of_command_line.push_back(command_line_point(text, points.of_command_line.size() + 1));
  }
  if (!options.points_file.empty()) {
    points.of_file = input::load_control_points(options.points_file);
  } else if (points.of_command_line.empty()) {
    fail_usage("no control point: give --point x,y,z (metres, repeatable) or --points FILE.csv");
  }
  return points;
}

void check_names(const std::vector<input::ControlPoint>& points, int frame_number) {
  std::set<std::string> names;
  for (const auto& point : points) {
    if (!names.insert(point.id).second) {
      fail("two control points of frame ", frame_number, " are called '", point.id, "'; names must differ");
    }
  }
}

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

/// The deepest reading of the principal camera in the frames chosen: the grid then holds everything it sees.
double deepest_reading_m(input::Recording& recording, std::size_t camera, const MeasurementRule& rule,
                         const std::vector<int>& indices) {
  ProgressLine progress("looking for the deepest reading, frame", indices.size());
  input::Gray16Image image;
  const auto& intrinsics = recording.rig().cameras[camera].intrinsics;
  double deepest_m = 0;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const auto file = recording.depth_file(indices[i], camera);
    input::read_png16(file, image);
    if (image.width_px != intrinsics.width_px || image.height_px != intrinsics.height_px) {
      (void)recording.read(indices[i]);  // says what is wrong with this frame
    }
    const auto view =
        depth_view(image.pixels, image.width_px, image.height_px, recording.rig().cameras[camera].metres_per_unit);
    DepthImage depth(image.width_px, image.height_px);
    normalise(view, rule, depth);
    const auto* end = depth.data() + depth.index(0, depth.height_px());
    deepest_m = std::max(deepest_m, static_cast<double>(*std::max_element<const float*>(depth.data(), end)));
    progress.update(i + 1);
  }
  if (!(deepest_m > 0)) {
    fail("camera '", recording.rig().cameras[camera].id,
         "' spans the depth grid and measures nothing in the chosen frames, so the grid has no far end; give --far or "
         "--count, or another --principal");
  }
  return deepest_m;
}

std::filesystem::path picture_file(const std::string& folder, int frame_number) {
  std::string number = std::to_string(frame_number);
  number.insert(0, number.size() < 4 ? 4 - number.size() : 0, '0');
  return std::filesystem::path(folder) / ("frame_" + number + ".png");
}

/// The stored map, or nothing: the closed form is used then.
std::shared_ptr<const grid::DepthGridMap> load_map(const DistancesOptions& options, const Rig& rig,
                                                   std::size_t principal, const grid::DepthQuantisation& cells) {
  if (options.map_file.empty()) {
    return nullptr;
  }
  const std::vector<grid::SecondaryCamera> secondaries = grid::secondary_cameras(rig, principal);
  const grid::DepthGrid depth_grid(rig.cameras[principal].intrinsics, cells);
  return std::make_shared<const grid::DepthGridMap>(grid::load_map(options.map_file, depth_grid, secondaries));
}

/// What the rig file says and what the user says must fit together.
void check(const input::Recording& recording, const DistancesOptions& options,
           const grid::EvaluationSettings& settings) {
  const auto& cameras = recording.rig().cameras;
  if (std::any_of(cameras.begin(), cameras.end(),
                  [](const auto& c) { return c.rule.clamp_beyond_far && !std::isfinite(c.rule.far_m); })) {
    fail_usage("--beyond-far clamp needs a farthest measurable depth: give --far");
  }
  // Space that one camera saw free may be occupied when another one looks.
  if (!recording.simultaneous() && cameras.size() > 1 && !options.static_scene && !(settings.pose.time_m > 0)) {
    fail_usage(
        "the rig file says \"simultaneous\": false, so images of one number are of different times; give "
        "--static-scene if nothing moves, or --margin-time with how far an obstacle moves between them");
  }
}

void run(const DistancesOptions& options) {
  const auto settings = evaluation_settings(options.evaluation);
  if (!options.map_file.empty() && settings.variant == grid::Variant::corrected) {
    fail_usage("--map has no effect with --variant corrected, which looks at whole cells; use --variant letter");
  }
  const Points points = control_points(options);

  input::RecordingOptions recording_options;
  recording_options.camera_ids = options.cameras;
  recording_options.near_m = near_limit_m(options.evaluation);
  recording_options.far_m = far_limit_m(options.evaluation);
  recording_options.clamp_beyond_far = clamp_beyond_far(options.evaluation);
  input::Recording recording(options.recording, recording_options);
  const Rig& rig = recording.rig();
  check(recording, options, settings);

  const std::size_t principal = options.principal.empty() ? 0 : camera_index(rig, options.principal);
  const Pose T_output_world = output_frame(options.frame_of_points, rig);
  const Pose T_world_output = T_output_world.inverse();
  const int first = recording.frame_number(0);
  std::vector<int> indices = select_frames(options.frames, first, recording.frame_count());
  for (int& index : indices) {
    index -= first;
  }

  grid::DepthQuantisation base;
  std::optional<double> reach_m;
  if (!options.map_file.empty()) {
    base = grid::read_map_info(options.map_file).calibration.quantisation;
  } else if (!options.evaluation.count) {
    const auto& rule = rig.cameras[principal].rule;
    reach_m = std::isfinite(rule.far_m) ? rule.far_m : deepest_reading_m(recording, principal, rule, indices);
  }
  const auto cells = depth_quantisation(options.evaluation, base, reach_m);
  grid::GridEvaluator evaluator(rig, principal, cells, settings, load_map(options, rig, principal, cells));

  const auto format = options.format == "csv" ? AnswerFormat::csv : AnswerFormat::json_lines;
  const AnswerWriter writer(format, rig, T_output_world, settings.collect == grid::Collect::hybrid);
  OutputFile output(options.output);
  if (!options.pictures.empty()) {
    make_output_directory(options.pictures);
  }
  output.write(writer.header());

  ProgressLine progress("frame", indices.size());
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const int index = indices[i];
    const int number = recording.frame_number(index);
    const auto points_now = points.at(number);
    check_names(points_now, number);
    const auto frames = recording.read(index);
    if (!evaluator.update(frames)) {
      fail("frame ", number, ": a camera has no image");
    }
    const auto time_s =
        recording.rate_hz() ? std::optional<double>(index / *recording.rate_hz()) : std::optional<double>();
    std::vector<PictureLine> picture;
    for (const auto& point : points_now) {
      const Eigen::Vector3d p_world = T_world_output * point.p_m;
      const grid::Evaluation answer = evaluator.evaluate(p_world);
      output.write(writer.line(number, time_s, point, answer));
      picture.push_back({p_world, answer.nearest});
    }
    if (!options.pictures.empty()) {
      save_frame_picture(picture_file(options.pictures, number), rig.name + ", frame " + std::to_string(number), rig,
                         frames, picture, settings.rho_m);
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
                     "camera whose pixels span the depth grid (default: the first of the cameras used)");
  command.add_option("--point", options.points, "control point x,y,z or name=x,y,z, metres; repeatable")
      ->allow_extra_args(false);
  command.add_option("--points", options.points_file, "CSV file of control points: id,x,y,z or frame,id,x,y,z");
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
                  "map file of 'depthgrid map build' for --variant letter; its depth cells are used")
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
  add_map_option(*command, *options);
  command->footer(
      "Examples:\n"
      "  depthgrid distances ../shared/data/kinect3_ball --point hand=0.1,2.6,1.2 --in floor --frames 0:80:8\n"
      "  depthgrid distances rig.json --cameras cam1,cam3 --principal cam3 --points points.csv \\\n"
      "      --sensor kinect-v1 --format jsonl --output distances.jsonl\n"
      "One line a frame and point. distance_m is empty (null) where it is not known; see docs/command.md.");
  command->callback([options] { run(*options); });
}

}  // namespace depthgrid::app
