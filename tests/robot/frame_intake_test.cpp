// From images to frames, each camera at its own time and place. Links depthgrid::robot alone: no controller is needed.
#include "depthgrid/robot/frame_intake.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "depthgrid/robot/kuka_lwr4.hpp"
#include "robot/robot_support.hpp"
#include "support/allocation_guard.hpp"

namespace depthgrid::robot {
namespace {

constexpr int kWidth = 64;
constexpr int kHeight = 48;

/// A turning arm on a table, seen by two cameras; one sample each 2 ms up to 0.5 s.
class Intake : public ::testing::Test {
 protected:
  Intake() {
    robot_.T_world_base.translation() = Eigen::Vector3d(0.5, -1, 0.7);
    robot_.T_world_base.linear() = Eigen::AngleAxisd(1, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    for (int k = 0; k <= 250; ++k) {
      EXPECT_TRUE(history_.add(0.002 * k, std::vector<double>{0.004 * k, 0.9, 0, -1, 0, 0.5, 0}));
    }
    for (const double side : {-1.0, 1.0}) {
      RigCamera& camera = rig_.cameras.emplace_back();
      camera.id = side < 0 ? "left" : "right";
      camera.intrinsics = from_opencv(kWidth, kHeight, 52.5, 52.5, 31.5, 23.5);
      camera.T_world_camera = look_at({0.5 + 1.5 * side, -2.5, 1.5}, {0.5, -1, 1.1});
    }
    settings_.removal.padding_m = 0.05;
    settings_.time_error_s = 0.002;
  }

  [[nodiscard]] Frame image(double time_s) const { return {depth_view(wall_, kWidth, kHeight, 0.001), {}, time_s}; }

  /// What the parts below the intake say.
  [[nodiscard]] std::vector<float> expected(std::size_t camera, double time_s, const Pose& T_world_camera) const {
    RobotAtExposure robot(robot_, history_, rig_.cameras[camera].intrinsics, link_capsules(robot_.model), settings_);
    const DepthView depth = image(time_s).depth;
    return near_of(robot.find(time_s, T_world_camera, &depth).view);
  }
  static std::vector<float> near_of(const RobotView& view) {
    std::vector<float> result;
    for (int v = 0; view.near_m != nullptr && v < kHeight; ++v) {
      result.insert(result.end(), view.near_m + v * view.stride_px, view.near_m + v * view.stride_px + kWidth);
    }
    return result;
  }

  static std::vector<double> fast_at(double time_s) { return {2 * time_s, 0.9, 0, -1, 0, 0.5, 0}; }

  PlacedRobot robot_{kuka_lwr4()};
  JointHistory history_{7, 512, 0.02, 0.01};
  JointHistory fast_{7, 512, 0.02, 0.01};
  Rig rig_;
  ExposureSettings settings_;
  std::vector<std::uint16_t> wall_ = std::vector<std::uint16_t>(kWidth * kHeight, 3500);
};

TEST_F(Intake, FindsTheRobotAtTheTimeOfEachCamera) {
  FrameIntake intake(rig_, robot_, history_, settings_);
  const std::array<Frame, 2> seen{image(0.101), image(0.4)};
  const std::span<const Frame> frames = intake.frames(seen);
  ASSERT_EQ(frames.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(frames[k].time_s, seen[k].time_s);
    EXPECT_EQ(frames[k].depth.data, seen[k].depth.data);
    const std::vector<float> near_m = near_of(frames[k].robot);
    EXPECT_GT(std::count_if(near_m.begin(), near_m.end(), [](float m) { return m > 0; }), 50);
    EXPECT_EQ(near_m, expected(k, seen[k].time_s, rig_.cameras[k].T_world_camera));
    EXPECT_NE(near_m, expected(k, 0.25, rig_.cameras[k].T_world_camera)) << "another time is another image";
    EXPECT_TRUE(intake.report()[k].robot_removed);
    EXPECT_EQ(intake.report()[k].joints.answer, JointAnswer::interpolated);
  }
}

// Where the arm is in the image is worked out here: joint positions by the line that they follow, each link's capsules,
// the pixel that the middle of one projects to. Ten milliseconds are two pixels at the tip.
TEST_F(Intake, FindsTheRobotWhereItWasAtTheExposure) {
  for (int k = 0; k <= 250; ++k) {  // faster than the fixture's: 2 rad/s
    ASSERT_TRUE(fast_.add(0.002 * k, fast_at(0.002 * k)));
  }
  settings_.removal.padding_m = 0.0;
  settings_.time_error_s = 0;
  const std::vector<LinkCapsule> links = link_capsules(robot_.model);
  const RigCamera& camera = rig_.cameras[0];
  RobotAtExposure robot(robot_, fast_, camera.intrinsics, links, settings_);
  for (const double time_s : {0.05, 0.123, 0.3, 0.4}) {
    const DepthView depth = image(time_s).depth;
    const ExposedRobot found = robot.find(time_s, camera.T_world_camera, &depth);
    ASSERT_TRUE(found.joints.known());
    const std::vector<Pose> T_world_link = robot_.link_poses(fast_at(time_s));
    for (std::size_t link = 0; link < T_world_link.size(); ++link) {
      EXPECT_LT((robot.T_world_link()[link].matrix() - T_world_link[link].matrix()).cwiseAbs().maxCoeff(), 1e-9)
          << "link " << link << " at " << time_s;
    }
    // The tip's capsule lies before everything else here: the interval begins on its surface.
    const Capsule& tip = links.back().capsule;
    const Eigen::Vector3d p =
        camera.T_world_camera.inverse() * (T_world_link[links.back().link] * (0.5 * (tip.a + tip.b)));
    const DepthPoint at = project(camera.intrinsics, p);
    const auto pixel =
        static_cast<std::ptrdiff_t>(at.y_px) * found.view.stride_px + static_cast<std::ptrdiff_t>(at.x_px);
    EXPECT_GT(found.view.near_m[pixel], 0) << "the tip is not in its pixel at " << time_s;
    EXPECT_LE(found.view.near_m[pixel], p.z()) << time_s;
    EXPECT_GE(found.view.far_m[pixel], p.z()) << time_s;
  }
}

TEST_F(Intake, TakesOneCameraAndOneThatMoves) {
  FrameIntake intake(rig_, robot_, history_, settings_);
  const Pose& stands = rig_.cameras[1].T_world_camera;
  EXPECT_EQ(near_of(intake.frame(1, image(0.2)).robot), expected(1, 0.2, stands));
  Pose moved = stands;
  moved.translation().z() += 0.2;
  const std::vector<float> near_m = near_of(intake.frame(1, image(0.2), moved).robot);
  EXPECT_EQ(near_m, expected(1, 0.2, moved));
  EXPECT_NE(near_m, expected(1, 0.2, stands));
  EXPECT_FALSE(intake.report()[0].robot_removed) << "the other camera has had no image";
  EXPECT_EQ(intake.frame(2, image(0.2)).depth.data, nullptr) << "no such camera";
  const Frame only = image(0.2);
  EXPECT_EQ(intake.frames({&only, 1})[1].depth.data, nullptr);
}

TEST_F(Intake, SaysWhereTheRobotIsNotRemovedAndWhy) {
  FrameIntake intake(rig_, robot_, history_, settings_);
  EXPECT_EQ(intake.report()[0].joints.answer, JointAnswer::no_samples);
  const std::array<Frame, 2> seen{image(0.3), image(0.9)};
  const std::span<const Frame> frames = intake.frames(seen);
  EXPECT_TRUE(intake.report()[0].robot_removed);
  EXPECT_FALSE(intake.report()[1].robot_removed);
  EXPECT_EQ(intake.report()[1].joints.answer, JointAnswer::too_new);
  EXPECT_EQ(frames[1].robot.near_m, nullptr);
  EXPECT_NE(frames[1].depth.data, nullptr) << "the image stays, with the robot as an obstacle";
  // Known positions, a camera that stands nowhere.
  Pose nowhere = rig_.cameras[0].T_world_camera;
  nowhere.translation().x() = std::nan("");
  (void)intake.frame(0, image(0.3), nowhere);
  EXPECT_TRUE(intake.report()[0].joints.known());
  EXPECT_FALSE(intake.report()[0].robot_removed);
  // The newest sample stands in for a little while.
  (void)intake.frame(0, image(0.505));
  EXPECT_EQ(intake.report()[0].joints.answer, JointAnswer::held);
  EXPECT_TRUE(intake.report()[0].robot_removed);
}

TEST_F(Intake, SaysWhatThePaddingLacks) {
  rig_.cameras[0].margins = CameraMargins{.sensor = {.constant_m = 0.01, .linear = 0.02, .quadratic_per_m = 0}};
  const FrameIntake intake(rig_, robot_, history_, settings_);
  EXPECT_FALSE(intake.missing_padding_m(1, 2)) << "nothing was said about the sensor";
  EXPECT_FALSE(intake.missing_padding_m(2, 2));
  // 50 mm at 2 m, in the corners along a ray of |(32, 24, 52.5)| / 52.5 = 1.257.
  ASSERT_TRUE(intake.missing_padding_m(0, 2));
  EXPECT_NEAR(*intake.missing_padding_m(0, 2), 0.05 * std::hypot(32, 24, 52.5) / 52.5 - 0.05, 1e-12);
  EXPECT_EQ(intake.missing_padding_m(0, 1), 0);
}

TEST_F(Intake, LeavesOutWhatTheOptionsLeaveOut) {
  const CapsuleOptions options{.left_out = {"lwr_7_link", "lwr_6_link", "lwr_5_link", "lwr_4_link"}, .margin_m = 0};
  FrameIntake all(rig_, robot_, history_, settings_);
  FrameIntake fewer(rig_, robot_, history_, settings_, options);
  const auto pixels = [](const Frame& frame) {
    const std::vector<float> near_m = near_of(frame.robot);
    return std::count_if(near_m.begin(), near_m.end(), [](float m) { return m > 0; });
  };
  const auto some = pixels(fewer.frame(0, image(0.2)));
  EXPECT_GT(some, 0);
  EXPECT_LT(some, pixels(all.frame(0, image(0.2))));
}

TEST_F(Intake, DoesNotAllocate) {
  DEPTHGRID_REQUIRE_ALLOCATION_COUNT();
  FrameIntake intake(rig_, robot_, history_, settings_);
  const std::array<Frame, 2> seen{image(0.101), image(0.4)};
  const test::AllocationGuard guard;
  (void)intake.frames(seen);
  EXPECT_EQ(guard.allocations(), 0);
}

}  // namespace
}  // namespace depthgrid::robot
