// How long a new image takes until the search may use it, one core, on the workload and its noisy variant. Prints a
// table. Every image comes from a buffer of its own and goes to the store's next one, so that what is timed finds its
// memory as a camera's driver would leave it, or colder.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <iostream>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "depthgrid/views/view_store.hpp"
#include "lab/machine.hpp"
#include "lab/workload/workload.hpp"
#include "lab/workload/workload_noise.hpp"

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

views::Settings settings_for(std::size_t cameras) {
  views::Settings settings;
  settings.space = views::BoxSpace{{-1.5, -1.5, 0}, {1.5, 1.5, 2}};
  settings.policies = {views::Policy::obstacle, views::Policy::ignored, views::Policy::obstacle, 0};
  settings.margins.resize(cameras);
  for (auto& margins : settings.margins) {
    margins.sensor = noise_margin();
    margins.sensor.lateral_px = 1;
  }
  settings.v_max_m_s = 1.6;
  return settings;
}

struct Row {
  double median_ms, p999_ms, largest_ms;
};

/// Each camera's images in turn; the snapshot of the frame set before is held, as by a thread that asks.
Row measure(const Rig& rig, int frame_sets, int repetitions, const std::function<std::span<const Frame>(int)>& frames,
            bool with_robot) {
  views::ViewStore store(rig, settings_for(rig.cameras.size()));
  std::optional<views::Snapshot> held;
  std::vector<double> times_ms;
  for (int repetition = -1; repetition < repetitions; ++repetition) {
    for (int set = 0; set < frame_sets; ++set) {
      for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
        Frame frame = frames(set)[k];
        frame.robot = with_robot ? frame.robot : RobotView{};
        const auto start = std::chrono::steady_clock::now();
        const views::UpdateResult result = store.update(k, frame);
        const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
        if (result != views::UpdateResult::taken) {
          throw std::runtime_error("a frame was not taken");
        }
        if (repetition >= 0) {
          times_ms.push_back(elapsed.count());
        }
      }
      held.emplace(store.snapshot());
    }
  }
  std::sort(times_ms.begin(), times_ms.end());
  const auto at = [&](double part) {
    return times_ms[static_cast<std::size_t>(part * static_cast<double>(times_ms.size() - 1))];
  };
  return {at(0.5), at(0.999), times_ms.back()};
}

void measure_size(int width_px, int height_px, int cameras, int frame_sets, int repetitions) {
  std::fprintf(stderr, "rendering %d x %d\n", width_px, height_px);
  const Rig rig = rig_of_size(cameras, width_px, height_px);
  const Workload clean(rig, frame_sets, kWorkloadRobotPadding);
  const Workload padded(rig, frame_sets, kNoisyRobotPadding);
  const NoisyWorkload noisy(padded);
  for (const int count : {1, 2, cameras}) {
    Rig part = rig;
    part.cameras.resize(static_cast<std::size_t>(std::min(count, cameras)));
    for (const Content content : {Content::no_robot, Content::robot, Content::noisy_robot}) {
      const bool noise = content == Content::noisy_robot;
      const Row row = measure(
          part, frame_sets, repetitions * cameras / count,
          [&](int set) { return noise ? noisy.frames(set) : clean.frames(set); }, content != Content::no_robot);
      std::printf("| %d x %d | %d | %s | %.3f | %.3f | %.3f |\n", width_px, height_px, count, name_of(content),
                  row.median_ms, row.p999_ms, row.largest_ms);
      std::fflush(stdout);
    }
  }
}

}  // namespace
}  // namespace depthgrid::lab

int main(int argc, char** argv) {
  using namespace depthgrid;
  CLI::App app{"Time of one image from the camera's buffer to being ready for the search, one core."};
  int cameras = lab::kWorkloadCameras;
  int sets = 4;
  int repetitions = 100;
  app.add_option("--cameras", cameras, "most cameras")->check(CLI::Range(1, lab::kWorkloadCameras));
  app.add_option("--frame-sets", sets, "frame sets rendered")->check(CLI::Range(1, 1000))->capture_default_str();
  app.add_option("--repetitions", repetitions, "how often the frame sets are taken in")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    std::cout << lab::machine_line() << "\n\n"
              << "| image | cameras | content | median ms | 99.9 % | maximum |\n|---|---|---|---|---|---|\n"
              << std::flush;
    lab::measure_size(640, 480, cameras, sets, repetitions);
    lab::measure_size(1280, 720, cameras, sets, repetitions);
  } catch (const std::exception& error) {
    std::cerr << "depthgrid_image_in: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
