// Distances asked for in a thread of their own: lower bounds of what the search says of the capsules as they are now.
#include "depthgrid/search/asking_thread.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "search/search_setup.hpp"
#include "support/allocation_guard.hpp"
#include "support/random_run.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::search {
namespace {

using Eigen::Vector3d;
using reference::Random;
using reference::RandomProblem;
using ::testing::HasSubstr;

constexpr double kSpeed_m_s = 1.5;

/// A random problem before an evaluator, all its images at time 0.
struct Cell {
  RandomProblem problem;
  SearchSetup setup;

  explicit Cell(std::uint64_t seed) {
    reference::RandomOptions options;
    options.seed = seed;
    options.cameras = 2;
    options.width_px = 32;
    problem = reference::make_random_problem(options);
    setup = make_setup(problem, SpaceKind::box, true);
    setup.settings.v_max_m_s = kSpeed_m_s;
  }
  void feed(DistanceEvaluator& evaluator) const {
    for (std::size_t k = 0; k < problem.frames.size(); ++k) {
      Frame frame = problem.frames[k];
      frame.time_s = 0;
      ASSERT_TRUE(evaluator.update(k, frame).taken());
    }
  }
};

/// Asks until the thread has answered a question that was put after this call began.
void wait_for_an_answer(AskingThread& asking, std::span<const Capsule> capsules, double now_s) {
  const std::uint64_t before = asking.answered();
  std::vector<Answer> answers(capsules.size());
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (asking.answered() < before + 2) {
    ASSERT_LT(std::chrono::steady_clock::now(), deadline);
    asking.evaluate(capsules, now_s, answers);
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  asking.evaluate(capsules, now_s, answers);  // both may have come since the last call, which took neither
}

TEST(AskingThread, SaysTheSameOfCapsulesThatStandStillAndLessOfThoseThatMove) {
  const auto run = test::random_run(40);
  int above_zero = 0;
  for (std::int64_t i = 0; i < run.count; ++i) {
    const Cell cell(run.seed + static_cast<std::uint64_t>(i));
    SearchEvaluator direct(cell.setup.rig, cell.setup.settings);
    SearchEvaluator behind(cell.setup.rig, cell.setup.settings);
    AskingThread asking(behind, {.capsules = 3, .period_s = 1e-4, .max_age_s = 10});
    cell.feed(direct);
    cell.feed(asking);
    Random random(run.seed + static_cast<std::uint64_t>(i));
    std::vector<Capsule> capsules(3);
    for (Capsule& capsule : capsules) {
      const Vector3d a_world = random.in_cube(0.5);
      capsule = {a_world, a_world + random.in_cube(0.1), 0.03};
    }
    std::vector<Answer> expected(3);
    std::vector<Answer> answers(3);
    wait_for_an_answer(asking, capsules, 0.01);
    direct.evaluate(capsules, 0.01, expected);
    asking.evaluate(capsules, 0.01, answers);
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_EQ(answers[k].nearest.distance_m, expected[k].nearest.distance_m) << run.reproduce();
      ASSERT_EQ(answers[k].distance_now_m, expected[k].distance_now_m) << run.reproduce();
    }
    // The robot moves: whatever question the answers are of, they stay below what the search would say now.
    for (int step = 1; step <= 20; ++step) {
      for (Capsule& capsule : capsules) {
        capsule.a += random.in_cube(0.01);
        capsule.b += random.in_cube(0.01);
      }
      const double now_s = 0.01 + 0.002 * step;
      asking.evaluate(capsules, now_s, answers);
      direct.evaluate(capsules, now_s, expected);
      for (std::size_t k = 0; k < 3; ++k) {
        // Cells lie still in W, so both are distances to the same set.
        ASSERT_LE(answers[k].distance_now_m, expected[k].distance_now_m + 1e-9)
            << "step " << step << ", " << run.reproduce();
        above_zero += answers[k].distance_now_m > 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(above_zero, 0);
}

TEST(AskingThread, AnswersThatAreTooOldAreNone) {
  const Cell cell(1);
  SearchEvaluator behind(cell.setup.rig, cell.setup.settings);
  AskingThread asking(behind, {.capsules = 1, .period_s = 1e-4, .max_age_s = 0.05});
  cell.feed(asking);
  const Capsule point = Capsule::point(Vector3d::Zero());
  Answer answer;
  asking.evaluate({&point, 1}, 0.01, {&answer, 1});
  EXPECT_EQ(answer.nearest.state, ProximityState::not_evaluated) << "nobody has asked before";
  wait_for_an_answer(asking, {&point, 1}, 0.01);
  asking.evaluate({&point, 1}, 0.01, {&answer, 1});
  EXPECT_NE(answer.nearest.state, ProximityState::not_evaluated);
  // What was answered last was asked for 0.01 s.
  asking.evaluate({&point, 1}, 0.0601, {&answer, 1});
  EXPECT_EQ(answer.nearest.state, ProximityState::not_evaluated);
  EXPECT_TRUE(std::isnan(answer.distance_now_m));
  // Nor is it known what was there before.
  asking.evaluate({&point, 1}, 0.0099, {&answer, 1});
  EXPECT_EQ(answer.nearest.state, ProximityState::not_evaluated);
}

TEST(AskingThread, PassesOnWhereCamerasStandAndWhenTheySaw) {
  const Cell cell(5);
  SearchEvaluator behind(cell.setup.rig, cell.setup.settings);
  AskingThread asking(behind, {.capsules = 1, .period_s = 1e-4, .max_age_s = 10});
  const Capsule point = Capsule::point(Vector3d::Zero());
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_TRUE(std::isnan(asking.image_time_s(k))) << "there is no answer yet";
    Pose elsewhere = cell.setup.rig.cameras[k].T_world_camera;
    elsewhere.translation().x() += 0.01;
    Frame frame = cell.problem.frames[k];
    frame.time_s = 0.001 * static_cast<double>(k + 1);
    ASSERT_TRUE(asking.update(k, frame, elsewhere).taken());
    EXPECT_EQ(behind.store().snapshot().T_world_camera(k).translation(), elsewhere.translation());
  }
  wait_for_an_answer(asking, {&point, 1}, 0.01);
  EXPECT_EQ(asking.image_time_s(0), 0.001);
  EXPECT_EQ(asking.image_time_s(1), 0.002);
  EXPECT_TRUE(std::isnan(asking.image_time_s(2)));
}

TEST(AskingThread, WhatWasNotAskedOrHasNoRoomIsNotEvaluated) {
  const Cell cell(2);
  SearchEvaluator behind(cell.setup.rig, cell.setup.settings);
  AskingThread asking(behind, {.capsules = 2, .period_s = 1e-4, .max_age_s = 10});
  cell.feed(asking);
  const std::vector<Capsule> three(3, Capsule::point(Vector3d::Zero()));
  wait_for_an_answer(asking, three, 0.01);
  std::vector<Answer> answers(4);
  answers[3].nearest.state = ProximityState::measured;
  asking.evaluate(three, 0.01, answers);
  EXPECT_NE(answers[1].nearest.state, ProximityState::not_evaluated);
  EXPECT_EQ(answers[2].nearest.state, ProximityState::not_evaluated);
  EXPECT_EQ(answers[3].nearest.state, ProximityState::not_evaluated);
  EXPECT_EQ(asking.update(7, {}).result, UpdateResult::unusable);
}

TEST(AskingThread, AskingDoesNotAllocate) {
  DEPTHGRID_REQUIRE_ALLOCATION_COUNT();
  const Cell cell(3);
  SearchEvaluator behind(cell.setup.rig, cell.setup.settings);
  AskingThread asking(behind);
  cell.feed(asking);
  const Capsule point = Capsule::point(Vector3d::Zero());
  Answer answer;
  const test::AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    asking.evaluate({&point, 1}, 0.01, {&answer, 1});
  }
  EXPECT_EQ(guard.allocations(), 0);
}

TEST(AskingThread, RefusesWhatMakesNoSense) {
  const Cell cell(4);
  SearchEvaluator behind(cell.setup.rig, cell.setup.settings);
  const auto message = [&](const AskingOptions& options) {
    return test::thrown_message([&] { const AskingThread asking(behind, options); });
  };
  EXPECT_THAT(message({.capsules = 0}), HasSubstr("room for 0 capsules"));
  EXPECT_THAT(message({.period_s = 0}), HasSubstr("period 0 s"));
  EXPECT_THAT(message({.period_s = Proximity::kNaN}), HasSubstr("period nan s"));
  EXPECT_THAT(message({.period_s = 0.2, .max_age_s = 0.1}), HasSubstr("age of 0.1 s"));
}

}  // namespace
}  // namespace depthgrid::search
