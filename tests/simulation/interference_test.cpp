// Interference loses the share of pixels that is assumed, where two patterns meet and nowhere else.
#include "depthgrid/simulation/interference.hpp"

#include <gtest/gtest.h>

#include "depthgrid/core/error.hpp"
#include "depthgrid/simulation/scene.hpp"
#include "depthgrid/simulation/simulated_sensors.hpp"

namespace depthgrid::simulation::testing {
namespace {

const PinholeCamera kCamera{320, 240, 262.5, 262.5, 160, 120};

/// Units side by side before a wall at z = 2, each seeing nearly what the others see.
struct Row {
  explicit Row(std::size_t count) : images(count, DepthImage(kCamera.width_px, kCamera.height_px)) {
    Scene scene;
    scene.add(Plane{-Eigen::Vector3d::UnitZ(), -2});
    for (std::size_t i = 0; i < count; ++i) {
      Pose T_world_camera = Pose::Identity();
      T_world_camera.translation().x() = 1e-3 * static_cast<double>(i);
      images[i] = scene.render(kCamera, T_world_camera).depth_m;
      units.push_back({kCamera, T_world_camera, nullptr, false});
    }
    for (std::size_t i = 0; i < count; ++i) {
      units[i].ideal_m = &images[i];
    }
  }
  std::vector<DepthImage> images;
  std::vector<StructuredLightUnit> units;
};

double lost_share(const Row& row, std::size_t self, int frames = 10) {
  long lost = 0;
  const std::size_t pixels = row.images[0].index(0, kCamera.height_px);
  for (int frame = 0; frame < frames; ++frame) {
    DepthImage measured = row.images[self];
    apply_interference(row.units, self, {}, 1, static_cast<std::uint64_t>(frame), measured);
    lost += std::count(measured.data(), measured.data() + pixels, 0.0F);
  }
  return static_cast<double>(lost) / static_cast<double>(pixels) / frames;
}

TEST(Interference, LosesTheAssumedShareAndLessWithVibration) {
  Row two(2);
  EXPECT_NEAR(lost_share(two, 0), 0.0357, 0.002);
  two.units[1].vibrating = true;
  EXPECT_NEAR(lost_share(two, 0), 0.0028, 0.0005) << "the other one vibrates";
  EXPECT_NEAR(lost_share(two, 1), 0.0028, 0.0005) << "it vibrates itself";
  Row six(6);
  EXPECT_NEAR(lost_share(six, 2), 0.166, 0.005);
  for (StructuredLightUnit& unit : six.units) {
    unit.vibrating = true;
  }
  EXPECT_NEAR(lost_share(six, 2), 0.014, 0.002);
  EXPECT_EQ(lost_share(Row(1), 0), 0);
}

TEST(Interference, SpotsAreRoundAndOnlyWhereBothPatternsFall) {
  Row row(2);
  // The other unit sees the left half of the wall only: a screen at half a metre hides the rest from it.
  for (int v = 0; v < kCamera.height_px; ++v) {
    std::fill(row.images[1].data() + row.images[1].index(160, v), row.images[1].data() + row.images[1].index(320, v),
              0.5F);
  }
  DepthImage measured = row.images[0];
  apply_interference(row.units, 0, {}, 1, 0, measured);
  long left = 0;
  long alone = 0;
  for (int v = 1; v + 1 < kCamera.height_px; ++v) {
    for (int u = 1; u + 1 < kCamera.width_px; ++u) {
      if (measured.at(u, v) != 0) {
        continue;
      }
      ASSERT_LT(u, 161) << "lost in the other unit's shadow";
      ++left;
      alone += measured.at(u - 1, v) != 0 && measured.at(u + 1, v) != 0 ? 1 : 0;
    }
  }
  EXPECT_GT(left, 500);
  EXPECT_LT(alone, left / 10) << "spots, not single pixels";
}

TEST(Interference, AGroupOfSensorsIsReproducibleAndDisturbsItself) {
  Rig rig;
  rig.name = "pair";
  for (const char* id : {"left", "right"}) {
    RigCamera camera;
    camera.id = id;
    camera.intrinsics = kCamera;
    camera.sensor = "kinect_v1";
    camera.margins = CameraMargins{};
    rig.cameras.push_back(camera);
  }
  const Row row(2);
  const auto invalid = [&](const Rig& cameras, const SensorGroupSettings& settings, std::uint64_t frame) {
    SimulatedSensors sensors(cameras, settings);
    std::vector<DepthImage> measured(2);
    sensors.measure(row.images, frame, measured);
    const std::size_t pixels = measured[0].index(0, kCamera.height_px);
    return std::count(measured[0].data(), measured[0].data() + pixels, 0.0F);
  };
  const long disturbed = invalid(rig, {}, 0);
  EXPECT_EQ(disturbed, invalid(rig, {}, 0));
  EXPECT_NE(disturbed, invalid(rig, {}, 1));
  SensorGroupSettings vibrating;
  vibrating.vibrating = {false, true};
  const long less = invalid(rig, vibrating, 0);
  rig.cameras[1].sensor = "azure_kinect_nfov";
  const long undisturbed = invalid(rig, {}, 0);
  const double pixels = kCamera.width_px * kCamera.height_px;
  EXPECT_NEAR(static_cast<double>(disturbed - undisturbed) / pixels, 0.0357, 0.006);
  EXPECT_NEAR(static_cast<double>(less - undisturbed) / pixels, 0.0028, 0.002);

  rig.cameras[1].sensor = "kinect_v9";
  EXPECT_THROW(SimulatedSensors(rig, {}), Error);
  rig.cameras[1].sensor = "";
  SensorGroupSettings wrong;
  wrong.vibrating = {true};
  EXPECT_THROW(SimulatedSensors(rig, wrong), Error);
}

TEST(Interference, WrongArgumentsAreRefused) {
  Row row(2);
  DepthImage measured = row.images[0];
  EXPECT_THROW(apply_interference(row.units, 2, {}, 1, 0, measured), Error);
  EXPECT_THROW(apply_interference(row.units, 0, {1.0, 0, 2}, 1, 0, measured), Error);
  DepthImage small(3, 3);
  EXPECT_THROW(apply_interference(row.units, 0, {}, 1, 0, small), Error);
  row.units[1].ideal_m = nullptr;
  EXPECT_THROW(apply_interference(row.units, 0, {}, 1, 0, measured), Error);
}

}  // namespace
}  // namespace depthgrid::simulation::testing
