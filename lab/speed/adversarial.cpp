#include <algorithm>
#include <random>

#include "lab/speed/calls.hpp"
#include "lab/speed/our_figures.hpp"

namespace depthgrid::lab {
namespace {

/// One image a camera without a scene: each pixel is what `pixel` says, in millimetres.
struct ImageSet {
  template <class Pixel>
  ImageSet(const Rig& rig, Pixel pixel) {
    for (const RigCamera& camera : rig.cameras) {
      const int width_px = camera.intrinsics.width_px;
      const int height_px = camera.intrinsics.height_px;
      auto& image = images.emplace_back(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px));
      std::generate(image.begin(), image.end(), [&pixel] { return static_cast<std::uint16_t>(pixel()); });
      frames.push_back({depth_view(std::span<const std::uint16_t>(image), width_px, height_px, 0.001), {}, 0.0});
    }
  }
  std::vector<std::vector<std::uint16_t>> images;
  std::vector<Frame> frames;
};

}  // namespace

void measure_adversarial(Stage& stage, const OurPlan& plan, Report& report) {
  PeerSetting setting = stage.setting();
  setting.sensor.lateral_px = 1;
  SearchPeer ours(setting, kResolution);
  // Images of the same size without a scene; no robot.
  std::mt19937_64 generator(3);
  const ImageSet random(stage.rig(), [&generator] { return 500 + generator() % 3500; });
  const ImageSet holes(stage.rig(), [&generator] { return generator() % 100 == 0 ? 0 : 6000; });
  const ImageSet nothing(stage.rig(), [] { return 0; });
  std::vector<Eigen::Vector3d> at_cameras;
  for (std::size_t i = 0; i < kWorkloadControlPoints; ++i) {
    // As near to the camera as the cell allows: those of the workload stand outside of it.
    const Region cell = workload_cell();
    const Eigen::Vector3d centre = stage.rig().cameras[i % stage.rig().cameras.size()].T_world_camera.translation();
    at_cameras.push_back(centre.cwiseMax(cell.low_world).cwiseMin(cell.high_world));
  }
  struct Case {
    const char* name;
    std::span<const Frame> frames;
    std::vector<Eigen::Vector3d> points;
  };
  const std::vector<Case> cases{
      {"every pixel at random", random.frames, stage.points(0, 0)},
      {"free but for one pixel in a hundred", holes.frames, stage.points(0, 0)},
      {"nothing measured", nothing.frames, stage.points(0, 0)},
      {"points at the cameras", stage.frames(0), at_cameras},
      {"nothing within rho", stage.frames(0), stage.far_points(0)},
  };
  for (const Case& one : cases) {
    if (one.points.size() < kWorkloadControlPoints) {
      continue;
    }
    for (const double budget_s : {0.0, 0.0003}) {
      ours.prepare(one.frames, stage.arm_region());
      Calls calls;
      const Stopwatch watch;
      for (int i = 0; i < 3 || (i < plan.repetitions / 4 && watch.elapsed_s() < 0.2 * plan.limit_s); ++i) {
        calls.ask(ours, as_points(one.points), false, i == 0,
                  {{}, budget_s > 0 ? std::optional(budget_s) : std::nullopt});
      }
      Record record = calls.record("adversarial", one.name, stage.cameras());
      record.numbers["budget_s"] = budget_s;
      report.records.push_back(std::move(record));
    }
  }
}

}  // namespace depthgrid::lab
