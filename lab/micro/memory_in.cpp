// How long the memory takes for a new image, one core, on the workload and its noisy variant: 640x480, cameras in turn,
// time running on. Prints a table.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <functional>
#include <iostream>
#include <memory>
#include <span>

#include "depthgrid/core/error.hpp"
#include "depthgrid/memory/memory_store.hpp"
#include "depthgrid/memory/voxel_set.hpp"
#include "depthgrid/views/view_store.hpp"
#include "lab/commands.hpp"
#include "lab/measure/clocks.hpp"
#include "lab/measure/samples.hpp"
#include "lab/workload/workload.hpp"
#include "lab/workload/workload_noise.hpp"
#include "report/machine.hpp"

namespace depthgrid::lab {
namespace {

struct Region {
  const char* name;
  Eigen::Vector3d low_world, high_world;
};

const Region kCell{"cell, 3 x 3 x 2 m", {-1.5, -1.5, 0}, {1.5, 1.5, 2}};
const Region kArm{"arm, 1.2 m cube", {-0.6, -0.6, 0.7}, {0.6, 0.6, 1.9}};

views::Settings settings_for(std::size_t cameras, bool noise) {
  views::Settings settings;
  settings.space = views::BoxSpace{{-1.5, -1.5, 0}, {1.5, 1.5, 2}};
  settings.policies = {views::Policy::obstacle, views::Policy::ignored, views::Policy::obstacle, 0};
  settings.margins.resize(cameras);
  for (CameraMargins& margins : settings.margins) {
    margins.sensor = noise ? noise_margin() : SensorMargin{0.001, 0, 0, 0};
    margins.smallest_obstacle_m = noise ? 0.05 : 0.0;
    margins.translation_m = noise ? 0.005 : 0.0;
    margins.half_exposure_s = 0.008;
  }
  settings.v_max_m_s = 1.6;
  return settings;
}

/// Frame sets forwards and backwards, so that nothing jumps.
void measure(const Rig& rig, int frame_sets, int passes, const std::function<std::span<const Frame>(int)>& frames,
             const Region& region, bool noise) {
  views::ViewStore views(rig, settings_for(rig.cameras.size(), noise), 4);
  memory::MemorySettings settings;
  settings.low_world = region.low_world;
  settings.high_world = region.high_world;
  settings.start = memory::StartUnknown{};
  memory::MemoryStore store(views, settings);
  Samples times_ms;
  double time_s = 0;
  for (int pass = 0; pass <= passes; ++pass) {
    for (int n = 0; n < frame_sets; ++n) {
      const int set = pass % 2 == 0 ? n : frame_sets - 1 - n;
      for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
        time_s += 1 / kWorkloadRate / static_cast<double>(rig.cameras.size());
        Frame frame = frames(set)[k];
        frame.time_s = time_s;
        if (const FrameUpdate update = views.update(k, frame); !update.taken()) {
          fail("a frame was not taken: ", update.reason);
        }
        const double elapsed_s = timed_s([&] { store.take(k); });
        if (pass > 0) {
          times_ms.add(1e3 * elapsed_s);
        }
      }
    }
  }
  const memory::MemorySnapshot memory = store.snapshot();
  const auto& voxels = memory.voxels().voxels();
  std::printf("| %s | %zu | %s | %.0f %% | %.3f | %.3f | %.3f |\n", region.name, rig.cameras.size(),
              noise ? "noisy" : "clean",
              100.0 * static_cast<double>(memory.voxels().count()) / (double{1} * voxels[0] * voxels[1] * voxels[2]),
              times_ms.median(), times_ms.quantile(0.99), times_ms.largest());
  std::fflush(stdout);
}

struct MemoryInOptions {
  int cameras = 4;
  int sets = 10;
  int passes = 10;
};

}  // namespace

void add_memory_in_command(CLI::App& app) {
  const auto options = std::make_shared<MemoryInOptions>();
  CLI::App* const command =
      app.add_subcommand("memory-in", "time of one image in the memory of what may be where, one core: half a minute");
  command->add_option("--cameras", options->cameras, "most cameras")
      ->check(CLI::Range(1, kWorkloadCameras))
      ->capture_default_str();
  command->add_option("--frame-sets", options->sets, "frame sets rendered")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--passes", options->passes, "how often the frame sets are taken in, forwards and backwards")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->callback([options] {
    std::cout << report::machine_line() << "\n\n"
              << "| region | cameras | content | voxels set at the end | median ms | 99 % | maximum |\n"
              << "|---|---|---|---|---|---|---|\n"
              << std::flush;
    const Rig rig = workload_rig(options->cameras);
    const Workload clean(rig, options->sets, kWorkloadRobotPadding);
    const Workload padded(rig, options->sets, kNoisyRobotPadding);
    const NoisyWorkload noisy(padded);
    for (const int count : {2, options->cameras}) {
      Rig part = rig;
      part.cameras.resize(static_cast<std::size_t>(std::min(count, options->cameras)));
      for (const Region& region : {kCell, kArm}) {
        for (const bool noise : {false, true}) {
          measure(
              part, options->sets, options->passes,
              [&](int set) { return noise ? noisy.frames(set) : clean.frames(set); }, region, noise);
        }
      }
    }
  });
}

}  // namespace depthgrid::lab
