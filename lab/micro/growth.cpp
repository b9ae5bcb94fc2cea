// How the search's time grows: with the points of a call, the cameras, rho, the resolution and the size of the images.
// Writes Markdown tables to standard output; docs/growth.md is what it printed.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "depthgrid/search/search.hpp"
#include "lab/commands.hpp"
#include "lab/measure/clocks.hpp"
#include "lab/measure/samples.hpp"
#include "lab/workload/workload.hpp"
#include "lab/workload/workload_noise.hpp"
#include "report/machine.hpp"

namespace depthgrid::lab {
namespace {

constexpr int kLater = 10;  ///< calls after the first of a frame set

/// One row.
struct Setup {
  int cameras = 2;
  int width_px = 640;
  int height_px = 480;
  std::size_t points = kWorkloadControlPoints;
  double rho_m = 0.4;
  double resolution_m = 0.005;
};

struct Times {
  Samples image_ms;
  Samples first_ms;
  Samples later_ms;
};

Rig rig_for(const Setup& setup) {
  Rig rig = workload_rig(setup.cameras);
  for (RigCamera& camera : rig.cameras) {
    const double scale = static_cast<double>(setup.width_px) / camera.intrinsics.width_px;
    camera.intrinsics = {
        setup.width_px,       setup.height_px,      scale * camera.intrinsics.fx_px, scale * camera.intrinsics.fy_px,
        0.5 * setup.width_px, 0.5 * setup.height_px};
  }
  return rig;
}

views::Settings settings_for(const Setup& setup, bool noisy) {
  views::Settings settings;
  settings.space = views::BoxSpace{{-1.5, -1.5, 0}, {1.5, 1.5, 2}};
  settings.policies = {views::Policy::obstacle, views::Policy::ignored, views::Policy::obstacle, 0};
  settings.margins.resize(static_cast<std::size_t>(setup.cameras));
  for (CameraMargins& margins : settings.margins) {
    margins.sensor = noisy ? noise_margin() : SensorMargin{};
    margins.sensor.lateral_px = 1;
    margins.translation_m = noisy ? 0.005 : 0;
    margins.rotation_rad = noisy ? 0.001 : 0;
    margins.smallest_obstacle_m = 0;
  }
  settings.v_max_m_s = 0;
  settings.rho_m = setup.rho_m;
  settings.resolution_m = setup.resolution_m;
  return settings;
}

/// The images of one rig, clean and noisy: rendered once for many rows.
class Scene {
 public:
  Scene(const Rig& rig, int frame_sets)
      : clean_(rig, frame_sets, kWorkloadRobotPadding), padded_(rig, frame_sets, kNoisyRobotPadding), noisy_(padded_) {}

  [[nodiscard]] Times measure(const Setup& setup, bool noisy) const {
    Times times;
    views::ViewStore store(clean_.rig(), settings_for(setup, noisy));
    search::Search search;
    std::vector<Capsule> capsules(setup.points);
    std::vector<Answer> answers(setup.points);
    for (int set = 0; set < clean_.frame_sets(); ++set) {
      const std::span<const Frame> frames = noisy ? noisy_.frames(set) : clean_.frames(set);
      for (std::size_t k = 0; k < frames.size(); ++k) {
        times.image_ms.add(1e3 * timed_s([&] { static_cast<void>(store.update(k, frames[k])); }));
      }
      const views::Snapshot snapshot = store.snapshot();
      for (int i = 0; i <= kLater; ++i) {
        const auto points =
            random_workload_points(Workload::time_s(set), setup.points, static_cast<std::uint64_t>(1000 * set + i + 1));
        std::transform(points.begin(), points.end(), capsules.begin(), Capsule::point);
        const double time_ms = 1e3 * timed_s([&] { search.distances(snapshot, capsules, answers); });
        (i == 0 ? times.first_ms : times.later_ms).add(time_ms);
      }
    }
    return times;
  }

 private:
  Workload clean_;
  Workload padded_;
  NoisyWorkload noisy_;
};

class Table {
 public:
  explicit Table(const char* what) {
    std::printf(
        "\n## %s\n\n| %s | W: image in, ms | first call | later, median | later, worst | noisy: image in, ms | first "
        "call | "
        "later, median | later, worst |\n|---|---|---|---|---|---|---|---|---|\n",
        what, what);
  }
  // NOLINTNEXTLINE(readability-convert-member-functions-to-static): a table's row
  void row(const std::string& value, const Scene& scene, const Setup& setup) const {
    std::printf("| %s |", value.c_str());
    for (const bool noisy : {false, true}) {
      const Times times = scene.measure(setup, noisy);
      std::printf(" %.3f | %.3f | %.4f | %.3f |", times.image_ms.median(), times.first_ms.median(),
                  times.later_ms.median(), times.later_ms.largest());
    }
    std::printf("\n");
    std::fflush(stdout);
  }
};

void write_tables(int frame_sets) {
  std::printf("On: %s\n", report::machine_line().c_str());
  const Scene two(rig_for({}), frame_sets);
  const Table points("points a call");
  for (const std::size_t count : {1U, 10U, 100U, 1000U, 10000U}) {
    Setup setup;
    setup.points = count;
    points.row(std::to_string(count), two, setup);
  }
  const Table rho("rho");
  for (const int centimetres : {10, 20, 40, 60, 80}) {
    Setup setup;
    setup.rho_m = 0.01 * centimetres;
    rho.row(std::to_string(centimetres) + " cm", two, setup);
  }
  const Table resolution("resolution");
  for (const int millimetres : {2, 3, 5, 10, 20, 40}) {
    Setup setup;
    setup.resolution_m = 0.001 * millimetres;
    resolution.row(std::to_string(millimetres) + " mm", two, setup);
  }
  const Table cameras("cameras");
  for (const int count : {1, 2, 4, 8}) {
    Setup setup;
    setup.cameras = count;
    cameras.row(std::to_string(count), Scene(rig_for(setup), frame_sets), setup);
  }
  const Table size("image");
  for (const auto& [width_px, height_px] : {std::pair{320, 240}, {640, 480}, {848, 480}, {1280, 720}}) {
    Setup setup;
    setup.width_px = width_px;
    setup.height_px = height_px;
    size.row(std::to_string(width_px) + " x " + std::to_string(height_px), Scene(rig_for(setup), frame_sets), setup);
  }
}

}  // namespace

void add_growth_command(CLI::App& app) {
  const auto frame_sets = std::make_shared<int>(6);
  CLI::App* const command =
      app.add_subcommand("growth", "how the search's time grows, the tables of docs/growth.md: a minute");
  command->add_option("--frame-sets", *frame_sets, "frame sets rendered")
      ->check(CLI::Range(1, kWorkloadFrameSets))
      ->capture_default_str();
  command->callback([frame_sets] { write_tables(*frame_sets); });
}

}  // namespace depthgrid::lab
