#include "program/distances/distances_command.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/core/reason_text.hpp"
#include "depthgrid/grid/grid_evaluator.hpp"
#include "program/cell_arguments.hpp"
#include "program/distances/distances_plan.hpp"
#include "program/distances/frame_picture.hpp"
#include "program/distances/least_padding.hpp"
#include "program/mcap_options.hpp"
#include "program/output_file.hpp"
#include "program/usage_error.hpp"
#include "program/warning.hpp"
#include "report/progress_line.hpp"

namespace depthgrid::program {

namespace {

std::vector<Answer> evaluate(const DistancesPlan& plan, const std::vector<files::ControlPoint>& points_world,
                             double now_s) {
  std::vector<Capsule> capsules;
  capsules.reserve(points_world.size());
  for (const files::ControlPoint& point : points_world) {
    capsules.push_back(point.capsule);
  }
  std::vector<Answer> answers(capsules.size());
  plan.evaluator->evaluate(capsules, now_s, answers);
  return answers;
}

/// For people, beside the answers.
void say(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) {
    (void)std::fputs((printable(line) + '\n').c_str(), stderr);
  }
}

bool has_moved_to(const DistancesPlan& plan, int index, std::size_t camera) {
  return plan.recording.moves(camera) && plan.recording.has_image(index, camera);
}

/// A camera that moves goes where it was when it took its image of the frame.
void move_cameras(DistancesPlan& plan, int index) {
  for (std::size_t k = 0; k < plan.rig.cameras.size(); ++k) {
    if (has_moved_to(plan, index, k)) {
      plan.rig.cameras[k].T_world_camera = plan.T_world_recording * plan.recording.T_world_camera(index, k);
    }
  }
}

/// Hands a frame's images over. A camera without an image has seen nothing.
void update_evaluator(DistancesPlan& plan, int index, std::span<const Frame> frames) {
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const bool has_moved = has_moved_to(plan, index, k);
    const Pose& T_world_camera = plan.rig.cameras[k].T_world_camera;
    const FrameUpdate update =
        has_moved ? plan.evaluator->update(k, frames[k], T_world_camera) : plan.evaluator->update(k, frames[k]);
    if (!update.taken() && frames[k].depth.data != nullptr) {
      fail("frame ", plan.recording.frame_number(index), ", camera '", plan.rig.cameras[k].id, "': ", update.reason);
    }
  }
}

/// Of a frame whose newest image is of now_s.
AnswerReason reason_of(const DistancesPlan& plan, const Answer& answer, double now_s) {
  if (!plan.columns.reasons) {
    return {};
  }
  const Past past = plan.evaluator->past(answer.nearest);
  std::array<char, 240> words{};
  AnswerReason reason;
  reason.text = reason_text(answer.nearest, past, now_s, words);
  if (past.state == PastState::possible_again) {
    reason.hidden_s = now_s - past.possible_since_s;
  }
  reason.from_world = past.from_world;
  return reason;
}

/// How many distances say nothing, since they are no more than the blind layer is thick.
class WithinLayer {
 public:
  void add(const Answer& answer) {
    ++answers_;
    within_ += answer.blind_m > 0 && answer.nearest.distance_m <= answer.blind_m ? 1 : 0;
  }
  void warn_of_them() const {
    if (within_ > 0) {
      warn(std::to_string(within_) + " of " + std::to_string(answers_) +
           " distances are no more than blind_m: what is so near may have been taken for the robot, so they say "
           "nothing; docs/robot.md tells how to make the layer thinner");
    }
  }

 private:
  std::size_t answers_ = 0;
  std::size_t within_ = 0;
};

/// Answers under an assumption that an image shows to be broken.
void warn_of_impossible(const DistancesPlan& plan) {
  ImpossibleSurfaces found = plan.evaluator->impossible();
  if (found.images == 0) {
    return;
  }
  found.at_world = plan.T_output_world * found.at_world;
  const std::string& camera = plan.rig.cameras[found.camera].id;
  std::vector<char> text(240 + camera.size());
  warn(std::string(describe(found, text, camera)) + "; docs/memory.md tells what to look at");
}

double newest_time_s(std::span<const Frame> frames) {
  return std::max_element(frames.begin(), frames.end(),
                          [](const Frame& a, const Frame& b) { return a.time_s < b.time_s; })
      ->time_s;
}

void run(const DistancesOptions& options) {
  DistancesPlan plan = plan_distances(options);
  const AnswerWriter writer(plan.format, plan.rig, plan.T_output_world, plan.columns);
  OutputFile output(plan.output);
  if (!plan.pictures.empty()) {
    make_output_directory(plan.pictures);
  }
  for (const std::string& warning : plan.warnings) {
    warn(warning);
  }
  say(plan.assumptions);
  if (plan.robot) {
    say({plan.robot->joints_note()});
  }
  if (plan.least_padding) {
    output.write(least_padding_text(plan));
    output.commit();
    say(plan.robot->pixel_lines());  // a base that is wrong shows here
    return;
  }
  output.write(writer.header());
  WithinLayer within_layer;
  report::ProgressLine progress("frame", plan.frames.size());
  for (std::size_t i = 0; i < plan.frames.size(); ++i) {
    const int index = plan.frames[i];
    const int number = plan.recording.frame_number(index);
    auto points_now = plan.points.at(number);
    std::span<const Frame> frames = plan.recording.read(index);
    move_cameras(plan, index);
    if (plan.robot) {
      frames = plan.robot->frames(number, frames, plan.rig);
    }
    update_evaluator(plan, index, frames);
    const std::optional<double> time_s = plan.recording.time_s(index);
    const double now_s = newest_time_s(frames);
    auto points_world = in_world(points_now, plan.T_output_world.inverse());
    std::vector<Answer> answers;
    if (plan.asks_links) {
      points_world = plan.robot->link_capsules();
      answers = evaluate(plan, points_world, now_s);
      one_answer_a_link(points_world, answers);
      points_now = in_world(points_world, plan.T_output_world);
    } else {
      answers = evaluate(plan, points_world, now_s);
    }
    std::vector<PictureLine> picture;
    for (std::size_t k = 0; k < points_now.size(); ++k) {
      output.write(writer.line(number, time_s, points_now[k], answers[k], reason_of(plan, answers[k], now_s)));
      within_layer.add(answers[k]);
      const bool on_axis = answers[k].on_axis_world.allFinite();
      picture.push_back({on_axis ? answers[k].on_axis_world : points_world[k].capsule.a, answers[k].nearest});
    }
    if (!plan.pictures.empty()) {
      save_frame_picture(picture_file(plan.pictures, number), plan.rig.name + ", frame " + std::to_string(number),
                         plan.rig, frames, picture, plan.rho_m,
                         plan.robot ? std::span<const std::vector<RobotPixel>>(plan.robot->pixels())
                                    : std::span<const std::vector<RobotPixel>>());
    }
    progress.update(i + 1);
  }
  output.commit();
  if (plan.robot) {
    say(plan.robot->pixel_lines());
    say(plan.robot->padding_lines());
  }
  within_layer.warn_of_them();
  warn_of_impossible(plan);
}

void add_input_options(CLI::App& command, DistancesOptions& options) {
  command
      .add_option("RECORDING", options.recording,
                  "folder with a rig.json, a rig file, an MCAP file of ROS 2, or a cell file of recorded "
                  "cameras, CELL.yaml")
      ->required();
  command.add_option("--cameras", options.cameras, "ids of the cameras to use, with commas: cam1,cam3 (default: all)")
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
  command.add_flag("--reasons", options.reasons,
                   "columns that say in words what is nearest and, with --memory, since when something may be there "
                   "and from where");
  command.add_option("--pictures", options.pictures,
                     "folder for a picture of every frame: depth, points and distances");
}

}  // namespace

void add_distances_command(CLI::App& app) {
  auto options = std::make_shared<DistancesOptions>();
  CLI::App* command = app.add_subcommand("distances", "distances from control points to obstacles in a recording");
  add_input_options(*command, *options);
  add_mcap_options(*command, options->mcap);
  add_output_options(*command, *options);
  add_evaluation_options(*command, options->evaluation);
  add_sensor_options(*command, options->sensor);
  add_search_options(*command, options->search);
  add_map_option(*command, *options);
  add_recorded_robot_options(*command, options->robot);
  command->footer(
      "Examples:\n"
      "  depthgrid distances ../shared/data/kinect3_ball --point hand=0.1,2.6,1.2 --in floor --frames 0:80:8\n"
      "  depthgrid distances rig.json --cameras cam1,cam3 --principal cam3 --points points.csv \\\n"
      "      --sensor kinect_v1 --format jsonl --output distances.jsonl\n"
      "  depthgrid distances ../shared/data/kinect3_ball --point=-0.2,-0.8,2.9,0.05 --frames 0:80:8 \\\n"
      "      --method search --sensor kinect_v1 --margin-translation 0.05 --v-max 2 --box=-3,-3,0.5,3,3,6 \\\n"
      "      --unobserved obstacle --outside ignored --robot-pockets obstacle\n"
      "  depthgrid distances arm/ --urdf arm.urdf --joints joints.csv --base 0,0,0.8 --robot-padding 0.04 \\\n"
      "      --method search --sensor realsense_d435 --v-max 2 --box=-1,-1,0,1,1,2 --unobserved obstacle \\\n"
      "      --outside ignored --robot-pockets obstacle --pictures pictures\n"
      "One line a frame and point. distance_m is empty (null) where it is not known; see docs/command.md.");
  command->callback([options, command] {
    take_cell_file(*command, *options);
    run(*options);
  });
}

}  // namespace depthgrid::program
