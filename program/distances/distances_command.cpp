#include "program/distances/distances_command.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "depthgrid/grid/grid_evaluator.hpp"
#include "program/distances/distances_plan.hpp"
#include "program/distances/frame_picture.hpp"
#include "program/output_file.hpp"
#include "program/usage_error.hpp"
#include "report/progress_line.hpp"

namespace depthgrid::program {

namespace {

std::filesystem::path picture_file(const std::string& folder, int frame_number) {
  std::string number = std::to_string(frame_number);
  number.insert(0, number.size() < 4 ? 4 - number.size() : 0, '0');
  return std::filesystem::path(folder) / ("frame_" + number + ".png");
}

std::vector<Answer> evaluate(const DistancesPlan& plan, const std::vector<files::ControlPoint>& points_world,
                             double now_s) {
  std::vector<Capsule> capsules;
  capsules.reserve(points_world.size());
  for (const files::ControlPoint& point : points_world) {
    if (!plan.takes_shapes && (point.has_end || point.capsule.radius_m != 0)) {
      fail("control point '", point.id, "' has a ", point.has_end ? "second end" : "radius",
           ", which only --method search knows");
    }
    capsules.push_back(point.capsule);
  }
  std::vector<Answer> answers(capsules.size());
  plan.evaluator->evaluate(capsules, now_s, answers);
  return answers;
}

void run(const DistancesOptions& options) {
  DistancesPlan plan = plan_distances(options);
  const AnswerWriter writer(plan.format, plan.rig, plan.T_output_world, plan.columns);
  OutputFile output(plan.output);
  if (!plan.pictures.empty()) {
    make_output_directory(plan.pictures);
  }
  output.write(writer.header());

  report::ProgressLine progress("frame", plan.frames.size());
  for (std::size_t i = 0; i < plan.frames.size(); ++i) {
    const int index = plan.frames[i];
    const int number = plan.recording.frame_number(index);
    const auto points_now = plan.points.at(number);
    const auto frames = plan.recording.read(index);
    for (std::size_t k = 0; k < frames.size(); ++k) {
      if (const FrameUpdate update = plan.evaluator->update(k, frames[k]); !update.taken()) {
        fail("frame ", number, ", camera '", plan.rig.cameras[k].id, "': ", update.reason);
      }
    }
    const auto time_s =
        plan.recording.rate_hz() ? std::optional<double>(index / *plan.recording.rate_hz()) : std::optional<double>();
    const auto points_world = in_world(points_now, plan.T_output_world.inverse());
    const std::vector<Answer> answers = evaluate(plan, points_world, frames.front().time_s);
    std::vector<PictureLine> picture;
    for (std::size_t k = 0; k < points_now.size(); ++k) {
      output.write(writer.line(number, time_s, points_now[k], answers[k]));
      const bool on_axis = answers[k].on_axis_world.allFinite();
      picture.push_back({on_axis ? answers[k].on_axis_world : points_world[k].capsule.a, answers[k].nearest});
    }
    if (!plan.pictures.empty()) {
      save_frame_picture(picture_file(plan.pictures, number), plan.rig.name + ", frame " + std::to_string(number),
                         plan.rig, frames, picture, plan.rho_m);
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
