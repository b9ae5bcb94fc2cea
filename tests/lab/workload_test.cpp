// The workload keeps what its figures rely on: people near the arm, but never in it.
#include "lab/workload/workload.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "depthgrid/core/error.hpp"
#include "lab/workload/workload_noise.hpp"
#include "support/quantile.hpp"

namespace depthgrid::lab {
namespace {

using test::quantile;

TEST(Workload, ControlPointsAreNearPeopleAndThingsAtAllTimes) {
  std::vector<double> distances_m;
  double clearance_m = 1;
  for (int step = 0; step < kWorkloadFrameSets * 4; ++step) {
    const double time_s = step / (4 * kWorkloadRate);
    const simulation::Scene scene = workload_scene(time_s);
    for (const Eigen::Vector3d& p : workload_points(time_s)) {
      distances_m.push_back(scene.distance(p).distance_m);
    }
    const simulation::Arm arm = workload_arm(time_s);
    for (std::size_t i = 2; i < arm.links.size(); ++i) {  // the column stands on the table
      for (int k = 0; k <= 20; ++k) {
        const Capsule& link = arm.links[i];
        const Eigen::Vector3d p = link.a + (link.b - link.a) * k / 20;
        clearance_m = std::min(clearance_m, scene.distance(p).distance_m - link.radius_m);
      }
    }
  }
  std::sort(distances_m.begin(), distances_m.end());
  std::printf("control points: %.0f ... %.0f mm, median %.0f mm, 10 %% below %.0f mm, 10 %% above %.0f mm\n",
              1000 * distances_m.front(), 1000 * distances_m.back(), 1000 * quantile(distances_m, 0.5),
              1000 * quantile(distances_m, 0.1), 1000 * quantile(distances_m, 0.9));
  std::printf("clearance of the arm's surface: at least %.0f mm\n", 1000 * clearance_m);
  EXPECT_GT(distances_m.front(), 0.005);
  EXPECT_LT(distances_m.back(), 0.4);
  EXPECT_NEAR(quantile(distances_m, 0.5), 0.18, 0.02);
  EXPECT_GT(clearance_m, 0.01) << "somebody stands in the arm";
}

TEST(Workload, FramesHoldDepthInMillimetresAndTheRobot) {
  const Workload workload(2, 2);
  ASSERT_EQ(workload.rig().cameras.size(), 2U);
  for (int set = 0; set < 2; ++set) {
    const simulation::Scene scene = workload_scene(Workload::time_s(set));
    for (std::size_t k = 0; k < 2; ++k) {
      const RigCamera& camera = workload.rig().cameras[k];
      const Frame& frame = workload.frames(set)[k];
      ASSERT_EQ(frame.depth.width_px, 640);
      ASSERT_EQ(frame.depth.height_px, 480);
      EXPECT_EQ(frame.time_s, set / 30.0);
      int robot_pixels = 0;
      for (int v = 0; v < 480; v += 7) {
        for (int u = 0; u < 640; u += 7) {
          const auto depth = measured_depth_m(frame.depth, {}, u, v);
          ASSERT_TRUE(depth.has_value()) << "the room is closed, but pixel " << u << " " << v << " has no depth";
          const float near_m = frame.robot.near_m[v * frame.robot.stride_px + u];
          const float far_m = frame.robot.far_m[v * frame.robot.stride_px + u];
          const bool robot = near_m > 0 && near_m <= *depth && *depth <= far_m;
          robot_pixels += robot ? 1 : 0;
          const Eigen::Vector3d p =
              camera.T_world_camera * deproject(camera.intrinsics, {u + 0.5, v + 0.5, static_cast<double>(*depth)});
          if (!robot) {
            EXPECT_LT(scene.distance(p).distance_m, 0.0011) << "camera " << k << ", pixel " << u << " " << v;
          }
        }
      }
      EXPECT_GT(robot_pixels, 50);
    }
  }
}

TEST(Workload, RandomPointsRepeatBySeed) {
  const auto a = random_workload_points(0.3, 9, 7);
  const auto b = random_workload_points(0.3, 9, 7);
  const auto c = random_workload_points(0.3, 9, 8);
  ASSERT_EQ(a.size(), 9U);
  EXPECT_EQ(a, b);
  EXPECT_NE(a, c);
}

TEST(Workload, NoiseStaysWithinItsMarginAndLeavesTheRobotRecognised) {
  const Workload clean(workload_rig(2), 2, kNoisyRobotPadding);
  const NoisyWorkload noisy(clean);
  const SensorMargin margin = noise_margin();
  double pixels = 0;
  double invalid = 0;
  double robot = 0;
  double lost = 0;
  double squares = 0;
  for (int set = 0; set < 2; ++set) {
    for (std::size_t k = 0; k < 2; ++k) {
      const Frame& exact = clean.frames(set)[k];
      const Frame& frame = noisy.frames(set)[k];
      for (int v = 0; v < 480; ++v) {
        for (int u = 0; u < 640; ++u) {
          const double z_m = *measured_depth_m(exact.depth, {}, u, v);
          const auto depth_m = measured_depth_m(frame.depth, {}, u, v);
          ++pixels;
          if (!depth_m) {
            ++invalid;
            continue;
          }
          const double bound_m = *depth_m - depth_margin_m(margin, *depth_m);
          ASSERT_LE(bound_m, z_m) << "camera " << k << ", pixel " << u << " " << v;
          const double deviation = (*depth_m - z_m) / (0.0005 + 0.0015 * z_m * z_m);
          squares += deviation * deviation;
          const double near_m = frame.robot.near_m[v * frame.robot.stride_px + u];
          const double far_m = frame.robot.far_m[v * frame.robot.stride_px + u];
          if (near_m > 0 && near_m <= z_m - kNoisyRobotPadding / 2 && z_m + kNoisyRobotPadding / 2 <= far_m) {
            ++robot;
            lost += near_m <= bound_m && *depth_m <= far_m ? 0 : 1;
          }
        }
      }
    }
  }
  EXPECT_NEAR(invalid / pixels, 0.01, 0.001);
  // Cut-off normal noise (0.98) and a uniform quantisation of +- 0.9 standard deviations together.
  EXPECT_NEAR(std::sqrt(squares / pixels), 1.1, 0.1);
  EXPECT_GT(robot, 1000);
  EXPECT_LT(lost / robot, 0.05);
  EXPECT_NE(noisy.frames(0)[0].depth.data, noisy.frames(0)[1].depth.data);
}

TEST(Workload, ImpossibleSizesAreRefused) {
  EXPECT_THROW((void)workload_rig(0), Error);
  EXPECT_THROW((void)workload_rig(9), Error);
  EXPECT_THROW(Workload(1, 0), Error);
}

}  // namespace
}  // namespace depthgrid::lab
