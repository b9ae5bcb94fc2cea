// The grid as a distance evaluator: what it refuses, frames camera by camera, and the robot taken out of the image.
#include "depthgrid/grid/grid_evaluator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace depthgrid::grid {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

constexpr int kImageWidth = 64;
constexpr int kImageHeight = 48;
constexpr DepthQuantisation kDepthCells{0.2, 0.01, 0.0, 330};

/// Looks along z from the origin, as do the others of its rig, 0.1 m beside each other.
Rig rig_of(int cameras) {
  Rig rig{.name = "rig", .cameras = {}, .T_floor_world = {}};
  for (int k = 0; k < cameras; ++k) {
    RigCamera& camera = rig.cameras.emplace_back();
    camera.id = "camera " + std::to_string(k);
    camera.intrinsics = {kImageWidth, kImageHeight, 52.5, 52.5, 32, 24};
    camera.T_world_camera.translation().x() = 0.1 * k;
  }
  return rig;
}

EvaluationSettings letter(RobotPixels robot_pixels = RobotPixels::case_iv) {
  EvaluationSettings settings;
  settings.variant = Variant::letter;
  settings.collect = Collect::hybrid;
  settings.robot_pixels = robot_pixels;
  return settings;
}

/// A wall, with a robot before it, 1.9 to 2.1 m deep, in the middle of the image.
struct RobotBeforeWall {
  std::vector<float> depth_m = std::vector<float>(kImageWidth * kImageHeight, 3.4F);
  std::vector<float> near_m = std::vector<float>(kImageWidth * kImageHeight, 0.0F);
  std::vector<float> far_m = std::vector<float>(kImageWidth * kImageHeight, 0.0F);
  RobotBeforeWall() {
    for (std::size_t v = 20; v < 28; ++v) {
      for (std::size_t u = 28; u < 36; ++u) {
        depth_m[v * kImageWidth + u] = 1.95F;
        near_m[v * kImageWidth + u] = 1.9F;
        far_m[v * kImageWidth + u] = 2.1F;
      }
    }
  }
  [[nodiscard]] Frame frame(double time_s = 0) const {
    return {depth_view(depth_m, kImageWidth, kImageHeight), {near_m.data(), far_m.data(), 0}, time_s};
  }
};

/// Where the robot is.
const Capsule kInRobot = Capsule::point({0, 0, 2});

TEST(GridEvaluator, OneCameraSeesAnObstacleBehindTheRobotOnlyInCaseFour) {
  const RobotBeforeWall scene;
  GridEvaluator case_iv(rig_of(1), 0, kDepthCells, letter());
  ASSERT_TRUE(case_iv.update(0, scene.frame()).taken());
  EXPECT_NEAR(case_iv.distance(kInRobot).distance_now_m, 0.1, 0.03);
  GridEvaluator removed(rig_of(1), 0, kDepthCells, letter(RobotPixels::removed));
  ASSERT_TRUE(removed.update(0, scene.frame()).taken());
  EXPECT_EQ(removed.distance(kInRobot).nearest.state, ProximityState::beyond_rho);
  // What stands before the robot, or is read behind it, stays.
  RobotBeforeWall hand;
  RobotBeforeWall behind;
  for (std::size_t i = 0; i < hand.depth_m.size(); ++i) {
    hand.depth_m[i] = hand.near_m[i] > 0 ? 1.5F : hand.depth_m[i];
    behind.depth_m[i] = behind.near_m[i] > 0 ? 2.3F : behind.depth_m[i];
  }
  ASSERT_TRUE(removed.update(0, hand.frame()).taken());
  EXPECT_NEAR(removed.distance(Capsule::point({0, 0, 1.4})).nearest.distance_m, 0.1, 0.03);
  ASSERT_TRUE(removed.update(0, behind.frame()).taken());
  EXPECT_NEAR(removed.distance(Capsule::point({0, 0, 2.2})).nearest.distance_m, 0.1, 0.03);
  // A robot without an end frees nothing.
  RobotBeforeWall endless;
  std::fill(endless.far_m.begin(), endless.far_m.end(), std::numeric_limits<float>::infinity());
  ASSERT_TRUE(removed.update(0, endless.frame()).taken());
  EXPECT_LT(removed.distance(kInRobot).nearest.distance_m, 0.1);
  Frame without_stride = scene.frame();
  without_stride.depth.stride_bytes = 0;
  ASSERT_TRUE(removed.update(0, without_stride).taken());
  EXPECT_EQ(removed.distance(kInRobot).nearest.state, ProximityState::beyond_rho);
}

TEST(GridEvaluator, KnowsNothingToBeFreeWithoutAnImage) {
  for (const RobotPixels robot : {RobotPixels::case_iv, RobotPixels::removed}) {
    GridEvaluator evaluator(rig_of(1), 0, kDepthCells, letter(robot));
    EXPECT_EQ(evaluator.distance(kInRobot).distance_now_m, 0) << "before the first";
    ASSERT_TRUE(evaluator.update(0, RobotBeforeWall().frame()).taken());
    const FrameUpdate update = evaluator.update(0, Frame{});
    EXPECT_EQ(update.result, UpdateResult::unusable);
    EXPECT_THAT(update.reason, HasSubstr("no depth image"));
    EXPECT_EQ(evaluator.distance(kInRobot).distance_now_m, 0);
  }
}

TEST(GridEvaluator, AnswersPointsOnlyAndSaysWhy) {
  const RobotBeforeWall scene;
  GridEvaluator evaluator(rig_of(1), 0, kDepthCells, letter());
  ASSERT_TRUE(evaluator.update(0, scene.frame()).taken());
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const Vector3d p(0.7, 0.3, 3.2);
  const std::array<Capsule, 6> asked{Capsule::point(p),        Capsule::sphere(p, 0.01),     {p, {0.7, 0.4, 3.2}, 0},
                                     Capsule::sphere(p, kNaN), Capsule::point({kNaN, 0, 1}), Capsule{p, p, 0}};
  const std::array<const char*, 6> reasons{nullptr, "a radius", "a length", "a radius", "not finite", nullptr};
  std::array<Answer, 7> answers;
  answers.back().nearest.state = ProximityState::measured;
  evaluator.evaluate(asked, 0, answers);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const char* reason = why_refused(asked[i]);
    ASSERT_EQ(reason == nullptr, reasons[i] == nullptr) << i;
    if (reason != nullptr) {
      EXPECT_THAT(reason, HasSubstr(reasons[i])) << i;
      EXPECT_EQ(answers[i].nearest.state, ProximityState::not_evaluated) << i;
      EXPECT_FALSE(answers[i].distance_now_m >= 0) << i;
    } else {
      EXPECT_NEAR(answers[i].nearest.distance_m, 0.2, 0.02) << i;
      EXPECT_EQ(answers[i].distance_now_m, std::min(answers[i].nearest.distance_m, answers[i].nearest.known_to_m)) << i;
      EXPECT_EQ(answers[i].on_axis_world, p) << i;
      EXPECT_GT(answers[i].obstacle_points, 0) << i;
    }
  }
  EXPECT_EQ(answers.back().nearest.state, ProximityState::not_evaluated) << "no capsule";
}

TEST(GridEvaluator, AnImageCountsAsNewUntilItIsTooOld) {
  GridEvaluator evaluator(rig_of(2), 0, kDepthCells, letter());
  EXPECT_TRUE(std::isnan(evaluator.image_time_s(0)));
  ASSERT_TRUE(evaluator.update(0, RobotBeforeWall().frame(1.0)).taken());
  ASSERT_TRUE(evaluator.update(1, RobotBeforeWall().frame(1.2)).taken());
  EXPECT_EQ(evaluator.image_time_s(0), 1.0);
  EXPECT_EQ(evaluator.image_time_s(1), 1.2);
  EXPECT_TRUE(std::isnan(evaluator.image_time_s(2)));
  const Capsule point = Capsule::point({0.7, 0.3, 3.2});
  std::array<Answer, 1> at_once;
  std::array<Answer, 1> later;
  std::array<Answer, 1> too_late;
  evaluator.evaluate({&point, 1}, 1.2, at_once);
  evaluator.evaluate({&point, 1}, 1.49, later);
  EXPECT_GT(at_once[0].distance_now_m, 0);
  EXPECT_EQ(at_once[0].distance_now_m, later[0].distance_now_m);
  EXPECT_FALSE(later[0].nearest.stale);
  evaluator.evaluate({&point, 1}, 1.51, too_late);
  EXPECT_TRUE(std::isnan(too_late[0].distance_now_m));
  EXPECT_TRUE(too_late[0].nearest.stale);
}

// With the world turned about the camera every place and direction turns along.
TEST(GridEvaluator, PlacesAndDirectionsTurnWithTheCamera) {
  RobotBeforeWall scene;
  for (std::size_t i = 0; i < scene.depth_m.size(); ++i) {
    scene.depth_m[i] = i % kImageWidth < 20 ? 1.8F : 3.4F;  // an edge to one side, so that not all lies straight ahead
    scene.near_m[i] = scene.far_m[i] = 0;
  }
  Rig turned = rig_of(1);
  turned.cameras[0].T_world_camera = look_at({1, -2, 3}, {0.3, 0.4, 0.5});
  const Pose& T = turned.cameras[0].T_world_camera;
  int directions = 0;
  for (const Variant variant : {Variant::letter, Variant::corrected}) {
    EvaluationSettings settings = letter();
    settings.variant = variant;
    settings.sensor.lateral_px = 0;
    GridEvaluator straight(rig_of(1), 0, kDepthCells, settings);
    GridEvaluator other(turned, 0, kDepthCells, settings);
    ASSERT_TRUE(straight.update(0, scene.frame()).taken());
    ASSERT_TRUE(other.update(0, scene.frame()).taken());
    for (const Vector3d& p : {Vector3d(-0.25, 0.1, 1.7), Vector3d(0.1, -0.2, 3.25), Vector3d(0.3, 0.2, 3.2)}) {
      const Answer a = straight.distance(Capsule::point(p));
      const Answer b = other.distance(Capsule::point(T * p));
      directions += a.hybrid_direction_world.norm() > 0.1 ? 1 : 0;
      EXPECT_NEAR(b.nearest.distance_m, a.nearest.distance_m, 1e-6);
      EXPECT_LT((b.nearest.nearest_world - T * a.nearest.nearest_world).norm(), 1e-6);
      EXPECT_LT((b.nearest.direction_world - T.linear() * a.nearest.direction_world).norm(), 1e-6);
      EXPECT_LT((b.hybrid_direction_world - T.linear() * a.hybrid_direction_world).norm(), 1e-6);
    }
  }
  EXPECT_GE(directions, 4) << "hardly anything was near";
}

// What stands in a camera's blind zone it does not see, whether its pose is known exactly or not.
TEST(GridEvaluator, BlindZonesFreeNothingWithAnErrorOfPoseEither) {
  Rig rig = rig_of(2);
  rig.cameras[1].T_world_camera.translation() = Vector3d(0, 0, 1);
  rig.cameras[1].rule.near_m = 0.5;
  const std::vector<float> nothing_m(kImageWidth * kImageHeight, 0.0F);
  const std::vector<float> wall_m(kImageWidth * kImageHeight, 2.4F);
  for (const double error_m : {0.0, 0.001, 0.02}) {
    EvaluationSettings settings;
    settings.sensor.lateral_px = 0;
    settings.pose.translation_m = error_m;
    GridEvaluator evaluator(rig, 0, kDepthCells, settings);
    ASSERT_TRUE(evaluator.update(0, {depth_view(nothing_m, kImageWidth, kImageHeight), {}, 0}).taken());
    ASSERT_TRUE(evaluator.update(1, {depth_view(wall_m, kImageWidth, kImageHeight), {}, 0}).taken());
    for (const double z_m : {1.1, 1.3, 1.48}) {
      EXPECT_LT(evaluator.distance(Capsule::point({0, 0, z_m})).nearest.distance_m, 0.02) << error_m << " at " << z_m;
    }
    const double beyond_m = evaluator.distance(Capsule::point({0, 0, 1.8})).nearest.distance_m;
    EXPECT_LE(beyond_m, 0.3) << "the blind zone's end";
    EXPECT_GT(beyond_m, 0.2) << "this camera alone sees it free";
  }
}

// The same frames one by one, in any order, and all at once.
TEST(GridEvaluator, TakesFramesCameraByCamera) {
  const RobotBeforeWall scene;
  const std::array<Frame, 3> frames{scene.frame(), scene.frame(), scene.frame()};
  EvaluationSettings settings;
  settings.sensor.lateral_px = 0;
  settings.max_frame_age_s = 0.1;
  GridEvaluator all(rig_of(3), 0, kDepthCells, settings);
  ASSERT_TRUE(update_all(all, frames).taken());
  GridEvaluator each(rig_of(3), 0, kDepthCells, settings);
  for (const std::size_t k : {2, 0, 1}) {
    ASSERT_TRUE(each.update(k, frames[k]).taken());
  }
  const auto same = [&](const char* when) {
    for (const Vector3d& p : {Vector3d(0, 0, 2.05), Vector3d(0.1, 0, 3.1), Vector3d(-0.3, 0.2, 2.2)}) {
      const Answer a = all.distance(Capsule::point(p));
      const Answer b = each.distance(Capsule::point(p));
      EXPECT_EQ(a.nearest.distance_m, b.nearest.distance_m) << when;
      EXPECT_EQ(a.nearest.stale, b.nearest.stale) << when;
    }
  };
  same("all");
  EXPECT_FALSE(each.distance(kInRobot).nearest.stale);
  // One camera goes on, the others' frames are then old.
  ASSERT_TRUE(each.update(1, scene.frame(1)).taken());
  EXPECT_TRUE(each.distance(kInRobot).nearest.stale);
  ASSERT_TRUE(each.update(0, scene.frame(1)).taken());
  ASSERT_TRUE(each.update(2, scene.frame(1)).taken());
  EXPECT_FALSE(each.distance(kInRobot).nearest.stale);

  // A camera without a frame has seen nothing, and the first reason is told.
  const FrameUpdate missing = update_all(all, std::span(frames).first(1));
  EXPECT_EQ(missing.result, UpdateResult::unusable);
  EXPECT_THAT(missing.reason, HasSubstr("no depth image"));
  (void)each.update(1, Frame{});
  (void)each.update(2, Frame{});
  same("one");
}

TEST(GridEvaluator, HasNoOtherCamerasAndTheyDoNotMove) {
  const RobotBeforeWall scene;
  const Rig rig = rig_of(2);
  GridEvaluator evaluator(rig, 0, kDepthCells, letter());
  EXPECT_EQ(evaluator.camera_count(), 2U);
  EXPECT_EQ(evaluator.update(2, scene.frame()).result, UpdateResult::unusable);
  EXPECT_THAT(evaluator.update(2, scene.frame()).reason, HasSubstr("no such camera"));
  EXPECT_FALSE(update_all(evaluator, std::array<Frame, 3>{scene.frame(), scene.frame(), scene.frame()}).taken());
  EXPECT_TRUE(evaluator.update(1, scene.frame(), rig.cameras[1].T_world_camera).taken());
  const FrameUpdate moved = evaluator.update(1, scene.frame(), rig.cameras[0].T_world_camera);
  EXPECT_EQ(moved.result, UpdateResult::unusable);
  EXPECT_THAT(moved.reason, HasSubstr("do not move"));

  // A camera that is said to have moved has seen nothing, whatever it saw before.
  GridEvaluator one(rig_of(1), 0, kDepthCells, letter(RobotPixels::removed));
  ASSERT_TRUE(one.update(0, scene.frame()).taken());
  ASSERT_EQ(one.distance(kInRobot).nearest.state, ProximityState::beyond_rho);
  Pose elsewhere = Pose::Identity();
  elsewhere.translation().x() = 1;
  EXPECT_FALSE(one.update(0, scene.frame(), elsewhere).taken());
  EXPECT_EQ(one.distance(kInRobot).nearest.distance_m, 0);
}

}  // namespace
}  // namespace depthgrid::grid
