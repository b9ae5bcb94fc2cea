// The margins of the library's sensor models against the simulated sensors: which share of readings they cover.
#include <gtest/gtest.h>

#include <cstdio>

#include "depthgrid/core/margin.hpp"
#include "depthgrid/core/sensor_models.hpp"
#include "depthgrid/simulation/arrangement.hpp"
#include "depthgrid/simulation/simulated_sensors.hpp"
#include "lab/workcell/depth_caster.hpp"
#include "lab/workcell/workcell_scene.hpp"

namespace depthgrid::workcell::testing {
namespace {

using simulation::in_units;
using simulation::SimulatedSensor;

/// Of a normal distribution, what lies more than three standard deviations above the mean.
constexpr double kBeyondThreeSigma = 0.00135;

struct Share {
  long all = 0;
  long beyond = 0;
  double largest_m = 0;
  [[nodiscard]] double value() const { return static_cast<double>(beyond) / static_cast<double>(std::max(1L, all)); }
  /// Where a model does not count it in, half a unit of the 16-bit image is not the sensor's.
  void add(double too_far_m) {
    ++all;
    beyond += too_far_m > 0.5e-3 + 1e-6 ? 1 : 0;
    largest_m = std::max(largest_m, too_far_m);
  }
};

class Margins : public ::testing::TestWithParam<const char*> {
 protected:
  const SensorModel& model = sensor_model(GetParam());
};

TEST_P(Margins, CoverTheShareOfReadingsOnAWallThatTheyClaim) {
  const PinholeCamera camera{320, 240, 525, 525, 160, 120};
  const SensorMargin margin = sensor_margins(model, camera, 0.001).sensor;
  for (const double z : {0.8, 1.5, 2.5, 3.5}) {
    if (z > model.rule.far_m) {
      continue;
    }
    DepthImage wall(camera.width_px, camera.height_px);
    std::fill_n(wall.data(), wall.index(0, camera.height_px), static_cast<float>(z));
    Share share;
    for (std::uint64_t unit = 1; unit <= 3; ++unit) {
      SimulatedSensor sensor(simulation::sensor_simulation(GetParam(), camera), camera, unit);
      DepthImage measured;
      for (std::uint64_t frame = 0; frame < 2; ++frame) {
        sensor.measure(wall, frame, measured);
        for (const std::uint16_t units : in_units(measured, 0.001)) {
          if (units > 0) {
            share.add(units * 0.001 - depth_margin_m(margin, units * 0.001) - z);
          }
        }
      }
    }
    std::printf("[ figures  ] %-18s wall at %.1f m: %.4f %% read beyond the margin\n", GetParam(), z,
                100 * share.value());
    EXPECT_LE(share.value(), kBeyondThreeSigma) << z;
  }
}

TEST_P(Margins, CoverNearlyAllFreeSpaceInTheCell) {
  const Rig rig = simulation::letter_arrangement(GetParam()).rig;
  lab::WorkcellScene scene(simulation::Motion::reach, 1, lab::ArmShape::capsules);
  DepthCaster caster(scene.at(0));
  simulation::SimulatedSensors sensors(rig, {});
  Share share;
  long known_free = 0;
  std::vector<DepthImage> ideal(rig.cameras.size());
  std::vector<DepthImage> measured(rig.cameras.size());
  for (std::uint64_t frame = 0; frame < 4; ++frame) {
    caster.update(scene.at(1.5 * static_cast<double>(frame)));
    for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
      caster.render(rig.cameras[k].intrinsics, rig.cameras[k].T_world_camera, ideal[k]);
    }
    sensors.measure(ideal, frame, measured);
    for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
      const RigCamera& camera = rig.cameras[k];
      const std::vector<std::uint16_t> units = in_units(measured[k], camera.metres_per_unit);
      DepthImage readings(camera.intrinsics.width_px, camera.intrinsics.height_px);
      normalise(depth_view(units, camera.intrinsics.width_px, camera.intrinsics.height_px, camera.metres_per_unit),
                camera.rule, readings);
      FreeDepth free_depth(camera.intrinsics.width_px, camera.intrinsics.height_px, camera.margins->sensor);
      free_depth.update(readings, {});
      for (std::size_t i = 0; i < units.size(); ++i) {
        const float free_m = free_depth.image().data()[i];
        if (free_m > 0) {
          share.add(static_cast<double>(free_m) - ideal[k].data()[i]);
        }
        known_free += free_m > 0 ? 1 : 0;
      }
    }
  }
  std::printf(
      "[ figures  ] %-18s in the cell: %.1f %% of the pixels free something, of these %.4f %% too far, by %.3f m "
      "at most\n",
      GetParam(), 100.0 * static_cast<double>(known_free) / (8.0 * 640 * 480), 100 * share.value(), share.largest_m);
  EXPECT_LE(share.value(), kBeyondThreeSigma);
  EXPECT_GT(known_free, 0);
}

INSTANTIATE_TEST_SUITE_P(Sensors, Margins,
                         ::testing::Values("ideal", "kinect_v1", "realsense_d435", "azure_kinect_nfov"));

}  // namespace
}  // namespace depthgrid::workcell::testing
