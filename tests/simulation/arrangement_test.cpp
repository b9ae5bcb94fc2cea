// The arrangements are what the letter states, as far as it does.
#include "depthgrid/simulation/arrangement.hpp"

#include <gtest/gtest.h>

#include "depthgrid/core/error.hpp"

namespace depthgrid::simulation::testing {
namespace {

/// Least and greatest depth of the workspace in a camera.
std::pair<double, double> workspace_depths(const Arrangement& arrangement, const RigCamera& camera) {
  double least_m = 100;
  double greatest_m = -100;
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d p;
    for (int axis = 0; axis < 3; ++axis) {
      p[axis] =
          ((corner >> axis) & 1) != 0 ? arrangement.workspace_high_world[axis] : arrangement.workspace_low_world[axis];
    }
    const double z = (camera.T_world_camera.inverse() * p).z();
    least_m = std::min(least_m, z);
    greatest_m = std::max(greatest_m, z);
  }
  return {least_m, greatest_m};
}

TEST(Arrangement, TheLettersNumbersHold) {
  const Arrangement letter = letter_arrangement();
  ASSERT_EQ(letter.rig.cameras.size(), 2U);
  EXPECT_EQ(letter.d_min_m, 0.2882);
  EXPECT_EQ(letter.cells, 343);
  for (const RigCamera& camera : letter.rig.cameras) {
    const auto [least_m, greatest_m] = workspace_depths(letter, camera);
    EXPECT_NEAR(least_m, 0.2882, 1e-9);
    EXPECT_NEAR(greatest_m, 0.2882 + 343 * 0.01, 1e-9);
    EXPECT_EQ(camera.intrinsics.width_px, 640);
    EXPECT_EQ(camera.intrinsics.height_px, 480);
    EXPECT_EQ(camera.sensor, "kinect_v1");
    EXPECT_EQ(camera.rule.near_m, 0.5);
    // The robot's surroundings are in view.
    for (const Eigen::Vector3d& p :
         {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 0.6, 0.6), Eigen::Vector3d(0, 0, 1.2)}) {
      const DepthPoint seen = project(camera.intrinsics, camera.T_world_camera.inverse() * p);
      EXPECT_TRUE(camera.intrinsics.contains(static_cast<int>(seen.x_px), static_cast<int>(seen.y_px)));
    }
  }
  const Eigen::Vector3d apart =
      letter.rig.cameras[0].T_world_camera.translation() - letter.rig.cameras[1].T_world_camera.translation();
  EXPECT_NEAR(apart.norm(), 4.0, 0.02);
  EXPECT_LT((letter.rig.cameras[0].T_world_camera.translation() - Eigen::Vector3d(-2, -0.18, 0.5)).norm(), 0.005);
}

TEST(Arrangement, OneToSixteenCamerasSeeTheRobotFromInsideTheRoom) {
  const Workcell cell = empty_workcell();
  validate(cell);
  const Scene scene = scene_of(cell);
  for (const int cameras : {1, 2, 3, 4, 8, 16}) {
    const Arrangement ring = arrangement(cameras, "ideal");
    validate(ring.rig);
    ASSERT_EQ(ring.rig.cameras.size(), static_cast<std::size_t>(cameras));
    EXPECT_EQ(ring.rig.cameras[0].T_world_camera.matrix(), letter_arrangement().rig.cameras[0].T_world_camera.matrix());
    for (const RigCamera& camera : ring.rig.cameras) {
      EXPECT_GT(scene.distance(camera.T_world_camera.translation()).distance_m, 0.5);
      const Eigen::Vector3d robot = camera.T_world_camera.inverse() * Eigen::Vector3d(0, 0, 0.4);
      const DepthPoint seen = project(camera.intrinsics, robot);
      EXPECT_TRUE(camera.intrinsics.contains(static_cast<int>(seen.x_px), static_cast<int>(seen.y_px)));
      EXPECT_GT(seen.depth_m, 1.5);
    }
    for (std::size_t i = 0; i < ring.rig.cameras.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        EXPECT_GT((ring.rig.cameras[i].T_world_camera.translation() - ring.rig.cameras[j].T_world_camera.translation())
                      .norm(),
                  0.5);
      }
    }
  }
  EXPECT_THROW((void)arrangement(0), Error);
  EXPECT_THROW((void)arrangement(17), Error);
  EXPECT_THROW((void)letter_arrangement("kinect_v9"), Error);
}

TEST(Arrangement, TheFloorIsWhereTheRigSays) {
  const Arrangement letter = letter_arrangement();
  ASSERT_TRUE(letter.rig.T_floor_world.has_value());
  EXPECT_NEAR((*letter.rig.T_floor_world * Eigen::Vector3d(0.3, 0.2, -0.5)).z(), 0, 1e-12);
  EXPECT_TRUE(scene_of(empty_workcell()).contains({1, 1, -0.5001}, Body::obstacle));
  EXPECT_FALSE(scene_of(empty_workcell()).contains({1, 1, -0.4999}, Body::obstacle));
}

}  // namespace
}  // namespace depthgrid::simulation::testing
