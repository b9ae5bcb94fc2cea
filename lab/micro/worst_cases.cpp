// The search where it is slowest: noise, everything hidden, points in obstacles and on cameras; with and without a
// budget. Writes a Markdown table to standard output; docs/worst-cases.md is what it printed.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "depthgrid/search/search.hpp"
#include "lab/commands.hpp"
#include "lab/measure/clocks.hpp"
#include "lab/micro/hard_images.hpp"
#include "lab/workload/workload.hpp"
#include "report/machine.hpp"

namespace depthgrid::lab {
namespace {

constexpr int kRepetitions = 5;
constexpr std::size_t kPixels = 640UL * 480UL;

/// The slowest that `worst-cases --hunt` found in ten minutes each.
constexpr std::array<const char*, 1> kFoundScenes{
    "seed=413 cameras=8.31486 wall_m=6 tilt_m=0 stripe_px=5.12586 stripe_m=5.00463 speck_share=0.00438726 speck_px=1 "
    "speck_near_m=0.842607 speck_far_m=4.3927 noise_m=0.04147 missing_share=0 pose_error_m=0.0235529"};

struct HardScene {
  std::string name;
  /// Depth in millimetres of a pixel of camera k.
  std::function<std::uint16_t(std::mt19937&, int k, int u, int v)> depth_mm;
};

struct Case {
  double first_ms = 0;     ///< the first call after the images
  double later_ms = 0;     ///< the longest of the others
  std::int64_t cubes = 0;  ///< that the first opens
  int unfinished = 0;
  double mean_m = 0;
};

Case run(const views::ViewStore& store, const std::vector<Capsule>& points, const search::Budget& budget) {
  search::Search searcher;
  std::vector<Answer> answers(points.size());
  const views::Snapshot snapshot = store.snapshot();
  Case result;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    search::Count count;
    const Stopwatch watch;
    searcher.distances(snapshot, points, answers, budget, &count);
    const double time_ms = 1e3 * watch.elapsed_s();
    if (repetition == 0) {
      result.first_ms = time_ms;
      result.cubes = count.nodes;
    } else {
      result.later_ms = std::max(result.later_ms, time_ms);
    }
  }
  for (const Answer& answer : answers) {
    result.unfinished += answer.nearest.budget ? 1 : 0;
    result.mean_m += answer.nearest.distance_m / static_cast<double>(answers.size());
  }
  return result;
}

void write_row(const std::string& scene, bool at_camera, double pose_error_m, const HardImages& hard) {
  const auto store = stored(hard);
  const std::vector<Capsule> on_camera(9, Capsule::point(hard.rig.cameras[0].T_world_camera.translation()));
  const std::vector<Capsule> points = at_camera ? on_camera : nine_on_arm();
  const Case whole = run(*store, points, {});
  search::Budget tight;
  tight.nodes = 2000;
  const Case cut = run(*store, points, tight);
  std::printf("| %s | %s | %zu | %.1f cm | %lld | %.2f | %.2f | %.2f | %d of 9 | %.3f of %.3f m |\n", scene.c_str(),
              at_camera ? "on a camera" : "on the arm", hard.images.size(), 100 * pose_error_m,
              static_cast<long long>(whole.cubes), whole.first_ms, whole.later_ms, cut.first_ms, cut.unfinished,
              cut.mean_m, whole.mean_m);
  std::fflush(stdout);
}

void write_table() {
  const auto checker = [](std::mt19937&, int, int u, int v) -> std::uint16_t {
    return (u / 2 + v / 2) % 2 == 0 ? 3500 : 1500;
  };
  const std::vector<HardScene> scenes{
      {"uniform noise, 0.5 to 4.5 m",
       [](std::mt19937& g, int, int, int) { return static_cast<std::uint16_t>(500 + g() % 4000); }},
      {"4 m, every 200th pixel at random",
       [](std::mt19937& g, int, int, int) {
         return static_cast<std::uint16_t>(g() % 200 == 0 ? 500 + g() % 3500 : 4000);
       }},
      {"2 x 2 pixel checkerboard, 1.5 and 3.5 m", checker},
      {"nothing measured", [](std::mt19937&, int, int, int) { return std::uint16_t{0}; }},
      {"a wall 0.4 m before each camera", [](std::mt19937&, int, int, int) { return std::uint16_t{400}; }},
      {"nothing within 4 m", [](std::mt19937&, int, int, int) { return std::uint16_t{4000}; }},
  };
  std::printf(
      "| scene | points | cameras | e | cubes | first call, ms | later calls, ms | with 2,000 cubes: ms | unfinished | "
      "mean D, of that bound |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|---|\n");
  for (const int cameras : {2, 8}) {
    HardImages hard{workload_rig(cameras), {}, {}};
    for (const HardScene& scene : scenes) {
      std::mt19937 generator(7);
      hard.images.assign(static_cast<std::size_t>(cameras), std::vector<std::uint16_t>(kPixels));
      for (int k = 0; k < cameras; ++k) {
        auto& image = hard.images[static_cast<std::size_t>(k)];
        for (std::size_t i = 0; i < kPixels; ++i) {
          image[i] = scene.depth_mm(generator, k, static_cast<int>(i % 640), static_cast<int>(i / 640));
        }
      }
      for (const double pose_error_m : {0.0, 0.02}) {
        hard.settings = hard_settings(cameras, pose_error_m);
        write_row(scene.name, false, pose_error_m, hard);
        if (scene.name == scenes.back().name) {  // in the blind zone all scenes are the same
          hard.settings.space = views::BoxSpace{{-4, -4, -1}, {4, 4, 4}};
          write_row(scene.name, true, pose_error_m, hard);
        }
      }
    }
  }
  for (const char* const found : kFoundScenes) {
    const SlowScene scene = scene_from_text(found);
    write_row("found by `--hunt`", false, scene.pose_error_m, hard_images(scene));
  }
  std::printf("\nOn: %s\n", report::machine_line().c_str());
}

}  // namespace

void add_worst_cases_command(CLI::App& app) {
  struct Options {
    double hunt_s = 0;
    std::uint64_t seed = 1;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand(
      "worst-cases", "the search where it is slowest, the table of docs/worst-cases.md: some seconds");
  command
      ->add_option("--hunt", options->hunt_s,
                   "instead, look so many seconds for slow scenes by mutation; print the slowest")
      ->check(CLI::Range(1.0, 36000.0));
  command->add_option("--seed", options->seed, "of the mutations");
  command->callback(
      [options] { options->hunt_s > 0 ? hunt_slow_scenes(options->hunt_s, options->seed) : write_table(); });
}

}  // namespace depthgrid::lab
