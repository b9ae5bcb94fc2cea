// What a user of the evaluator relies on: states, bad input, staleness, threads, no allocation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <thread>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/grid/grid_evaluator.hpp"
#include "support/allocation_guard.hpp"

namespace depthgrid::grid {
namespace {

using ::testing::HasSubstr;

constexpr int kWidth = 64;
constexpr int kHeight = 48;
constexpr DepthQuantisation kCells{0.2, 0.01, 0.0, 280};

/// Two cameras that face each other 3 m apart along z; images are filled by hand.
struct TwoCameras {
  Rig rig;
  std::vector<std::vector<float>> depth_m{2, std::vector<float>(kWidth* kHeight, 0.0F)};
  std::vector<std::vector<float>> robot_near_m{2, std::vector<float>(kWidth* kHeight, 0.0F)};
  std::vector<std::vector<float>> robot_far_m{2, std::vector<float>(kWidth* kHeight, 0.0F)};
  std::vector<Frame> frames{2};

  TwoCameras() {
    const PinholeCamera camera{kWidth, kHeight, 52.5, 52.5, 32, 24};
    Pose facing = Pose::Identity();
    facing.linear() = Eigen::Vector3d(-1, 1, -1).asDiagonal();
    facing.translation() = Eigen::Vector3d(0, 0, 3);
    rig = Rig{"pair", {RigCamera{}, RigCamera{}}, std::nullopt};
    for (std::size_t k = 0; k < 2; ++k) {
      rig.cameras[k].id = k == 0 ? "front" : "back";
      rig.cameras[k].intrinsics = camera;
      refer(k);
    }
    rig.cameras[1].T_world_camera = facing;
  }

  void refer(std::size_t k) {
    frames[k].depth = depth_view(std::span<const float>(depth_m[k]), kWidth, kHeight);
    frames[k].robot = {robot_near_m[k].data(), robot_far_m[k].data(), kWidth};
  }
  void fill(std::size_t k, float value_m) { std::fill(depth_m[k].begin(), depth_m[k].end(), value_m); }

  [[nodiscard]] GridEvaluator evaluator(EvaluationSettings settings) const {
    settings.sensor.lateral_px = 0;
    return {rig, 0, kCells, settings};
  }
};

EvaluationSettings of(Variant variant) {
  EvaluationSettings settings;
  settings.variant = variant;
  return settings;
}

class BothVariants : public ::testing::TestWithParam<Variant> {};
INSTANTIATE_TEST_SUITE_P(Variants, BothVariants, ::testing::Values(Variant::letter, Variant::corrected),
                         [](const auto& variant) { return variant.param == Variant::letter ? "letter" : "corrected"; });

TEST_P(BothVariants, BeforeTheFirstFrameNothingIsFree) {
  const TwoCameras two;
  const GridEvaluator evaluator = two.evaluator(of(GetParam()));
  const Answer answer = evaluator.distance(Capsule::point({0, 0, 1.5}));
  EXPECT_NEAR(answer.nearest.distance_m, 0.0, 1e-9);
  EXPECT_EQ(answer.nearest.state, ProximityState::unmeasured);
}

TEST_P(BothVariants, MeasuredSurface) {
  TwoCameras two;
  two.fill(0, 2.0F);
  two.fill(1, 1.0F);
  GridEvaluator evaluator = two.evaluator(of(GetParam()));
  ASSERT_TRUE(update_all(evaluator, two.frames).taken());
  const Answer answer = evaluator.distance(Capsule::point({0, 0, 1.7}));
  EXPECT_NEAR(answer.nearest.distance_m, 0.3, 1e-6);
  EXPECT_EQ(answer.nearest.state, ProximityState::measured);
  ASSERT_TRUE(answer.nearest.camera.has_value());
  EXPECT_LT((answer.nearest.direction_world - Eigen::Vector3d::UnitZ()).norm(), 1e-6);
  EXPECT_LT((answer.nearest.nearest_world - Eigen::Vector3d(0, 0, 2.0)).norm(), 1e-6);
}

TEST_P(BothVariants, TheOtherCameraRemovesTheShadow) {
  TwoCameras two;
  two.fill(0, 0.5F);   // something close to the front camera shadows the whole space
  two.fill(1, 2.35F);  // and the back camera sees up to it
  GridEvaluator both = two.evaluator(of(GetParam()));
  ASSERT_TRUE(update_all(both, two.frames).taken());
  const Answer fused = both.distance(Capsule::point({0.01, 0.01, 1.2}));
  EXPECT_EQ(fused.nearest.state, ProximityState::beyond_rho);
  EXPECT_EQ(fused.nearest.distance_m, 0.4);
  EXPECT_TRUE(fused.nearest.nearest_world.array().isNaN().all());

  TwoCameras one = two;
  one.rig.cameras.pop_back();
  one.frames.pop_back();
  one.refer(0);
  GridEvaluator single = one.evaluator(of(GetParam()));
  ASSERT_TRUE(update_all(single, one.frames).taken());
  const Answer shadow = single.distance(Capsule::point({0.01, 0.01, 1.2}));
  EXPECT_NEAR(shadow.nearest.distance_m, 0.0, 1e-9);
  EXPECT_EQ(shadow.nearest.state, ProximityState::occluded);
  EXPECT_TRUE(shadow.nearest.direction_world.isZero());
}

TEST_P(BothVariants, AMissingCameraFreesNothing) {
  TwoCameras two;
  two.fill(0, 0.5F);
  two.fill(1, 2.35F);
  GridEvaluator evaluator = two.evaluator(of(GetParam()));
  std::vector<Frame> frames = two.frames;
  frames[1].depth = {};
  EXPECT_FALSE(update_all(evaluator, frames).taken());
  EXPECT_NEAR(evaluator.distance(Capsule::point({0, 0, 1.2})).nearest.distance_m, 0.0, 1e-9);
  frames[1] = two.frames[1];
  frames[1].depth.width_px = kWidth / 2;
  EXPECT_FALSE(update_all(evaluator, frames).taken()) << "another size than the calibration";
  EXPECT_NEAR(evaluator.distance(Capsule::point({0, 0, 1.2})).nearest.distance_m, 0.0, 1e-9);
  EXPECT_FALSE(update_all(evaluator, std::span<const Frame>(two.frames).first(1)).taken());
  EXPECT_NEAR(evaluator.distance(Capsule::point({0, 0, 1.2})).nearest.distance_m, 0.0, 1e-9);
  EXPECT_TRUE(update_all(evaluator, two.frames).taken());
  EXPECT_EQ(evaluator.distance(Capsule::point({0, 0, 1.2})).nearest.state, ProximityState::beyond_rho);
}

TEST_P(BothVariants, AnUnusableFrameFreesNothing) {
  TwoCameras two;
  two.fill(0, 0.5F);
  two.fill(1, 2.35F);
  GridEvaluator evaluator = two.evaluator(of(GetParam()));
  const Eigen::Vector3d p(0, 0, 1.2);
  ASSERT_TRUE(update_all(evaluator, two.frames).taken());
  ASSERT_EQ(evaluator.distance(Capsule::point(p)).nearest.state, ProximityState::beyond_rho);
  const auto refused = [&](auto&& change) {
    std::vector<Frame> frames = two.frames;
    change(frames[1]);
    return !update_all(evaluator, frames).taken() && evaluator.distance(Capsule::point(p)).nearest.distance_m < 1e-9;
  };
  EXPECT_TRUE(refused([](Frame& f) { f.robot.far_m = nullptr; })) << "half a robot view";
  EXPECT_TRUE(refused([](Frame& f) { f.robot.stride_px = 3; })) << "robot rows that overlap";
  EXPECT_TRUE(refused([](Frame& f) { f.depth.stride_bytes = 4; })) << "rows that overlap";
  const std::vector<std::uint16_t> units(kWidth * kHeight, 2350);
  EXPECT_TRUE(refused([&](Frame& f) { f.depth = depth_view(units, kWidth, kHeight, 0.01); }))
      << "another depth scale than the rig";
  std::vector<Frame> frames = two.frames;
  frames[1].depth = depth_view(units, kWidth, kHeight, 0.001);
  EXPECT_TRUE(update_all(evaluator, frames).taken());
  frames[1] = two.frames[1];
  frames[1].depth.stride_bytes = 0;  // a view made by hand: rows without padding
  frames[1].robot.stride_px = 0;
  EXPECT_TRUE(update_all(evaluator, frames).taken());
  EXPECT_EQ(evaluator.distance(Capsule::point(p)).nearest.state, ProximityState::beyond_rho);
}

TEST_P(BothVariants, AnEndlessRobotIsNoRobot) {
  TwoCameras two;
  two.fill(0, 1.45F);
  two.fill(1, 0.0F);
  std::fill(two.robot_near_m[0].begin(), two.robot_near_m[0].end(), 1.4F);
  std::fill(two.robot_far_m[0].begin(), two.robot_far_m[0].end(), std::numeric_limits<float>::infinity());
  GridEvaluator evaluator = two.evaluator(of(GetParam()));
  ASSERT_TRUE(update_all(evaluator, two.frames).taken());
  EXPECT_NEAR(evaluator.distance(Capsule::point({0, 0, 1.25})).nearest.distance_m, 0.2, 1e-6);
}

TEST_P(BothVariants, WhatTheRobotHidesIsNotMeasured) {
  TwoCameras two;
  two.fill(0, 1.0F);
  std::fill(two.robot_near_m[0].begin(), two.robot_near_m[0].end(), 0.995F);
  std::fill(two.robot_far_m[0].begin(), two.robot_far_m[0].end(), 1.008F);
  GridEvaluator evaluator = two.evaluator(of(GetParam()));
  ASSERT_TRUE(update_all(evaluator, two.frames).taken());
  const Answer answer = evaluator.distance(Capsule::point({0, 0, 0.9}));
  EXPECT_LT(answer.nearest.distance_m, 0.13);
  EXPECT_EQ(answer.nearest.state, ProximityState::occluded);
}

TEST_P(BothVariants, AbsurdRadiiAndPointsEndInAState) {
  TwoCameras two;
  two.fill(0, 2.0F);
  two.fill(1, 0.9F);
  EvaluationSettings settings = of(GetParam());
  settings.rho_m = 1e12;
  GridEvaluator evaluator = two.evaluator(settings);
  ASSERT_TRUE(update_all(evaluator, two.frames).taken());
  EXPECT_NEAR(evaluator.distance(Capsule::point({0, 0, 1.7})).nearest.distance_m, 0.3, 1e-6);
  for (const double huge : {1e300, -1e308, 1.7e308}) {
    EXPECT_EQ(evaluator.distance(Capsule::point({huge, huge, huge})).nearest.state, ProximityState::outside);
    EXPECT_EQ(evaluator.distance(Capsule::point({huge, 0, 1})).nearest.state, ProximityState::outside);
  }
}

TEST_P(BothVariants, AnswersWithoutAPointKeepNothing) {
  TwoCameras two;
  two.fill(0, 2.0F);
  GridEvaluator evaluator = two.evaluator(of(GetParam()));
  (void)update_all(evaluator, two.frames);
  std::vector<Answer> answers(2);
  const std::array<Capsule, 2> points{Capsule::point({0, 0, 1.5}), Capsule::point({0, 0, 1.6})};
  evaluator.evaluate(points, 0, answers);
  EXPECT_NE(answers[1].nearest.state, ProximityState::not_evaluated);
  evaluator.evaluate(std::span(points).first(1), 0, answers);
  EXPECT_EQ(answers[1].nearest.state, ProximityState::not_evaluated);
}

TEST_P(BothVariants, APoseThatIsSlightlyOffIsMadeExact) {
  TwoCameras two;
  two.fill(0, 2.0F);
  two.fill(1, 0.9F);
  two.rig.cameras[0].T_world_camera.linear() *= 1.0004;
  GridEvaluator evaluator = two.evaluator(of(GetParam()));
  ASSERT_TRUE(update_all(evaluator, two.frames).taken());
  EXPECT_NEAR(evaluator.distance(Capsule::point({0, 0, 1.7})).nearest.distance_m, 0.3, 1e-6);
}

TEST_P(BothVariants, PointsOutsideTheGridHaveNoDistance) {
  TwoCameras two;
  two.fill(0, 2.0F);
  GridEvaluator evaluator = two.evaluator(of(GetParam()));
  (void)update_all(evaluator, two.frames);
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(0, 0, 0.1), Eigen::Vector3d(0, 0, 5),
                                   Eigen::Vector3d(3, 0, 1), Eigen::Vector3d(0, 0, 0)}) {
    const Answer answer = evaluator.distance(Capsule::point(p));
    EXPECT_EQ(answer.nearest.state, ProximityState::outside) << p.transpose();
    EXPECT_TRUE(std::isnan(answer.nearest.distance_m));
  }
}

TEST_P(BothVariants, SpaceOutsideTheGridAsObstacle) {
  TwoCameras two;
  two.fill(0, 2.9F);
  two.fill(1, 2.9F);
  EvaluationSettings settings = of(GetParam());
  settings.outside = OutsideSpace::obstacle;
  GridEvaluator evaluator = two.evaluator(settings);
  (void)update_all(evaluator, two.frames);
  const Answer near_end = evaluator.distance(Capsule::point({0, 0, 0.25}));
  EXPECT_EQ(near_end.nearest.state, ProximityState::outside);
  EXPECT_NEAR(near_end.nearest.distance_m, 0.05, 1e-12);
  EXPECT_LT((near_end.nearest.direction_world + Eigen::Vector3d::UnitZ()).norm(), 1e-9);
  const Answer beyond = evaluator.distance(Capsule::point({0, 0, 5}));
  EXPECT_EQ(beyond.nearest.distance_m, 0.0);
  // Ignored: the same point says how far its answer is known.
  GridEvaluator ignoring = two.evaluator(of(GetParam()));
  (void)update_all(ignoring, two.frames);
  const Answer open = ignoring.distance(Capsule::point({0, 0, 0.25}));
  EXPECT_EQ(open.nearest.state, ProximityState::beyond_rho);
  EXPECT_NEAR(open.nearest.known_to_m, 0.05, 1e-12);
  EXPECT_NEAR(lower_bound_after(open.nearest, 0.01, 1.0), 0.04, 1e-12) << "something may stand at the border";
}

TEST_P(BothVariants, NonFinitePointsAreNotEvaluated) {
  TwoCameras two;
  two.fill(0, 2.0F);
  GridEvaluator evaluator = two.evaluator(of(GetParam()));
  (void)update_all(evaluator, two.frames);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Vector3d p(0, 0, 1.5);
      p[axis] = bad;
      const Answer answer = evaluator.distance(Capsule::point(p));
      EXPECT_EQ(answer.nearest.state, ProximityState::not_evaluated);
      EXPECT_TRUE(std::isnan(answer.nearest.distance_m));
    }
  }
}

TEST_P(BothVariants, TheRobotIsNoObstacleButWhatItHidesIs) {
  TwoCameras two;
  // A robot plate 0.1 m thick between both cameras, seen by both; each frees the space up to the plate's far side.
  for (std::size_t k = 0; k < 2; ++k) {
    two.fill(k, 1.45F);
    std::fill(two.robot_near_m[k].begin(), two.robot_near_m[k].end(), 1.4F);
    std::fill(two.robot_far_m[k].begin(), two.robot_far_m[k].end(), 1.6F);
  }
  GridEvaluator evaluator = two.evaluator(of(GetParam()));
  ASSERT_TRUE(update_all(evaluator, two.frames).taken());
  const Answer on_robot = evaluator.distance(Capsule::point({0.01, 0.01, 1.5}));
  EXPECT_EQ(on_robot.nearest.state, ProximityState::beyond_rho) << "each camera frees what is behind it for the other";

  // A hand in front of the robot's image is not inside the robot's interval: it stays an obstacle.
  two.fill(0, 1.2F);
  ASSERT_TRUE(update_all(evaluator, two.frames).taken());
  const Answer hand = evaluator.distance(Capsule::point({0.01, 0.01, 1.0}));
  EXPECT_NEAR(hand.nearest.distance_m, 0.2, 0.011);

  // The back camera alone lost: the space behind the robot is unknown.
  two.fill(0, 1.45F);
  two.fill(1, 0.0F);
  ASSERT_TRUE(update_all(evaluator, two.frames).taken());
  const Answer behind = evaluator.distance(Capsule::point({0.01, 0.01, 1.55}));
  EXPECT_LT(behind.nearest.distance_m, 0.07);
  EXPECT_GT(behind.nearest.distance_m, 0.03);
}

TEST_P(BothVariants, AnOldFrameMakesAnswersStale) {
  TwoCameras two;
  two.fill(0, 2.0F);
  EvaluationSettings settings = of(GetParam());
  settings.max_frame_age_s = 0.05;
  GridEvaluator evaluator = two.evaluator(settings);
  two.frames[0].time_s = 10.00;
  two.frames[1].time_s = 10.04;
  (void)update_all(evaluator, two.frames);
  EXPECT_FALSE(evaluator.distance(Capsule::point({0, 0, 1.5})).nearest.stale);
  for (const double bad : {10.06, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    two.frames[1].time_s = bad;
    (void)update_all(evaluator, two.frames);
    EXPECT_TRUE(evaluator.distance(Capsule::point({0, 0, 1.5})).nearest.stale) << bad;
  }
}

TEST_P(BothVariants, TheCallsAllocateNothing) {
  DEPTHGRID_REQUIRE_ALLOCATION_COUNT();
  for (const Collect collect : {Collect::minimum, Collect::hybrid}) {
    TwoCameras two;
    two.fill(0, 0.5F);
    two.fill(1, 1.5F);
    EvaluationSettings settings = of(GetParam());
    settings.collect = collect;
    GridEvaluator evaluator = two.evaluator(settings);
    const std::vector<Capsule> points{Capsule::point({0, 0, 1.2}), Capsule::point({0.1, 0.1, 1.4}),
                                      Capsule::point({0, 0, 9})};
    std::vector<Answer> answers(points.size());
    const test::AllocationGuard guard;
    (void)update_all(evaluator, two.frames);
    evaluator.evaluate(points, 0, answers);
    EXPECT_EQ(guard.allocations(), 0);
  }
}

TEST_P(BothVariants, ManyThreadsGetTheSameAnswers) {
  TwoCameras two;
  two.fill(0, 0.7F);
  two.fill(1, 1.4F);
  GridEvaluator evaluator = two.evaluator(of(GetParam()));
  (void)update_all(evaluator, two.frames);
  std::vector<Capsule> points;
  for (int i = 0; i < 40; ++i) {
    points.push_back(Capsule::point({0.01 * i - 0.2, 0.05, 1.0 + 0.02 * i}));
  }
  std::vector<Answer> expected(points.size());
  evaluator.evaluate(points, 0, expected);
  std::vector<std::vector<Answer>> answers(4, std::vector<Answer>(points.size()));
  std::vector<std::thread> threads;
  threads.reserve(answers.size());
  for (auto& mine : answers) {
    threads.emplace_back([&] { evaluator.evaluate(points, 0, mine); });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (const auto& mine : answers) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_EQ(mine[i].nearest.distance_m, expected[i].nearest.distance_m);
      EXPECT_EQ(mine[i].nearest.state, expected[i].nearest.state);
    }
  }
}

TEST(Corrected, MarginsOnlyBringObstaclesNearer) {
  TwoCameras two;
  two.fill(0, 2.0F);
  two.fill(1, 0.9F);
  const Eigen::Vector3d p(0.01, 0.01, 1.7);
  const auto distance = [&](const EvaluationSettings& settings) {
    GridEvaluator evaluator = two.evaluator(settings);
    (void)update_all(evaluator, two.frames);
    return evaluator.distance(Capsule::point(p)).nearest.distance_m;
  };
  EvaluationSettings settings = of(Variant::corrected);
  const double ideal = distance(settings);
  settings.sensor.constant_m = 0.03;
  const double sensor = distance(settings);
  EXPECT_NEAR(ideal - sensor, 0.03, 1e-6);
  // Each part of e counts, and once.
  const double turned_m = 1.97 - 1.97 / (1 + 0.01);  // where z + 0.01 z reaches the wall less the sensor's margin
  for (const auto& [pose, nearer_m] :
       {std::pair{PoseMargin{0.02, 0, 0}, 0.02}, std::pair{PoseMargin{0, 0.01, 0}, turned_m},
        std::pair{PoseMargin{0, 0, 0.02}, 0.02}}) {
    settings.pose = pose;
    const double erring = distance(settings);
    EXPECT_LE(erring, sensor - nearer_m + 1e-6);
    EXPECT_GE(erring, sensor - nearer_m - kCells.step_m - 1e-6) << "at most one cell more";
  }
}

TEST(Evaluator, RefusesBadSettings) {
  const TwoCameras two;
  const auto message = [&](auto&& change) -> std::string {
    EvaluationSettings settings;
    Rig rig = two.rig;
    std::size_t principal = 0;
    change(settings, rig, principal);
    try {
      const GridEvaluator evaluator(rig, principal, kCells, settings);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(message([](auto& s, auto&, auto&) { s.rho_m = 0; }), HasSubstr("rho is 0 m, must be a positive"));
  EXPECT_THAT(message([](auto& s, auto&, auto&) { s.rho_m = NAN; }), HasSubstr("rho is nan m"));
  EXPECT_THAT(message([](auto& s, auto&, auto&) { s.direction_blend = 2; }), HasSubstr("direction_blend is 2"));
  EXPECT_THAT(message([](auto& s, auto&, auto&) { s.max_frame_age_s = -1; }), HasSubstr("max_frame_age is -1 s"));
  EXPECT_THAT(message([](auto& s, auto&, auto&) { s.sensor.lateral_px = -1; }), HasSubstr("-1"));
  EXPECT_THAT(message([](auto& s, auto&, auto&) { s.pose.rotation_rad = NAN; }), HasSubstr("nan"));
  EXPECT_THAT(message([](auto&, auto&, auto& p) { p = 7; }), HasSubstr("principal camera is 7, the rig has 2 cameras"));
  EXPECT_THAT(message([](auto&, auto& r, auto&) { r.cameras[1].id = "front"; }), HasSubstr("'front' occurs twice"));
  EXPECT_THAT(message([](auto&, auto& r, auto&) { r.cameras[1].intrinsics.fx_px = -5; }),
              HasSubstr("camera 'back': fx is -5 px"));
  EXPECT_THAT(message([](auto&, auto& r, auto&) {
                r.cameras[1].distortion.model = Distortion::Model::plumb_bob;
                r.cameras[1].distortion.coefficients[0] = 0.1;
              }),
              HasSubstr("camera 'back' has lens distortion"));
  EXPECT_THAT(message([](auto&, auto& r, auto&) { r.cameras[1].T_world_camera.translation().x() = 5e6; }),
              HasSubstr("translation reaches 5000000 m, must be at most 100000"));
  EXPECT_THAT(message([](auto&, auto& r, auto&) { r.cameras[1].intrinsics.fx_px = 1e9; }),
              HasSubstr("fx is 1000000000 px, must be at most 1000000"));
  EXPECT_THAT(message([](auto&, auto& r, auto&) {
                r.T_floor_world = Pose::Identity();
                r.T_floor_world->linear() *= 1.1;
              }),
              HasSubstr("T_floor_world: rotation deviates"));
}

}  // namespace
}  // namespace depthgrid::grid
