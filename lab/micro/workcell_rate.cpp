// How fast the simulated workcell runs on one core: depth images by ray casting, sensors, true distances.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "depthgrid/simulation/arrangement.hpp"
#include "depthgrid/simulation/simulated_sensors.hpp"
#include "lab/machine.hpp"
#include "lab/workcell/cell_truth.hpp"
#include "lab/workcell/depth_caster.hpp"
#include "lab/workcell/workcell_scene.hpp"

namespace {

using depthgrid::DepthImage;
using depthgrid::lab::ArmShape;
using depthgrid::lab::WorkcellScene;
using depthgrid::simulation::Motion;

constexpr int kFrames = 60;
constexpr double kFrameTime = 0.1;

/// Processor time of all threads, which other programs do not stretch as they do the time on the wall.
double process_ms() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

/// Median milliseconds of a call for each frame.
double median_ms(const std::function<void(int)>& frame) {
  std::vector<double> times;
  for (int i = 0; i < kFrames; ++i) {
    const double start_ms = process_ms();
    frame(i);
    times.push_back(process_ms() - start_ms);
  }
  std::nth_element(times.begin(), times.begin() + kFrames / 2, times.end());
  return times[kFrames / 2];
}

void row(const std::string& what, double ms) {
  std::printf("| %-66s | %8.2f | %7.0f |\n", what.c_str(), ms, 1000 / ms);
  std::fflush(stdout);
}

/// Two ideal cameras, all poses new in every frame.
void cast_rows(const char* arm, ArmShape shape, int segments) {
  const depthgrid::Rig rig = depthgrid::simulation::letter_arrangement("ideal").rig;
  WorkcellScene scene(Motion::carry_box, 1, shape, segments);
  depthgrid::workcell::DepthCaster caster(scene.at(0));
  std::vector<DepthImage> images(2);
  depthgrid::workcell::BodyImage bodies;
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
  const depthgrid::Rig rig = depthgrid::simulation::letter_arrangement(sensor).rig;
  WorkcellScene scene(Motion::carry_box, 1, ArmShape::capsules);
  const depthgrid::workcell::DepthCaster caster(scene.at(3));
  std::vector<DepthImage> ideal(2);
  std::vector<DepthImage> measured(2);
  for (std::size_t k = 0; k < 2; ++k) {
    caster.render(rig.cameras[k].intrinsics, rig.cameras[k].T_world_camera, ideal[k]);
  }
  depthgrid::simulation::SensorGroupSettings settings;
  settings.vibrating = std::move(vibrating);
  depthgrid::simulation::SimulatedSensors sensors(rig, settings);
  row(std::string("two images of sensor ") + sensor,
      median_ms([&](int frame) { sensors.measure(ideal, static_cast<std::uint64_t>(frame), measured); }));
}

void truth_row(const char* arm, ArmShape shape) {
  using depthgrid::simulation::BodyKind;
  WorkcellScene scene(Motion::carry_box, 1, shape, 32);
  depthgrid::workcell::CellTruth truth(scene.at(0));
  row(std::string("true distance, person and objects to the arm, ") + arm, median_ms([&](int frame) {
        truth.update(scene.at(frame * kFrameTime));
        (void)truth.nearest(BodyKind::robot, {BodyKind::person, BodyKind::object});
      }));
}

}  // namespace

int main() {
  try {
    std::printf("%s\n\n", depthgrid::lab::machine_line().c_str());
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
  } catch (const std::exception& error) {
    std::cerr << "depthgrid_workcell_rate: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
