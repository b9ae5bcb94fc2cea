// The loop: what it refuses, what it does with nothing near and with nothing known, and that it does not allocate.
#include "depthgrid/avoidance/avoidance_loop.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "avoidance/flat_wall.hpp"
#include "depthgrid/avoidance/search_distances.hpp"
#include "depthgrid/robot/frame_intake.hpp"
#include "support/allocation_guard.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::avoidance {
namespace {

using depthgrid::test::AllocationGuard;
using depthgrid::test::thrown_message;
using ::testing::HasSubstr;

constexpr double kPeriod = 0.002;

class Loop : public ::testing::Test {
 protected:
  robot::RobotModel model_ = robot::kuka_lwr4();
  robot::JointHistory history_{7, 256, 0.02, 0.01};
  NoDistances nothing_;
};

TEST_F(Loop, RefusesSettingsThatDoNotFit) {
  const auto refused = [&](const LoopSettings& settings) {
    return thrown_message([&] { AvoidanceLoop(model_, history_, nothing_, settings); });
  };
  const LoopSettings good = test::loop_settings(model_, robot::nine_control_points(model_));
  EXPECT_EQ(refused(good), "");
  LoopSettings bad = good;
  bad.parts.clear();
  EXPECT_THAT(refused(bad), HasSubstr("no part of the robot"));
  bad = good;
  bad.parts[3].link = 99;
  EXPECT_THAT(refused(bad), HasSubstr("link 99"));
  bad = good;
  bad.evaluate_every = 0;
  EXPECT_THAT(refused(bad), HasSubstr("every 0 periods"));
}

/// An arm that can be told to fail. Counts the commands.
class FailingArm final : public control::RobotPort {
 public:
  explicit FailingArm(control::SimulatedArm& arm) : arm_(arm) {}
  bool read(control::JointState& state) noexcept override { return readable && arm_.read(state); }
  bool write(const control::JointCommand& command) noexcept override {
    ++written;
    return arm_.write(command);
  }
  bool readable = true;
  int written = 0;

 private:
  control::SimulatedArm& arm_;
};

TEST_F(Loop, CommandsNothingBeforeAStartThatSucceeded) {
  const LoopSettings settings = test::loop_settings(model_, robot::nine_control_points(model_));
  AvoidanceLoop loop(model_, history_, nothing_, settings);
  control::SimulatedArm arm(settings.controller.limits, kPeriod, test::bent());
  FailingArm port(arm);
  EXPECT_FALSE(loop.cycle(port, 0)) << "never started";
  port.readable = false;
  EXPECT_FALSE(loop.start(port));
  port.readable = true;
  EXPECT_FALSE(loop.cycle(port, kPeriod)) << "the start failed";
  EXPECT_EQ(port.written, 0);
  std::vector<double> q(7);
  EXPECT_EQ(history_.at(kPeriod, q).answer, robot::JointAnswer::no_samples);

  ASSERT_TRUE(loop.start(port));
  EXPECT_TRUE(loop.cycle(port, 2 * kPeriod));
  EXPECT_EQ(port.written, 1);
  EXPECT_LT((loop.report().output.command.position_rad - test::bent()).norm(), 0.01);

  // A second start that fails ends the first.
  port.readable = false;
  EXPECT_FALSE(loop.start(port));
  port.readable = true;
  EXPECT_FALSE(loop.cycle(port, 3 * kPeriod));
  EXPECT_EQ(port.written, 1);
}

TEST_F(Loop, AddsNoPositionToTheHistoryWithoutAState) {
  const LoopSettings settings = test::loop_settings(model_, robot::nine_control_points(model_));
  robot::JointHistory history(7, 256, 1.5 * kPeriod, 0.0);  // a missing sample leaves a gap
  AvoidanceLoop loop(model_, history, nothing_, settings);
  control::SimulatedArm arm(settings.controller.limits, kPeriod, test::bent());
  FailingArm port(arm);
  ASSERT_TRUE(loop.start(port));
  std::vector<double> q(7);
  for (int k = 0; k < 10; ++k) {
    port.readable = k != 5;
    EXPECT_EQ(loop.cycle(port, k * kPeriod), k != 5) << k;
    EXPECT_EQ(port.written, k + 1) << "it goes on commanding";
    EXPECT_EQ(history.at(k * kPeriod, q).known(), k != 5) << k;
    arm.advance();
  }
  EXPECT_EQ(history.at(4.5 * kPeriod, q).answer, robot::JointAnswer::gap);
  EXPECT_EQ(history.at(5 * kPeriod, q).answer, robot::JointAnswer::gap);
  EXPECT_TRUE(history.at(6 * kPeriod, q).known());
}

TEST_F(Loop, FollowsTheHexagonWithNothingNear) {
  const LoopSettings settings = test::loop_settings(model_, robot::nine_control_points(model_));
  AvoidanceLoop loop(model_, history_, nothing_, settings);
  control::SimulatedArm arm(settings.controller.limits, kPeriod, test::bent());
  ASSERT_TRUE(loop.start(arm));
  for (int k = 0; k < 3000; ++k) {
    ASSERT_TRUE(loop.cycle(arm, k * kPeriod)) << k;
    EXPECT_EQ(loop.report().output.repulsion_m_s.norm(), 0);
    arm.advance();
  }
  // 6 s at 0.2 m an edge and 0.40 m/s, corners included.
  EXPECT_GE(loop.task().vertices_reached(), 8);
}

TEST_F(Loop, StandsWhereNoCameraHasSeenAnything) {
  const Rig rig = test::one_camera();
  LoopSettings settings = test::loop_settings(model_, robot::moving_capsules(model_));
  settings.end_effector_limits = true;
  SearchDistances source(rig, test::search_settings(rig), settings.parts.size());
  AvoidanceLoop loop(model_, history_, source, settings);
  control::SimulatedArm arm(settings.controller.limits, kPeriod, test::bent());
  ASSERT_TRUE(loop.start(arm));
  (void)loop.cycle(arm, 0);
  const Eigen::Vector3d start_world = loop.report().end_effector_world;
  for (int k = 1; k < 200; ++k) {
    arm.advance();
    (void)loop.cycle(arm, k * kPeriod);
  }
  for (const PartAnswer& answer : loop.answers()) {
    EXPECT_EQ(answer.obstacle.distance_m.value_or(0), 0);
  }
  // The law of the risk leaves 1 - f(0) of the task, and of each joint's speed.
  const auto& repulsion = settings.controller.repulsion;
  const double left_m = (1 - control::risk(0.0, repulsion.rho_m, repulsion.alpha)) * settings.task.speed_m_s * 0.4;
  EXPECT_LE((loop.report().end_effector_world - start_world).norm(), left_m + 1e-9);
  EXPECT_LT(left_m, 0.0005);
}

TEST_F(Loop, DoesNotAllocateWithTheSearch) {
  DEPTHGRID_REQUIRE_ALLOCATION_COUNT();
  const Rig rig = test::one_camera();
  LoopSettings settings = test::loop_settings(model_, robot::moving_capsules(model_));
  settings.end_effector_limits = true;
  SearchDistances source(rig, test::search_settings(rig), settings.parts.size());
  AvoidanceLoop loop(model_, history_, source, settings);
  robot::FrameIntake intake(rig, model_, history_, {});
  control::SimulatedArm arm(settings.controller.limits, kPeriod, test::bent());
  ASSERT_TRUE(loop.start(arm));
  const std::vector<std::uint16_t> wall(64UL * 48UL, 3500);
  const DepthView view = depth_view(wall, 64, 48, 0.001);
  bool working = true;
  for (int k = 0; k < 60; ++k) {
    const AllocationGuard guard;
    working = loop.cycle(arm, k * kPeriod) && working;
    if (k % 10 == 0) {
      working = source.take(intake.frames({&view, 1}, k * kPeriod)) && working;
    }
    arm.advance();
    ASSERT_EQ(guard.allocations(), 0) << "cycle " << k;
  }
  EXPECT_TRUE(working);
  EXPECT_GT(source.answered(), 0);
}

TEST(RobotParts, BeginWithTheFlangeAndLeaveTheBaseOut) {
  const robot::RobotModel model = robot::kuka_lwr4();
  const auto points = robot::nine_control_points(model);
  ASSERT_EQ(points.size(), 9U);
  EXPECT_EQ(points.front().link, model.link_index("lwr_7_link"));
  for (const robot::LinkCapsule& point : points) {
    EXPECT_EQ(point.capsule.radius_m, 0);
    EXPECT_EQ(point.capsule.a, point.capsule.b);
  }
  const auto capsules = robot::moving_capsules(model);
  ASSERT_EQ(capsules.size(), 6U);
  EXPECT_EQ(capsules.front().link, model.link_index("lwr_7_link"));
  EXPECT_EQ(capsules.back().link, model.link_index("lwr_2_link"));
  EXPECT_EQ(robot::moving_capsules(model, 1).size(), 7U);
  EXPECT_THAT(thrown_message([&] { (void)robot::moving_capsules(model, 9); }), HasSubstr("moved by 9 joints"));
}

}  // namespace
}  // namespace depthgrid::avoidance
