// What the sources make of an image with a robot in it, of old images and of a budget.
#include <gtest/gtest.h>

#include "avoidance/flat_wall.hpp"
#include "depthgrid/avoidance/grid_distances.hpp"
#include "depthgrid/avoidance/search_distances.hpp"

namespace depthgrid::avoidance {
namespace {

constexpr int kWidth = 64;
constexpr int kHeight = 48;

/// A wall at 3.5 m with a robot before it, 1.9 to 2.1 m deep, in the middle of the image.
struct RobotBeforeWall {
  std::vector<float> depth_m = std::vector<float>(kWidth * kHeight, 3.5F);
  std::vector<float> near_m = std::vector<float>(kWidth * kHeight, 0.0F);
  std::vector<float> far_m = std::vector<float>(kWidth * kHeight, 0.0F);
  RobotBeforeWall() {
    for (std::size_t v = 20; v < 28; ++v) {
      for (std::size_t u = 28; u < 36; ++u) {
        depth_m[v * kWidth + u] = 1.95F;
        near_m[v * kWidth + u] = 1.9F;
        far_m[v * kWidth + u] = 2.1F;
      }
    }
  }
  [[nodiscard]] Frame frame(double time_s) const {
    return {depth_view(depth_m, kWidth, kHeight), {near_m.data(), far_m.data(), 0}, time_s};
  }
};

PartAnswer asked(DistanceSource& source, const Eigen::Vector3d& p_world, double now_s) {
  const Capsule part = Capsule::point(p_world);
  PartAnswer answer;
  source.evaluate({&part, 1}, now_s, {&answer, 1});
  return answer;
}

GridDistancesSettings letter_settings(RobotPixels robot_pixels) {
  GridDistancesSettings settings;
  settings.evaluation.variant = grid::Variant::letter;
  settings.evaluation.collect = grid::Collect::hybrid;
  settings.robot_pixels = robot_pixels;
  return settings;
}

/// 2 m before the camera, where the robot is.
const Eigen::Vector3d kInRobot(0, 0, 0.6);

TEST(GridDistances, OneCameraSeesAnObstacleBehindTheRobotOnlyInCaseFour) {
  const Rig rig = test::one_camera();
  const RobotBeforeWall scene;
  const Frame frame = scene.frame(0);
  GridDistances case_iv(rig, letter_settings(RobotPixels::case_iv));
  ASSERT_TRUE(case_iv.take({&frame, 1}));
  const PartAnswer behind = asked(case_iv, kInRobot, 0);
  ASSERT_TRUE(behind.obstacle.distance_m);
  EXPECT_NEAR(*behind.obstacle.distance_m, 0.1, 0.03);
  GridDistances removed(rig, letter_settings(RobotPixels::removed));
  ASSERT_TRUE(removed.take({&frame, 1}));
  EXPECT_EQ(asked(removed, kInRobot, 0).nearest.state, ProximityState::beyond_rho);
}

TEST(GridDistances, WithoutAnImageKnowNothingToBeFree) {
  const Rig rig = test::one_camera();
  GridDistances source(rig, letter_settings(RobotPixels::removed));
  const Frame none;
  EXPECT_FALSE(source.take({&none, 1}));
  const PartAnswer answer = asked(source, kInRobot, 0);
  EXPECT_EQ(answer.obstacle.distance_m.value_or(0), 0);
}

TEST(SearchDistances, SubtractWhatMayHaveComeNearer) {
  const Rig rig = test::one_camera();
  SearchDistances source(rig, test::search_settings(rig), 1);
  const std::vector<float> wall(kWidth * kHeight, 2.3F);
  const Frame frame{depth_view(wall, kWidth, kHeight), {}, 5.0};
  ASSERT_TRUE(source.take({&frame, 1}));
  const PartAnswer fresh = asked(source, kInRobot, 5.0);
  const PartAnswer later = asked(source, kInRobot, 5.05);
  ASSERT_TRUE(fresh.obstacle.distance_m && later.obstacle.distance_m);
  EXPECT_NEAR(*fresh.obstacle.distance_m, 0.3, 0.06);
  EXPECT_NEAR(*fresh.obstacle.distance_m - *later.obstacle.distance_m, 2 * 0.05, 1e-9);
  EXPECT_EQ(fresh.nearest.distance_m, later.nearest.distance_m);
}

TEST(SearchDistances, KnowNothingAtATimeThatDoesNotFitTheImages) {
  const Rig rig = test::one_camera();
  SearchDistances source(rig, test::search_settings(rig), 1);
  const std::vector<float> wall(kWidth * kHeight, 2.3F);
  const auto at_age = [&](double exposed_s, double age_s) {
    const Frame frame{depth_view(wall, kWidth, kHeight), {}, exposed_s};
    EXPECT_TRUE(source.take({&frame, 1}));
    return asked(source, kInRobot, 5.0 + age_s).obstacle.distance_m;
  };
  const auto fresh = at_age(5.0, 0);
  ASSERT_TRUE(fresh);
  EXPECT_GT(*fresh, 0.2);
  // A little in the future: as old as it is young.
  const auto ahead = at_age(5.0, -0.003);
  ASSERT_TRUE(ahead);
  EXPECT_NEAR(*ahead, *fresh - 2 * 0.003, 1e-9);
  EXPECT_FALSE(at_age(5.0, -0.006));
  EXPECT_FALSE(at_age(5.0, -1.0));
  EXPECT_FALSE(at_age(5.0, Proximity::kNaN));
  EXPECT_FALSE(at_age(Proximity::kNaN, 0)) << "an image without a time";
}

TEST(SearchDistances, AreUnknownWithoutAnImage) {
  const Rig rig = test::one_camera();
  SearchDistances source(rig, test::search_settings(rig), 1);
  EXPECT_FALSE(asked(source, kInRobot, 0).obstacle.distance_m);
}

TEST(SearchDistances, KeepTheirBudgetHoweverSmallItIs) {
  const Rig rig = test::one_camera();
  const RobotBeforeWall scene;
  const Frame frame = scene.frame(0);
  const std::array<Capsule, 2> parts{Capsule::point(kInRobot), Capsule::point(kInRobot)};
  for (std::int64_t nodes = 1; nodes <= 5; ++nodes) {
    SearchDistances source(rig, test::search_settings(rig), 2, {.nodes = nodes, .time_s = 0});
    ASSERT_TRUE(source.take({&frame, 1}));
    std::array<PartAnswer, 2> answers;
    source.evaluate(parts, 0, answers);
    EXPECT_TRUE(answers[0].nearest.budget) << nodes;
    EXPECT_TRUE(answers[1].nearest.budget) << nodes;
  }
}

TEST(SearchDistances, CountAnswersThatABudgetEnded) {
  const Rig rig = test::one_camera();
  const RobotBeforeWall scene;
  const Frame frame = scene.frame(0);
  SearchDistances source(rig, test::search_settings(rig), 1, {.nodes = 4, .time_s = 0});
  ASSERT_TRUE(source.take({&frame, 1}));
  const PartAnswer answer = asked(source, kInRobot, 0);
  EXPECT_TRUE(answer.nearest.budget);
  EXPECT_EQ(source.answered(), 1);
  EXPECT_EQ(source.stopped_by_budget(), 1);
}

TEST(SearchDistances, AnswerNoMoreThanTheyHaveRoomFor) {
  const Rig rig = test::one_camera();
  SearchDistances source(rig, test::search_settings(rig), 1);
  const std::array<Capsule, 2> parts{Capsule::point(kInRobot), Capsule::point(kInRobot)};
  std::array<PartAnswer, 2> answers;
  source.evaluate(parts, 0, answers);
  EXPECT_EQ(answers[1].nearest.state, ProximityState::not_evaluated);
  EXPECT_FALSE(answers[1].obstacle.distance_m);
  EXPECT_EQ(answers[1].at_world, kInRobot);
}

}  // namespace
}  // namespace depthgrid::avoidance
