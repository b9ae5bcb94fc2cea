// The oracle where the distance is known in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "depthgrid/core/pose.hpp"
#include "depthgrid/simulation/scene.hpp"
#include "reference/reference.hpp"

namespace depthgrid::reference {
namespace {

using Eigen::Vector3d;

/// Cameras with their own float images.
class Rigging {
 public:
  /// A camera whose pixels all show `depth_m`.
  CameraInput& add(const Pose& T_world_camera, float depth_m, int width_px = 64, int height_px = 48) {
    CameraInput input;
    input.camera = {width_px, height_px, 0.8 * width_px, 0.8 * width_px, 0.5 * width_px, 0.5 * height_px};
    input.T_world_camera = T_world_camera;
    images_.push_back(std::make_unique<std::vector<float>>(static_cast<std::size_t>(width_px * height_px), depth_m));
    input.frame.depth = depth_view(*images_.back(), width_px, height_px);
    input.sensor.lateral_px = 0;
    problem_.cameras.push_back(input);
    return problem_.cameras.back();
  }
  std::vector<float>& image(std::size_t k) { return *images_[k]; }
  Problem& problem() { return problem_; }
  [[nodiscard]] Interval distance(const Vector3d& p_world) const { return Reference(problem_).distance(p_world); }

 private:
  std::vector<std::unique_ptr<std::vector<float>>> images_;
  Problem problem_;
};

void expect_encloses(const Interval& interval, double distance_m, double width_m = 1e-3) {
  ASSERT_TRUE(interval.hi_m);
  EXPECT_FALSE(interval.limit_reached);
  EXPECT_LE(interval.lo_m, distance_m + 1e-7);
  EXPECT_GE(*interval.hi_m, distance_m - 1e-7);
  EXPECT_LE(*interval.hi_m - interval.lo_m, width_m);
}

TEST(ReferenceAnalytic, OneCameraFacingAWall) {
  Rigging rig;
  rig.add(Pose::Identity(), 2.0F);
  rig.problem().space = FrustumSpace{0, 0.3, 4.0};
  expect_encloses(rig.distance({0.1, 0.05, 1.75}), 0.25);
  expect_encloses(rig.distance({-0.2, 0.1, 1.61}), 0.39);
  EXPECT_TRUE(rig.distance({0.1, 0.05, 1.5}).beyond(0.4));
  // Inside the shadow, and exactly how far it begins.
  const Interval inside = rig.distance({0, 0, 2.5});
  EXPECT_EQ(inside.hi_m, 0.0);
  EXPECT_EQ(inside.lo_m, 0.0);
}

TEST(ReferenceAnalytic, MarginsAddUp) {
  Rigging rig;
  CameraInput& camera = rig.add(Pose::Identity(), 2.0F);
  camera.sensor = {0.01, 0.005, 0.0, 0};
  rig.problem().space = FrustumSpace{0, 0.3, 4.0};
  expect_encloses(rig.distance({0, 0, 1.75}), 0.23);
  camera.pose = {0.02, 0.0, 0.01};
  expect_encloses(rig.distance({0, 0, 1.75}), 0.20);
  // e grows with the range: the nearest point x at depth z on the axis satisfies 1.98 - z = 0.03 + 0.01 z.
  camera.pose.rotation_rad = 0.01;
  expect_encloses(rig.distance({0, 0, 1.75}), 1.95 / 1.01 - 1.75);
}

TEST(ReferenceAnalytic, BlindZoneAndBorderOfTheSpace) {
  Rigging rig;
  rig.add(Pose::Identity(), 3.0F).rule.near_m = 0.5;
  rig.problem().space = FrustumSpace{0, 0.3, 4.0};
  expect_encloses(rig.distance({0, 0, 0.7}), 0.2);
  // The left border's slope is -0.625: W's border is an obstacle, or does not matter.
  const Vector3d near_border(-0.9, 0, 1.8);
  EXPECT_TRUE(rig.distance(near_border).beyond(0.4));
  rig.problem().outside = Policy::obstacle;
  expect_encloses(rig.distance(near_border), (-0.9 + 0.625 * 1.8) / std::hypot(1.0, 0.625));
  EXPECT_EQ(rig.distance({-3, 0, 1}).hi_m, 0.0);
  rig.problem().outside = Policy::ignored;
  EXPECT_TRUE(rig.distance({-3, 0, 1}).point_outside);
  EXPECT_FALSE(rig.distance({-3, 0, 1}).hi_m);
}

TEST(ReferenceAnalytic, OneNearPixel) {
  Rigging rig;
  rig.add(Pose::Identity(), 3.0F);
  // Pixel (40, 24) shows 1 m: its shadow is the pyramid 0.15625 z <= x <= 0.17578 z, 0 <= y <= 0.0195 z from 1 m on.
  rig.image(0)[24 * 64 + 40] = 1.0F;
  rig.problem().space = FrustumSpace{0, 0.3, 4.0};
  const double slope = 8.0 / 51.2;
  const double z = 1.5;
  const Vector3d p(0.1, 0.01, z);
  expect_encloses(rig.distance(p), (slope * z - 0.1) / std::hypot(1.0, slope));
  // In front of the pixel the nearest point is on its front face.
  expect_encloses(rig.distance({0.165, 0.01, 0.8}), 0.2);
  // Without measurement the whole pyramid is an obstacle; with a filter radius its neighbours are too.
  rig.image(0)[24 * 64 + 40] = std::numeric_limits<float>::quiet_NaN();
  expect_encloses(rig.distance({0.08, 0.01, 0.8}), (slope * 0.8 - 0.08) / std::hypot(1.0, slope));
  rig.problem().cameras[0].sensor.lateral_px = 2;
  const double wider = 6.0 / 51.2;
  expect_encloses(rig.distance({0.08, 0.01, 0.8}), (wider * 0.8 - 0.08) / std::hypot(1.0, wider));
}

TEST(ReferenceAnalytic, SphereBetweenTwoOppositeCameras) {
  // What neither camera sees is about the sphere's own hull: between it and its silhouette cones.
  simulation::Scene scene;
  const double radius_m = 0.2;
  scene.add(simulation::Sphere{Vector3d::Zero(), radius_m});
  scene.add(simulation::Plane{Vector3d(0, 0, 1), -3.0});
  scene.add(simulation::Plane{Vector3d(0, 0, -1), -3.0});
  const Pose front = look_at({0, 0, -2}, Vector3d::Zero(), Vector3d::UnitY());
  const Pose back = look_at({0, 0, 2}, Vector3d::Zero(), Vector3d::UnitY());
  Rigging rig;
  std::vector<simulation::View> views;
  for (const Pose& pose : {front, back}) {
    CameraInput& camera = rig.add(pose, 0.0F, 192, 144);
    views.push_back(scene.render(camera.camera, pose));
    std::copy_n(views.back().depth_m.data(), 192 * 144, rig.image(views.size() - 1).begin());
  }
  rig.problem().space = FrustumSpace{0, 0.3, 4.0};
  const double pixel_m = 2.0 / (0.8 * 192);
  // On the axis the first camera's shadow begins at the sphere, up to the depth of the slant inside one pixel.
  const Interval on_axis = rig.distance({0.0, 0.0, -0.45});
  ASSERT_TRUE(on_axis.hi_m);
  EXPECT_NEAR(*on_axis.hi_m, 0.25, 2e-3);
  // Beside it both shadows end near the equator: a ring a little wider than the sphere (2 m away: 1 / cos(5.7 deg)).
  const Interval beside = rig.distance({0.5, 0.0, 0.0});
  ASSERT_TRUE(beside.hi_m);
  EXPECT_LT(*beside.hi_m, 0.3 + pixel_m);
  EXPECT_GT(beside.lo_m, 0.3 - 2 * pixel_m);
  // With the front camera alone the shadow cone goes on: far behind the sphere it is much nearer.
  const Vector3d behind(0.4, 0.0, 0.8);
  EXPECT_GT(rig.distance(behind).lo_m, 0.39);
  rig.problem().cameras.pop_back();
  EXPECT_LT(rig.distance(behind).hi_m.value_or(1.0), 0.15);
}

TEST(ReferenceAnalytic, RobotIsNeitherObstacleNorWindow) {
  Rigging rig;
  CameraInput& camera = rig.add(Pose::Identity(), 1.5F);
  std::vector<float> near_m(64 * 48, 1.4F);
  std::vector<float> far_m(64 * 48, 1.8F);
  camera.frame.robot = {near_m.data(), far_m.data(), 64};
  rig.problem().space = FrustumSpace{0, 0.3, 4.0};
  // Every pixel shows the robot: nothing behind its exit at 1.8 m is free, everything before it is.
  expect_encloses(rig.distance({0, 0, 1.6}), 1.8F - 1.6);
  // Something in front of the robot is an obstacle, and the robot behind it is not.
  std::fill(rig.image(0).begin(), rig.image(0).end(), 1.0F);
  expect_encloses(rig.distance({0, 0, 0.9}), 0.1);
  expect_encloses(rig.distance({0, 0, 1.55}), 1.55 - 1.4F);
}

TEST(ReferenceAnalytic, WorldBoxAndUncoveredSpace) {
  Rigging rig;
  rig.add(Pose::Identity(), 3.0F);
  rig.problem().space = WorldBox{Vector3d(-2, -2, 0.5), Vector3d(2, 2, 2)};
  const double slope = 0.625;
  const Vector3d p(-0.6, 0, 1.2);
  // Beside the view nobody looks: an obstacle, or declared to be none.
  expect_encloses(rig.distance(p), (slope * 1.2 - 0.6) / std::hypot(1.0, slope));
  rig.problem().uncovered = Policy::ignored;
  EXPECT_TRUE(rig.distance(p).beyond(0.4));
  rig.problem().outside = Policy::obstacle;
  expect_encloses(rig.distance({0, 0, 1.9}), 0.1);
}

TEST(ReferenceAnalytic, TheBoxLimitLeavesAValidInterval) {
  // Two cameras a metre apart see a wall and a bar before it, each its own: the bars' shadows cross 1.35 m away.
  Rigging rig;
  for (const double side : {-1.0, 1.0}) {
    Pose pose = Pose::Identity();
    pose.translation().x() = 0.5 * side;
    rig.add(pose, 3.0F);
    for (int v = 0; v < 48; ++v) {
      for (int u = 0; u < 64; ++u) {
        if (side * (u - 32) < -12 && side * (u - 32) > -20) {
          rig.image(side < 0 ? 0 : 1)[static_cast<std::size_t>(v * 64 + u)] = 1.0F;
        }
      }
    }
  }
  rig.problem().space = FrustumSpace{0, 0.3, 4.0};
  const Vector3d p(0.02, 0.01, 1.1);
  const Interval exact = rig.distance(p);
  ASSERT_TRUE(exact.hi_m);
  ASSERT_FALSE(exact.limit_reached);
  ASSERT_GT(exact.boxes, 10);
  SearchSettings settings;
  double last_lo_m = 0;
  for (const std::int64_t limit : {1, 3, 10, 30, 100}) {
    settings.box_limit = limit;
    const Interval interval = Reference(rig.problem()).distance(p, settings);
    EXPECT_LE(interval.lo_m, *exact.hi_m);
    EXPECT_GE(interval.hi_m.value_or(1.0), exact.lo_m);
    EXPECT_GE(interval.lo_m, last_lo_m);
    EXPECT_EQ(interval.limit_reached, limit < exact.boxes);
    last_lo_m = interval.lo_m;
  }
}

}  // namespace
}  // namespace depthgrid::reference
