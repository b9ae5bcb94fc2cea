// The loop: what it refuses, what it does with nothing near and with nothing known, and that it does not allocate.
#include "depthgrid/avoidance/avoidance_loop.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "avoidance/flat_wall.hpp"
#include "depthgrid/avoidance/history_port.hpp"
#include "depthgrid/avoidance/nothing_near.hpp"
#include "depthgrid/robot/frame_intake.hpp"
#include "depthgrid/search/search_evaluator.hpp"
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
  control::PolygonTask task_{test::hexagon(model_)};
  NothingNear nothing_;
};

TEST_F(Loop, RefusesSettingsThatDoNotFit) {
  const auto refused = [&](const LoopSettings& settings) {
    return thrown_message([&] { AvoidanceLoop({model_}, task_, nothing_, settings); });
  };
  const LoopSettings good = test::loop_settings(robot::nine_control_points(model_));
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
  bool read(control::JointState& state) noexcept override {
    if (!readable || !arm_.read(state)) {
      return false;
    }
    if (other_joints) {
      state.position_rad = control::JointVector::Zero(3);
    }
    return true;
  }
  bool write(const control::JointCommand& command) noexcept override {
    ++written;
    return arm_.write(command);
  }
  bool readable = true;
  bool other_joints = false;
  int written = 0;

 private:
  control::SimulatedArm& arm_;
};

TEST_F(Loop, CommandsNothingBeforeAStartThatSucceeded) {
  const LoopSettings settings = test::loop_settings(robot::nine_control_points(model_));
  AvoidanceLoop loop({model_}, task_, nothing_, settings);
  control::SimulatedArm arm(settings.controller.limits, kPeriod, test::bent());
  FailingArm failing(arm);
  HistoryPort port(failing, history_);
  EXPECT_FALSE(loop.cycle(port, 0)) << "never started";
  failing.readable = false;
  EXPECT_FALSE(loop.start(port));
  failing.readable = true;
  EXPECT_FALSE(loop.cycle(port, kPeriod)) << "the start failed";
  EXPECT_EQ(failing.written, 0);
  std::vector<double> q(7);
  EXPECT_EQ(history_.at(kPeriod, q).answer, robot::JointAnswer::no_samples);

  ASSERT_TRUE(loop.start(port));
  EXPECT_TRUE(loop.cycle(port, 2 * kPeriod));
  EXPECT_EQ(failing.written, 1);
  EXPECT_LT((loop.report().output.command.position_rad - test::bent()).norm(), 0.01);

  // A second start that fails ends the first.
  failing.readable = false;
  EXPECT_FALSE(loop.start(port));
  failing.readable = true;
  EXPECT_FALSE(loop.cycle(port, 3 * kPeriod));
  EXPECT_EQ(failing.written, 1);
}

TEST_F(Loop, TakesAStateOfAnotherRobotForNone) {
  const LoopSettings settings = test::loop_settings(robot::nine_control_points(model_));
  AvoidanceLoop loop({model_}, task_, nothing_, settings);
  control::SimulatedArm arm(settings.controller.limits, kPeriod, test::bent());
  FailingArm port(arm);
  ASSERT_TRUE(loop.start(port));
  EXPECT_TRUE(loop.cycle(port, kPeriod));
  const Eigen::Vector3d before_world = loop.report().end_effector_world;
  port.other_joints = true;
  EXPECT_FALSE(loop.cycle(port, 2 * kPeriod));
  EXPECT_EQ(loop.report().end_effector_world, before_world) << "stands where the last state had it";
  EXPECT_TRUE(loop.report().output.command.position_rad.allFinite());
}

TEST_F(Loop, RefusesABaseThatIsNotRigid) {
  const LoopSettings settings = test::loop_settings(robot::nine_control_points(model_));
  Pose scaled = Pose::Identity();
  scaled.linear() *= 1000.0;
  EXPECT_THROW(AvoidanceLoop({model_, scaled}, task_, nothing_, settings), Error);
}

TEST_F(Loop, AddsNoPositionToTheHistoryWithoutAState) {
  const LoopSettings settings = test::loop_settings(robot::nine_control_points(model_));
  robot::JointHistory history(7, 256, 1.5 * kPeriod, 0.0);  // a missing sample leaves a gap
  AvoidanceLoop loop({model_}, task_, nothing_, settings);
  control::SimulatedArm arm(settings.controller.limits, kPeriod, test::bent());
  FailingArm failing(arm);
  HistoryPort port(failing, history);
  ASSERT_TRUE(loop.start(port));
  std::vector<double> q(7);
  for (int k = 0; k < 10; ++k) {
    failing.readable = k != 5;
    EXPECT_EQ(loop.cycle(port, k * kPeriod), k != 5) << k;
    EXPECT_EQ(failing.written, k + 1) << "it goes on commanding";
    EXPECT_EQ(history.at(k * kPeriod, q).known(), k != 5) << k;
    arm.advance();
  }
  EXPECT_EQ(history.at(4.5 * kPeriod, q).answer, robot::JointAnswer::gap);
  EXPECT_EQ(history.at(5 * kPeriod, q).answer, robot::JointAnswer::gap);
  EXPECT_TRUE(history.at(6 * kPeriod, q).known());
}

TEST_F(Loop, FollowsTheHexagonWithNothingNear) {
  const LoopSettings settings = test::loop_settings(robot::nine_control_points(model_));
  AvoidanceLoop loop({model_}, task_, nothing_, settings);
  control::SimulatedArm arm(settings.controller.limits, kPeriod, test::bent());
  ASSERT_TRUE(loop.start(arm));
  for (int k = 0; k < 3000; ++k) {
    ASSERT_TRUE(loop.cycle(arm, k * kPeriod)) << k;
    EXPECT_EQ(loop.report().output.repulsion_m_s.norm(), 0);
    arm.advance();
  }
  // 6 s at 0.2 m an edge and 0.40 m/s, corners included.
  EXPECT_GE(task_.vertices_reached(), 8);
}

TEST_F(Loop, StandsWhereNoCameraHasSeenAnything) {
  const Rig rig = test::one_camera();
  LoopSettings settings = test::loop_settings(robot::moving_capsules(model_));
  settings.end_effector_limits = true;
  search::SearchEvaluator evaluator(rig, test::search_settings(rig), {.directions = 1});
  AvoidanceLoop loop({model_}, task_, evaluator, settings);
  control::SimulatedArm arm(settings.controller.limits, kPeriod, test::bent());
  ASSERT_TRUE(loop.start(arm));
  (void)loop.cycle(arm, 0);
  const Eigen::Vector3d start_world = loop.report().end_effector_world;
  for (int k = 1; k < 200; ++k) {
    arm.advance();
    (void)loop.cycle(arm, k * kPeriod);
  }
  for (const Answer& answer : loop.answers()) {
    EXPECT_EQ(control::obstacle_of(answer, control::BlindLayer::kept_clear).distance_m.value_or(0), 0);
  }
  // The law of the risk leaves 1 - f(0) of the task, and of each joint's speed.
  const auto& repulsion = settings.controller.repulsion;
  const double left_m =
      (1 - control::risk(0.0, repulsion.rho_m, repulsion.alpha)) * test::hexagon(model_).speed_m_s * 0.4;
  EXPECT_LE((loop.report().end_effector_world - start_world).norm(), left_m + 1e-9);
  EXPECT_LT(left_m, 0.0005);
}

TEST_F(Loop, DoesNotAllocateWithTheSearch) {
  DEPTHGRID_REQUIRE_ALLOCATION_COUNT();
  const Rig rig = test::one_camera();
  LoopSettings settings = test::loop_settings(robot::moving_capsules(model_));
  settings.end_effector_limits = true;
  search::SearchEvaluator evaluator(rig, test::search_settings(rig), {.directions = 1});
  AvoidanceLoop loop({model_}, task_, evaluator, settings);
  robot::FrameIntake intake(rig, {model_}, history_, {});
  control::SimulatedArm arm(settings.controller.limits, kPeriod, test::bent());
  HistoryPort port(arm, history_);
  ASSERT_TRUE(loop.start(port));
  const std::vector<std::uint16_t> wall(64UL * 48UL, 3500);
  bool working = true;
  for (int k = 0; k < 60; ++k) {
    const AllocationGuard guard;
    working = loop.cycle(port, k * kPeriod) && working;
    if (k % 10 == 0) {
      const Frame seen{depth_view(wall, 64, 48, 0.001), {}, k * kPeriod};
      working = update_all(evaluator, intake.frames({&seen, 1})).taken() && intake.report()[0].robot_removed && working;
    }
    arm.advance();
    ASSERT_EQ(guard.allocations(), 0) << "cycle " << k;
  }
  EXPECT_TRUE(working);
  EXPECT_NE(loop.answers()[0].nearest.state, ProximityState::not_evaluated);
}

/// Says of every part that something is so far away in this direction, with a layer so thick.
class Says final : public DistanceEvaluator {
 public:
  [[nodiscard]] std::string_view name() const noexcept override { return "says"; }
  [[nodiscard]] std::size_t camera_count() const noexcept override { return 0; }
  [[nodiscard]] double image_time_s(std::size_t) const noexcept override { return Proximity::kNaN; }
  [[nodiscard]] FrameUpdate update(std::size_t, const Frame&) noexcept override { return {}; }
  [[nodiscard]] FrameUpdate update(std::size_t, const Frame&, const Pose&) noexcept override { return {}; }
  void evaluate(std::span<const Capsule> capsules, double, std::span<Answer> answers) noexcept override {
    for (std::size_t i = 0; i < answers.size(); ++i) {
      answers[i] = Answer{};
      answers[i].nearest = {.distance_m = distance_m,
                            .nearest_world = capsules[i].a + distance_m * towards,
                            .direction_world = towards,
                            .state = ProximityState::measured,
                            .camera = std::nullopt};
      answers[i].distance_now_m = distance_m;
      answers[i].on_axis_world = capsules[i].a;
      answers[i].hybrid_direction_world = towards;
      answers[i].blind_m = blind_m;
    }
  }
  double distance_m = 1;
  double blind_m = 0;
  Eigen::Vector3d towards = Eigen::Vector3d::UnitX();
};

/// What the arm has done after half a second of cycles.
struct Moved {
  control::JointVector command_rad;
  CycleReport report;
  std::vector<PartState> states;
};

class BlindLoop : public Loop {
 protected:
  Moved moved(double distance_m, double blind_m, control::BlindLayer layer = control::BlindLayer::kept_clear) {
    LoopSettings settings = test::loop_settings(robot::moving_capsules(model_));
    settings.end_effector_limits = true;
    settings.blind_layer = layer;
    Says says;
    says.distance_m = distance_m;
    says.blind_m = blind_m;
    control::PolygonTask task(test::hexagon(model_));
    AvoidanceLoop loop({model_}, task, says, settings);
    control::SimulatedArm arm(settings.controller.limits, kPeriod, test::bent());
    EXPECT_TRUE(loop.start(arm));
    for (int k = 0; k < 250; ++k) {
      EXPECT_TRUE(loop.cycle(arm, k * kPeriod));
      arm.advance();
    }
    return {loop.report().output.command.position_rad, loop.report(), {loop.states().begin(), loop.states().end()}};
  }
};

// The layer is no distance: with it 0.1 m thick an obstacle at 0.3 m is as near as one at 0.2 m without.
TEST_F(BlindLoop, CountsDistancesFromTheSurfaceOfTheLayer) {
  for (const double clear_m : {0.02, 0.1, 0.2, 0.35}) {
    const Moved bare = moved(clear_m, 0);
    for (const double blind_m : {0.05, 0.158, 0.35}) {
      const Moved padded = moved(clear_m + blind_m, blind_m);
      EXPECT_LT((padded.command_rad - bare.command_rad).norm(), 1e-6) << clear_m << ", " << blind_m;
      EXPECT_EQ(padded.report.blind_m, blind_m);
      EXPECT_EQ(padded.report.in_blind_layer + padded.report.unknown, 0);
    }
  }
}

TEST_F(BlindLoop, TakesADistanceWithinTheLayerForContactAndSaysSo) {
  const Moved contact = moved(0, 0);
  EXPECT_EQ(contact.report.in_blind_layer, 0) << "there is no layer";
  for (const double distance_m : {0.0, 0.05, 0.158}) {
    const Moved within = moved(distance_m, 0.158);
    EXPECT_LT((within.command_rad - contact.command_rad).norm(), 1e-6) << distance_m;
    EXPECT_EQ(within.report.in_blind_layer, static_cast<int>(within.states.size()));
    for (const PartState state : within.states) {
      EXPECT_EQ(to_string(state), "blind layer");
    }
  }
}

TEST_F(BlindLoop, UsesNoDistanceWithoutItsLayer) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const Moved unstated = moved(0.3, kNaN);
  EXPECT_LT((unstated.command_rad - moved(kNaN, 0).command_rad).norm(), 1e-6) << "as where no distance is known";
  EXPECT_EQ(unstated.report.unknown, static_cast<int>(unstated.states.size()));
  EXPECT_TRUE(std::isnan(unstated.report.blind_m));
  EXPECT_EQ(to_string(unstated.states[0]), "unknown");
}

TEST_F(BlindLoop, MayIgnoreTheLayerAsTheLettersLoopDoes) {
  const Moved ignored = moved(0.2, 0.15, control::BlindLayer::ignored);
  EXPECT_LT((ignored.command_rad - moved(0.2, 0).command_rad).norm(), 1e-6);
  EXPECT_GT((ignored.command_rad - moved(0.2, 0.15).command_rad).norm(), 1e-4);
  EXPECT_EQ(ignored.report.in_blind_layer, 0);
  EXPECT_EQ(ignored.report.blind_m, 0.15) << "it is reported all the same";
}

/// Keeps the flange where and as it is: six rows.
class Hold final : public control::MotionTask {
 public:
  explicit Hold(Pose T_world_tip) : T_world_tip_(std::move(T_world_tip)) {}
  control::Task rows(const control::EndEffector& tip) noexcept override {
    ++asked;
    time_s = tip.time_s;
    const Eigen::AngleAxisd turn(T_world_tip_.linear() * tip.T_world_tip.linear().transpose());
    control::TaskVector velocity(6);
    velocity << T_world_tip_.translation() - tip.T_world_tip.translation(), turn.angle() * turn.axis();
    return {tip.jacobian, 5.0 * velocity};
  }
  int asked = 0;
  double time_s = -1;

 private:
  Pose T_world_tip_;
};

// Whatever a loop has done before, after start() it does what a new one does: no memory of contacts or directions, no
// old answers, and a clock that may begin anew.
TEST_F(Loop, StartsAgainAsANewOneDoes) {
  LoopSettings settings = test::loop_settings(robot::moving_capsules(model_));
  settings.end_effector_limits = true;
  settings.evaluate_every = 7;
  settings.controller.pivot = control::PivotSettings{};
  Pose goal = test::flange(model_);
  goal.translation() += Eigen::Vector3d(0.1, 0, 0.1);
  Hold task(goal);
  const auto run = [&](AvoidanceLoop& loop, Says& says, const Eigen::Vector3d& towards, bool contact, double start_s) {
    control::SimulatedArm arm(settings.controller.limits, kPeriod, test::bent());
    EXPECT_TRUE(loop.start(arm));
    std::vector<control::JointVector> commands;
    for (int k = 0; k < 40; ++k) {
      // At contact there is no direction: one may be remembered from before.
      const bool touches = contact && k < settings.evaluate_every;
      says.distance_m = touches ? 0.0 : 0.15;
      says.towards = touches ? Eigen::Vector3d::Zero() : towards;
      EXPECT_TRUE(loop.cycle(arm, start_s + k * kPeriod));
      EXPECT_EQ(loop.report().evaluated, k % settings.evaluate_every == 0) << k;
      commands.push_back(loop.report().output.command.position_rad);
      arm.advance();
    }
    return commands;
  };
  for (const auto& [brakes, contact] : {std::pair(false, false), std::pair(false, true), std::pair(true, true)}) {
    Says says_used;
    Says says_new;
    AvoidanceLoop used({model_}, task, says_used, settings);
    (void)run(used, says_used, Eigen::Vector3d(0.6, 0, 0.8), contact, 100);
    if (brakes) {
      control::SimulatedArm arm(settings.controller.limits, kPeriod, test::bent());
      EXPECT_FALSE(used.cycle(arm, 1)) << "the clock went back";
    }
    AvoidanceLoop fresh({model_}, task, says_new, settings);
    const Eigen::Vector3d towards(0, 0.6, -0.8);
    EXPECT_EQ(run(used, says_used, towards, contact, 50), run(fresh, says_new, towards, contact, 50));
    EXPECT_EQ(used.report().reason.limit, fresh.report().reason.limit);
  }
}

TEST_F(Loop, MovesByATaskOfSixRows) {
  Pose goal = test::flange(model_);
  goal.translation() += Eigen::Vector3d(0.05, 0, -0.05);
  goal.rotate(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()));
  // Where the base stands elsewhere the whole task does.
  robot::PlacedRobot placed{model_};
  placed.T_world_base.translation() = Eigen::Vector3d(1, -2, 0.7);
  placed.T_world_base.linear() = Eigen::AngleAxisd(2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Hold task(placed.T_world_base * goal);
  const LoopSettings settings = test::loop_settings(robot::nine_control_points(model_));
  AvoidanceLoop loop(placed, task, nothing_, settings);
  control::SimulatedArm arm(settings.controller.limits, kPeriod, test::bent());
  ASSERT_TRUE(loop.start(arm));
  for (int k = 0; k < 1000; ++k) {
    ASSERT_TRUE(loop.cycle(arm, k * kPeriod)) << k;
    arm.advance();
  }
  EXPECT_EQ(task.asked, 1000);
  EXPECT_EQ(task.time_s, 999 * kPeriod);
  const Pose& reached = loop.T_world_link()[model_.link_index("lwr_7_link")];
  EXPECT_LT((reached.matrix() - (placed.T_world_base * goal).matrix()).cwiseAbs().maxCoeff(), 0.001);
}

}  // namespace
}  // namespace depthgrid::avoidance
