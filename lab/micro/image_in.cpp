// How long a new image takes until the search may use it, one core, on the workload and its noisy variant. Prints a
// table. Every image comes from a buffer of its own and goes to the store's next one, so that what is timed finds its
// memory as a camera's driver would leave it, or colder.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/views/view_store.hpp"
#include "lab/commands.hpp"
#include "lab/measure/clocks.hpp"
#include "lab/measure/samples.hpp"
#include "lab/workload/workload.hpp"
#include "lab/workload/workload_noise.hpp"
#include "report/machine.hpp"

namespace depthgrid::lab {
namespace {

enum class Content { no_robot, robot, noisy_robot };

const char* name_of(Content content) {
  switch (content) {
    case Content::no_robot:
      return "clean, no robot";
    case Content::robot:
      return "clean, robot";
    case Content::noisy_robot:
      return "noisy, robot";
  }
  return "";
}

Rig rig_of_size(int cameras, int width_px, int height_px) {
  Rig rig = workload_rig(cameras);
  for (RigCamera& camera : rig.cameras) {
    const double scale = static_cast<double>(width_px) / camera.intrinsics.width_px;
    camera.intrinsics = {
        width_px,       height_px,      scale * camera.intrinsics.fx_px, scale * camera.intrinsics.fy_px,
        0.5 * width_px, 0.5 * height_px};
  }
  return rig;
}

views::Settings settings_for(std::size_t cameras, double smallest_obstacle_m) {
  views::Settings settings;
  settings.space = views::BoxSpace{{-1.5, -1.5, 0}, {1.5, 1.5, 2}};
  settings.policies = {views::Policy::obstacle, views::Policy::ignored, views::Policy::obstacle, 0};
  settings.margins.resize(cameras);
  for (auto& margins : settings.margins) {
    margins.sensor = noise_margin();
    margins.sensor.lateral_px = 1;
    margins.smallest_obstacle_m = smallest_obstacle_m;
  }
  settings.v_max_m_s = 1.6;
  return settings;
}

/// Each camera's images in turn; the snapshot of the frame set before is held, as by a thread that asks.
Samples measure(const Rig& rig, int frame_sets, int repetitions,
                const std::function<std::span<const Frame>(int)>& frames, bool with_robot, double smallest_obstacle_m) {
  views::ViewStore store(rig, settings_for(rig.cameras.size(), smallest_obstacle_m));
  std::optional<views::Snapshot> held;
  Samples times_ms;
  for (int repetition = -1; repetition < repetitions; ++repetition) {
    for (int set = 0; set < frame_sets; ++set) {
      for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
        Frame frame = frames(set)[k];
        frame.robot = with_robot ? frame.robot : RobotView{};
        const Stopwatch watch;
        const FrameUpdate update = store.update(k, frame);
        const double elapsed_ms = 1e3 * watch.elapsed_s();
        if (!update.taken()) {
          fail("a frame was not taken: ", update.reason);
        }
        if (repetition >= 0) {
          times_ms.add(elapsed_ms);
        }
      }
      held.emplace(store.snapshot());
    }
  }
  return times_ms;
}

struct ImageInOptions {
  int cameras = kWorkloadCameras;
  int sets = 4;
  int repetitions = 100;
  double smallest_obstacle_m = 0;
};

void measure_size(int width_px, int height_px, const ImageInOptions& options) {
  const int cameras = options.cameras;
  const int frame_sets = options.sets;
  const int repetitions = options.repetitions;
  const Rig rig = rig_of_size(cameras, width_px, height_px);
  const Workload clean(rig, frame_sets, kWorkloadRobotPadding);
  const Workload padded(rig, frame_sets, kNoisyRobotPadding);
  const NoisyWorkload noisy(padded);
  for (const int count : {1, 2, cameras}) {
    Rig part = rig;
    part.cameras.resize(static_cast<std::size_t>(std::min(count, cameras)));
    for (const Content content : {Content::no_robot, Content::robot, Content::noisy_robot}) {
      const bool noise = content == Content::noisy_robot;
      const Samples times_ms = measure(
          part, frame_sets, repetitions * cameras / count,
          [&](int set) { return noise ? noisy.frames(set) : clean.frames(set); }, content != Content::no_robot,
          options.smallest_obstacle_m);
      std::printf("| %d x %d | %d | %s | %.3f | %.3f | %.3f |\n", width_px, height_px, count, name_of(content),
                  times_ms.median(), times_ms.quantile(0.999), times_ms.largest());
      std::fflush(stdout);
    }
  }
}

}  // namespace

void add_image_in_command(CLI::App& app) {
  const auto options = std::make_shared<ImageInOptions>();
  CLI::App* const command = app.add_subcommand(
      "image-in", "time of one image from the camera's buffer to being ready for the search, one core: a minute");
  command->add_option("--cameras", options->cameras, "most cameras")
      ->check(CLI::Range(1, kWorkloadCameras))
      ->capture_default_str();
  command->add_option("--frame-sets", options->sets, "frame sets rendered")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--repetitions", options->repetitions, "how often the frame sets are taken in")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--smallest-obstacle", options->smallest_obstacle_m, "smallest obstacle, metres")
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str();
  command->callback([options] {
    std::cout << report::machine_line() << "\n\n"
              << "| image | cameras | content | median ms | 99.9 % | maximum |\n|---|---|---|---|---|---|\n"
              << std::flush;
    measure_size(640, 480, *options);
    measure_size(1280, 720, *options);
  });
}

}  // namespace depthgrid::lab
