// Distances on real recordings: writes docs/recordings.md and its pictures, with one command.
//
//   DEPTHGRID_DATA=../shared/data build/release/bin/depthgrid-lab recordings
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/files/recording.hpp"
#include "depthgrid/files/text_file.hpp"
#include "depthgrid/grid/grid_evaluator.hpp"
#include "lab/commands.hpp"
#include "lab/measure/recording_folder.hpp"
#include "lab/recordings/ball_search.hpp"
#include "lab/recordings/ball_study.hpp"
#include "lab/recordings/ball_tables.hpp"
#include "lab/recordings/ball_time.hpp"
#include "lab/recordings/kitchen_study.hpp"
#include "lab/recordings/left_out_study.hpp"
#include "program/distances/frame_picture.hpp"
#include "program/frame_selection.hpp"
#include "program/output_file.hpp"
#include "report/machine.hpp"
#include "report/progress_line.hpp"

namespace depthgrid::lab {
namespace {

struct RecordingsOptions {
  std::string frames = "0:80:8";
  std::string picture = "docs/images/kinect3_ball.png";
  std::string left_out_picture = "docs/images/leave-one-out.png";
  int left_out_frame = 32;
  int stride = 8;
  bool times = false;
  std::string output = "docs/recordings.md";
  std::string text = "lab/recordings/recordings.in.md";
};

void replace(std::string& text, const std::string& place, const std::string& by) {
  const auto at = text.find(place);
  if (at == std::string::npos) {
    fail("the text has no place ", place);
  }
  text.replace(at, place.size(), by);
}

/// One frame with the answers of all cameras to the points at 0.4 m and more around the ball.
void save_picture(const RecordingsOptions& options, files::Recording& recording, const BallTrack& track, int index) {
  const Rig& rig = recording.rig();
  const int number = recording.frame_number(index);
  const auto setting = ball_settings().at(1);
  grid::GridEvaluator evaluator(rig, 0, ball_cells(), setting.evaluation);
  const auto frames = recording.read(index);
  (void)update_all(evaluator, frames);
  const Pose T_floor_world = rig.T_floor_world.value_or(Pose::Identity());
  std::vector<program::PictureLine> lines;
  for (const auto& p_floor : points_around(T_floor_world * track.centre_world.at(number))) {
    const Eigen::Vector3d p_world = T_floor_world.inverse() * p_floor;
    lines.push_back({p_world, evaluator.distance(Capsule::point(p_world)).nearest});
  }
  program::save_frame_picture(options.picture,
                              "kinect3_ball, frame " + std::to_string(number) + ": " + setting.name + ", three cameras",
                              rig, frames, lines, setting.evaluation.rho_m);
}

void run(const RecordingsOptions& options) {
  const auto folder = recording_folder("kinect3_ball");
  if (!std::filesystem::exists(folder / "rig.json")) {
    fail("the recording ", folder.string(), " is absent; set DEPTHGRID_DATA to the folder that holds kinect3_ball");
  }
  files::Recording recording(folder);
  const auto track = load_ball_track(folder / "ball.json");
  if (options.times) {
    std::cout << ball_time_table(recording, track) << "\n\nOn: " << report::machine_line() << '\n';
    return;
  }
  std::vector<int> frames = program::select_frames(options.frames, recording.frame_number(0), recording.frame_count());
  for (int& frame : frames) {
    frame -= recording.frame_number(0);
  }
  BallStudy study;
  {
    report::ProgressLine progress("kinect3_ball, frame", frames.size());
    study = study_ball(recording, track, frames, ball_settings(),
                       [&](std::size_t done, std::size_t) { progress.update(done); });
  }
  save_picture(options, recording, track, frames.front());
  std::string text = files::read_text_file(options.text);
  replace(text, "@BALL_FRAME_LIST@", options.frames.empty() ? "all" : options.frames);
  replace(text, "@BALL_FRAMES@", std::to_string(study.frames));
  replace(text, "@BALL_POINTS@", std::to_string(study.points_per_frame));
  replace(text, "@BALL_TABLES@", ball_tables(study, recording.rig()));
  replace(text, "@KITCHEN_TABLES@", kitchen_tables());
  replace(text, "@SEARCH_TABLES@", ball_search_tables(study_ball_search(recording, track, frames)));
  replace(text, "@BALL_TIMES@", ball_time_table(recording, track));
  replace(text, "@STRIDE@", std::to_string(options.stride));
  replace(text, "@LEFT_OUT_TABLES@", left_out_tables(ball_leave_one_out(recording, frames, options.stride)));
  replace(text, "@KITCHEN_LEFT_OUT_TABLES@", left_out_tables(kitchen_leave_one_out(options.stride)));
  save_left_out_picture(options.left_out_picture, recording, frames,
                        options.left_out_frame - recording.frame_number(0));
  replace(text, "@MACHINE@", report::machine_line());
  program::OutputFile output(options.output);
  output.write(text);
  output.commit();
}

}  // namespace

void add_recordings_command(CLI::App& app) {
  const auto options = std::make_shared<RecordingsOptions>();
  CLI::App* const command = app.add_subcommand(
      "recordings",
      "distances on the recordings kinect3_ball and redkitchen_poses, as docs/recordings.md: some minutes");
  command->add_option("--frames", options->frames, "frames of kinect3_ball, first:last:step")->capture_default_str();
  command->add_option("--picture", options->picture, "picture to write")->capture_default_str();
  command->add_option("--left-out-picture", options->left_out_picture, "picture of the cameras left out")
      ->capture_default_str();
  command->add_option("--left-out-frame", options->left_out_frame, "its frame")->capture_default_str();
  command->add_option("--stride", options->stride, "leave one out: every n-th pixel of every n-th row")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command->add_option("--output", options->output, "file to write, - for standard output")->capture_default_str();
  command->add_option("--text", options->text, "text with places for the tables, from the repository's root")
      ->capture_default_str();
  command->add_flag("--times", options->times, "only print how long the search takes on kinect3_ball: some seconds");
  command->callback([options] { run(*options); });
}

}  // namespace depthgrid::lab
