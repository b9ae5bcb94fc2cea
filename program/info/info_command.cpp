#include "program/info/info_command.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "depthgrid/cell/cell_file.hpp"
#include "depthgrid/files/recording.hpp"
#include "program/cell_arguments.hpp"
#include "program/frame_selection.hpp"
#include "program/info/agreement.hpp"
#include "program/info/clamped_readings.hpp"
#include "program/info/hole_picture.hpp"
#include "program/info/info_report.hpp"
#include "program/info/surface.hpp"
#include "program/mcap_options.hpp"
#include "program/open_recording.hpp"
#include "program/output_check.hpp"
#include "program/output_file.hpp"
#include "program/usage_error.hpp"
#include "report/progress_line.hpp"

namespace depthgrid::program {

namespace {

struct InfoOptions {
  std::string recording;
  files::McapChoice mcap;
  std::vector<std::string> cameras;
  std::string frames;
  std::optional<double> near_m;
  std::optional<double> far_m;
  double limit_m = 5.0;
  double least_overlap = 0.0;
  int stride_px = 1;
  bool all_pairs = false;
  std::string output = "-";
  std::string hole_picture;
};

/// Holes are looked at in no more frames than this: that takes its time.
constexpr std::size_t kHoleFrames = 10;

/// What the cameras measure on their own.
void survey_images(files::Recording& recording, const std::vector<int>& indices, RecordingInfo& info) {
  report::ProgressLine progress("reading frame", indices.size());
  DepthImage depth;
  std::vector<std::vector<bool>> pixels_read;
  for (std::size_t k = 0; k < info.cameras.size(); ++k) {
    pixels_read.push_back(recording.pixels_read(k));
  }
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const auto frames = recording.read(indices[i]);
    for (std::size_t k = 0; k < frames.size(); ++k) {
      const auto& camera = recording.rig().cameras[k];
      depth = DepthImage(camera.intrinsics.width_px, camera.intrinsics.height_px);
      normalise(frames[k].depth, camera.rule, depth);
      info.cameras[k].clamped += remove_clamped(camera.rule, depth);
      info.cameras[k].add(depth);
      if (i % (indices.size() / kHoleFrames + 1) == 0) {
        info.holes[k].add(frames[k]);
      }
      if (const DepthImage* distorted = recording.distorted(k)) {
        info.cameras[k].add_distorted(*distorted, pixels_read[k]);
      }
    }
    progress.update(i + 1);
  }
}

/// What every ordered pair of cameras agrees on.
void compare_cameras(files::Recording& recording, const std::vector<int>& indices, const InfoOptions& options,
                     RecordingInfo& info) {
  const Rig& rig = recording.rig();
  const std::size_t count = rig.cameras.size();
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = 0; b < count; ++b) {
      if (a != b) {
        info.pairs.push_back({a, b, {}});
      }
    }
  }
  std::vector<SensorMargin> margins;
  for (const auto& camera : info.cameras) {
    margins.push_back(camera.noise.suggested_margin());
  }
  report::ProgressLine progress("comparing pairs of cameras,", indices.size() * info.pairs.size());
  std::vector<Surface> surfaces(count);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const auto frames = recording.read(indices[i]);
    for (std::size_t k = 0; k < count; ++k) {
      const auto& camera = rig.cameras[k];
      DepthImage depth(camera.intrinsics.width_px, camera.intrinsics.height_px);
      normalise(frames[k].depth, camera.rule, depth);
      remove_clamped(camera.rule, depth);
      make_surface(camera.intrinsics, depth, surfaces[k]);
    }
    for (std::size_t n = 0; n < info.pairs.size(); ++n) {
      auto& [a, b, agreement] = info.pairs[n];
      const Pose T_b_a = recording.T_world_camera(indices[i], b).inverse() * recording.T_world_camera(indices[i], a);
      add_pair(surfaces[a], surfaces[b], rig.cameras[b].intrinsics, T_b_a, options.limit_m, options.stride_px,
               margins[a], margins[b], agreement);
      progress.update(i * info.pairs.size() + n + 1);
    }
  }
}

void check(const InfoOptions& options) {
  if (!(options.limit_m > 0)) {
    fail_usage("--limit ", options.limit_m, " must be greater than 0");
  }
  if (!(options.least_overlap >= 0 && options.least_overlap <= 1)) {
    fail_usage("--least-overlap ", options.least_overlap, " must lie in 0 ... 1");
  }
  if (options.stride_px < 1) {
    fail_usage("--stride ", options.stride_px, " must be at least 1");
  }
}

void run(const InfoOptions& options) {
  check(options);
  files::RecordingOptions recording_options;
  recording_options.camera_ids = options.cameras;
  recording_options.near_m = options.near_m;
  recording_options.far_m = options.far_m;
  recording_options.mcap = options.mcap;
  files::Recording recording = open_recording(options.recording, recording_options);
  const std::vector<int> indices = select_frames(options.frames, recording);

  refuse_overwriting({{"--output", options.output}, {"--hole-picture", options.hole_picture}},
                     recording_inputs(recording));

  OutputFile output(options.output);
  RecordingInfo info;
  info.frames_used = static_cast<int>(indices.size());
  info.cameras.resize(recording.rig().cameras.size());
  for (const RigCamera& camera : recording.rig().cameras) {
    info.holes.emplace_back(camera);
  }
  survey_images(recording, indices, info);
  if (recording.simultaneous() || recording.frame_count() == 1) {
    compare_cameras(recording, indices, options, info);
  }
  if (!options.hole_picture.empty()) {
    save_hole_picture(options.hole_picture, recording.rig(), recording.read(indices.front()));
  }
  output.write(to_text(recording, info, {options.limit_m, options.least_overlap, options.all_pairs}));
  output.commit();
}

}  // namespace

void add_info_command(CLI::App& app) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* command = app.add_subcommand("info", "what a recording holds and how well its cameras agree");
  command
      ->add_option("RECORDING", options->recording,
                   "folder with a rig.json, a rig file, an MCAP file of ROS 2, or a cell file of recorded "
                   "cameras, CELL.yaml")
      ->required();
  command->add_option("--cameras", options->cameras, "ids of the cameras to use (default: all)")
      ->delimiter(',')
      ->allow_extra_args(false);
  add_mcap_options(*command, options->mcap);
  command->add_option("--frames", options->frames, "frames: 5, 0:80 (both included), 0:80:8 or 1,4,9 (default: all)");
  command->add_option("--near", options->near_m, "nearest measurable depth, metres");
  command->add_option("--far", options->far_m, "farthest measurable depth, metres");
  command->add_option("--limit", options->limit_m, "compare points up to this depth, metres")->capture_default_str();
  command
      ->add_option(
          "--least-overlap", options->least_overlap,
          "leave out pairs where a smaller share of the first camera's points meets a measurement of the second")
      ->capture_default_str();
  command->add_option("--stride", options->stride_px, "compare every n-th pixel of every n-th row")
      ->capture_default_str();
  command->add_flag("--all-pairs", options->all_pairs, "print every pair, also when there are more than 30");
  command->add_option("--output", options->output, "file to write, - for standard output")->capture_default_str();
  command->add_option("--hole-picture", options->hole_picture,
                      "picture (PNG) of the first frame: what up to four cameras measure, and what that frees without "
                      "and with a smallest obstacle of 2 and 5 cm");
  command->footer(
      "Examples:\n"
      "  depthgrid info ../shared/data/kinect3_ball --frames 0:80:8\n"
      "  depthgrid info ../shared/data/redkitchen_poses --limit 4 --least-overlap 0.25 --stride 2\n"
      "How the figures are taken and what the suggested margins mean stands in docs/command.md.");
  command->callback([options] {
    if (is_cell_file(options->recording)) {
      const CellRecordingChoice choice = recording_of(cell::load_cell(options->recording));
      options->recording = choice.recording;
      options->cameras = options->cameras.empty() ? choice.cameras : options->cameras;
      options->mcap.depth_topics = options->mcap.depth_topics.empty() ? choice.topics : options->mcap.depth_topics;
    }
    run(*options);
  });
}

}  // namespace depthgrid::program
