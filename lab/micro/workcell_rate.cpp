// How fast the simulated workcell runs on one core: depth images by ray casting, sensors, true distances.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "depthgrid/simulation/arrangement.hpp"
#include "depthgrid/simulation/simulated_sensors.hpp"
#include "lab/commands.hpp"
#include "lab/measure/clocks.hpp"
#include "lab/measure/samples.hpp"
#include "lab/workcell/cell_truth.hpp"
#include "lab/workcell/depth_caster.hpp"
#include "lab/workcell/workcell_scene.hpp"
#include "report/machine.hpp"

namespace depthgrid::lab {
namespace {

using simulation::Motion;

constexpr int kFrames = 60;
constexpr double kFrameTime = 0.1;

/// Median milliseconds of a call for each frame: processor time of all threads.
double median_ms(const std::function<void(int)>& frame) {
  Samples times_ms;
  for (int i = 0; i < kFrames; ++i) {
    const double start_s = process_time_s();
    frame(i);
    times_ms.add(1e3 * (process_time_s() - start_s));
  }
  return times_ms.median();
}

void row(const std::string& what, double ms) {
  std::printf("| %-66s | %8.2f | %7.0f |\n", what.c_str(), ms, 1000 / ms);
  std::fflush(stdout);
}

/// Two ideal cameras, all poses new in every frame.
void cast_rows(const char* arm, ArmShape shape, int segments) {
  const Rig rig = simulation::letter_arrangement("ideal").rig;
  WorkcellScene scene(Motion::carry_box, 1, shape, segments);
  workcell::DepthCaster caster(scene.at(0));
  std::vector<DepthImage> images(2);
  workcell::BodyImage bodies;
  const auto two_cameras = [&](int frame) {
    caster.update(scene.at(frame * kFrameTime));
    for (std::size_t k = 0; k < 2; ++k) {
      caster.render(rig.cameras[k].intrinsics, rig.cameras[k].T_world_camera, images[k]);
    }
  };
  row(std::string("two ideal cameras, ") + arm, median_ms(two_cameras));
  row(std::string("  of it new poses, ") + arm,
      median_ms([&](int frame) { caster.update(scene.at(frame * kFrameTime)); }));
  row(std::string("one camera with the body of each pixel, ") + arm, median_ms([&](int) {
        caster.render(rig.cameras[0].intrinsics, rig.cameras[0].T_world_camera, images[0], bodies);
      }));
}

void sensor_row(const char* sensor, std::vector<bool> vibrating) {
  const Rig rig = simulation::letter_arrangement(sensor).rig;
  WorkcellScene scene(Motion::carry_box, 1, ArmShape::capsules);
  const workcell::DepthCaster caster(scene.at(3));
  std::vector<DepthImage> ideal(2);
  std::vector<DepthImage> measured(2);
  for (std::size_t k = 0; k < 2; ++k) {
    caster.render(rig.cameras[k].intrinsics, rig.cameras[k].T_world_camera, ideal[k]);
  }
  simulation::SensorGroupSettings settings;
  settings.vibrating = std::move(vibrating);
  simulation::SimulatedSensors sensors(rig, settings);
  row(std::string("two images of sensor ") + sensor,
      median_ms([&](int frame) { sensors.measure(ideal, static_cast<std::uint64_t>(frame), measured); }));
}

void truth_row(const char* arm, ArmShape shape) {
  using simulation::BodyKind;
  WorkcellScene scene(Motion::carry_box, 1, shape, 32);
  workcell::CellTruth truth(scene.at(0));
  row(std::string("true distance, person and objects to the arm, ") + arm, median_ms([&](int frame) {
        truth.update(scene.at(frame * kFrameTime));
        (void)truth.nearest(BodyKind::robot, {BodyKind::person, BodyKind::object});
      }));
}

void measure_all() {
  std::printf("%s\n\n", report::machine_line().c_str());
  std::printf("| %-66s | %8s | %7s |\n|%s|%s|%s|\n", "640 x 480 pixels, one core, processor time, median", "ms",
              "a second", std::string(68, '-').c_str(), std::string(10, '-').c_str(), std::string(9, '-').c_str());
  cast_rows("arm of capsules", ArmShape::capsules, 0);
  cast_rows("arm of meshes (7 x 1 k triangles)", ArmShape::meshes, 32);
  cast_rows("arm of meshes (7 x 9 k triangles)", ArmShape::meshes, 96);
  sensor_row("ideal", {});
  sensor_row("kinect_v1", {});
  sensor_row("kinect_v1", {false, true});
  sensor_row("realsense_d435", {});
  sensor_row("azure_kinect_nfov", {});
  truth_row("capsules", ArmShape::capsules);
  truth_row("meshes", ArmShape::meshes);
}

}  // namespace

void add_workcell_rate_command(CLI::App& workcell) {
  workcell.add_subcommand("rate", "depth images, sensors and true distances a second, one core: some seconds")
      ->callback([] { measure_all(); });
}

}  // namespace depthgrid::lab
