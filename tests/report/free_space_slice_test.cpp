// The demo's cell cut by planes: what counts as free must be visible along a straight line.
#include "report/free_space_slice.hpp"

#include <gtest/gtest.h>

#include <array>

#include "depthgrid/core/margin.hpp"
#include "depthgrid/simulation/demo_scene.hpp"

namespace depthgrid::report {
namespace {

struct Seen {
  simulation::DemoScene demo = simulation::demo_scene();
  std::vector<DepthImage> free_m;

  Seen() {
    for (const RigCamera& camera : demo.rig.cameras) {
      const simulation::View view = demo.scene.render(camera.intrinsics, camera.T_world_camera, demo.robot_padding_m);
      FreeDepth free(640, 480, {});
      free.update(view.depth_m, {view.robot_near_m.data(), view.robot_far_m.data(), 640});
      free_m.push_back(free.image());
    }
  }
  /// No solid between the camera and the point; the robot itself counts as transparent up to its padding.
  [[nodiscard]] bool line_of_sight(std::size_t k, const Eigen::Vector3d& p_world) const {
    const Eigen::Vector3d eye = demo.rig.cameras[k].T_world_camera.translation();
    for (int i = 1; i < 400; ++i) {
      if (demo.scene.contains(eye + (p_world - eye) * i / 400, simulation::Body::obstacle)) {
        return false;
      }
    }
    return true;
  }
};

TEST(FreeSpaceSlice, FreePointsAreInSightAndTheSecondCameraFreesSome) {
  const Seen seen;
  std::array<int, 4> parts{};
  for (const double z_m : {0.9, 1.2, 1.4}) {
    const WorldRectangle area{{-2.5, 1.4, z_m}, {4.2, 0, 0}, {0, -2.6, 0}};
    constexpr int kWidth = 84;
    constexpr int kHeight = 52;
    const auto slice = free_space_slice(seen.demo.rig, seen.free_m, 0.29, 3.7, area, kWidth, kHeight);
    ASSERT_EQ(slice.size(), static_cast<std::size_t>(kWidth) * kHeight);
    for (int j = 0; j < kHeight; ++j) {
      for (int i = 0; i < kWidth; ++i) {
        const Eigen::Vector3d p =
            area.corner_world + (i + 0.5) / kWidth * area.along_world + (j + 0.5) / kHeight * area.down_world;
        const Sight at = slice[static_cast<std::size_t>(j) * kWidth + static_cast<std::size_t>(i)];
        ++parts[static_cast<std::size_t>(at)];
        if (at == Sight::free_for_principal) {
          EXPECT_TRUE(seen.line_of_sight(0, p)) << p.transpose();
        } else if (at == Sight::free_for_other) {
          EXPECT_TRUE(seen.line_of_sight(1, p)) << p.transpose();
          EXPECT_FALSE(sees_past(seen.demo.rig.cameras[0], seen.free_m[0], p)) << p.transpose();
        }
      }
    }
  }
  for (const int part : parts) {
    EXPECT_GT(part, 50);
  }
}

TEST(DemoScene, TellsTheStoryThatTheCommandPrints) {
  const Seen seen;
  const auto& demo = seen.demo;
  ASSERT_EQ(demo.rig.cameras.size(), 2U);
  const Eigen::Vector3d first = demo.rig.cameras[0].T_world_camera.translation();
  const Eigen::Vector3d second = demo.rig.cameras[1].T_world_camera.translation();
  EXPECT_NEAR((first - second).norm(), 4.0, 1e-9);
  ASSERT_EQ(demo.control_points_world.size(), 9U);
  int in_the_persons_shadow = 0;
  for (const Eigen::Vector3d& p : demo.control_points_world) {
    EXPECT_GT(demo.scene.distance(p).distance_m, 0.15);
    // The space 0.25 m beside the point, towards the person's shadow.
    in_the_persons_shadow += seen.line_of_sight(0, p + Eigen::Vector3d(0.1, 0.25, 0)) ? 0 : 1;
    EXPECT_TRUE(seen.line_of_sight(1, p + Eigen::Vector3d(0.1, 0.25, 0))) << p.transpose();
  }
  EXPECT_GE(in_the_persons_shadow, 2);
}

}  // namespace
}  // namespace depthgrid::report
