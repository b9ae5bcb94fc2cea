// Every way to be blind ends in a stop that says why: faults at random times of random motions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "avoidance/flat_wall.hpp"
#include "depthgrid/avoidance/avoidance_loop.hpp"
#include "support/random_run.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::avoidance {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kLoopPeriod = 0.002;
constexpr double kNaN = Proximity::kNaN;

/// Two cameras that may freeze. Where one has, what is not measured is unknown and near.
class TwoCameras final : public DistanceEvaluator {
 public:
  [[nodiscard]] std::string_view name() const noexcept override { return "two cameras"; }
  [[nodiscard]] std::size_t camera_count() const noexcept override { return 2; }
  [[nodiscard]] double image_time_s(std::size_t camera) const noexcept override {
    return std::min(frozen_from_s[camera], now_s_);  // NaN: there is no image
  }
  [[nodiscard]] FrameUpdate update(std::size_t, const Frame&) noexcept override { return {}; }
  [[nodiscard]] FrameUpdate update(std::size_t, const Frame&, const Pose&) noexcept override { return {}; }
  void evaluate(std::span<const Capsule> capsules, double now_s, std::span<Answer> answers) noexcept override {
    now_s_ = now_s;
    for (std::size_t i = 0; i < answers.size(); ++i) {
      const double away_m = i < of_part_m.size() ? of_part_m[i] : distance_m;
      answers[i] = Answer{};
      answers[i].nearest.distance_m = away_m;
      answers[i].nearest.nearest_world = capsules[i].a + Eigen::Vector3d(away_m, 0, 0);
      answers[i].nearest.direction_world = Eigen::Vector3d::UnitX();
      answers[i].hybrid_direction_world = Eigen::Vector3d::UnitX();
      answers[i].nearest.state = state;
      answers[i].distance_now_m = away_m;
      answers[i].on_axis_world = capsules[i].a;
      answers[i].blind_m = i < layer_of_part_m.size() ? layer_of_part_m[i] : 0;
    }
  }
  std::array<double, 2> frozen_from_s{1e9, 1e9};
  [[nodiscard]] ImpossibleSurfaces impossible() const noexcept override { return found; }
  [[nodiscard]] Past past(const Proximity& nearest) const noexcept override {
    asked_world = nearest.nearest_world;
    return remembered;
  }

  double distance_m = 5;
  std::vector<double> of_part_m, layer_of_part_m;  ///< of the first parts, where they are others
  ProximityState state = ProximityState::measured;
  ImpossibleSurfaces found;
  Past remembered;
  mutable Eigen::Vector3d asked_world = Eigen::Vector3d::Zero();

 private:
  double now_s_ = kNaN;
};

enum class Fault : std::uint8_t { no_state, state_not_finite, other_robot, clock_back, clock_nan, cameras_freeze };
constexpr std::array kFaults{Fault::no_state,   Fault::state_not_finite, Fault::other_robot,
                             Fault::clock_back, Fault::clock_nan,        Fault::cameras_freeze};

MotionLimit expected(Fault fault) {
  switch (fault) {
    case Fault::clock_back:
    case Fault::clock_nan:
      return MotionLimit::clock;
    case Fault::cameras_freeze:
      return MotionLimit::no_images;
    default:
      return MotionLimit::no_joint_state;
  }
}

/// An arm whose states go missing.
class Arm final : public control::RobotPort {
 public:
  explicit Arm(control::SimulatedArm& arm) : arm_(arm) {}
  bool read(control::JointState& state) noexcept override {
    if (!arm_.read(state) || (fault && *fault == Fault::no_state)) {
      return false;
    }
    if (fault && *fault == Fault::state_not_finite) {
      state.position_rad[3] = kNaN;
    }
    if (fault && *fault == Fault::other_robot) {
      state.position_rad = control::JointVector::Zero(3);
    }
    return true;
  }
  bool write(const control::JointCommand& command) noexcept override { return arm_.write(command); }
  std::optional<Fault> fault;

 private:
  control::SimulatedArm& arm_;
};

class BlindStop : public ::testing::Test {
 protected:
  BlindStop() { settings_.end_effector_limits = true; }
  robot::RobotModel model_ = robot::kuka_lwr4();
  LoopSettings settings_ = test::loop_settings(robot::nine_control_points(model_));
  TwoCameras cameras_;
  std::array<char, 480> buffer_{};
};

TEST_F(BlindStop, EndsMotionWithinTheJointsOwnDeceleration) {
  const auto run = depthgrid::test::random_run(1200);
  const control::JointVector& a = settings_.controller.limits.acceleration_rad_s2;
  double longest_s = 0;
  double fastest_rad_s = 0;
  for (std::int64_t i = 0; i < run.count; ++i) {
    std::mt19937_64 random(run.seed + static_cast<std::uint64_t>(i));
    const Fault fault = kFaults[static_cast<std::size_t>(i) % kFaults.size()];
    const int at = std::uniform_int_distribution(50, 600)(random);
    control::PolygonSettings polygon = test::hexagon(model_);
    polygon.speed_m_s = std::uniform_real_distribution(0.1, 0.6)(random);
    control::PolygonTask task(polygon);
    cameras_ = {};
    AvoidanceLoop loop({model_}, task, cameras_, settings_);
    control::SimulatedArm simulated(settings_.controller.limits, kLoopPeriod, test::bent());
    Arm arm(simulated);
    ASSERT_TRUE(loop.start(arm));
    for (int k = 0; k < at; ++k) {
      ASSERT_TRUE(loop.cycle(arm, k * kLoopPeriod));
      ASSERT_FALSE(brakes(loop.report().reason.limit));
      simulated.advance();
    }
    // Cameras are believed for a while: what follows is asked for after that.
    const int late = fault == Fault::cameras_freeze ? static_cast<int>(settings_.max_image_age_s / kLoopPeriod) + 1 : 0;
    cameras_.frozen_from_s.fill(fault == Fault::cameras_freeze ? (at - 1) * kLoopPeriod : 1e9);
    for (int k = at; k < at + late; ++k) {
      (void)loop.cycle(arm, k * kLoopPeriod);
      simulated.advance();
    }
    arm.fault = fault;
    const control::JointCommand before = loop.report().output.command;
    const double standing_s = (before.velocity_rad_s.array().abs() / a.array()).maxCoeff() + 2 * kLoopPeriod;
    control::JointVector way_rad = control::JointVector::Zero(7);
    int periods = 0;
    for (int k = at + late; k < at + late + 600; ++k, ++periods) {
      const double now_s = fault == Fault::clock_back ? 0.0 : fault == Fault::clock_nan ? kNaN : k * kLoopPeriod;
      const control::JointVector was_rad = loop.report().output.command.position_rad;
      EXPECT_EQ(loop.cycle(arm, now_s), fault == Fault::cameras_freeze);
      ASSERT_EQ(loop.report().reason.limit, expected(fault)) << run.reproduce() << ", case " << i;
      const control::JointCommand& command = loop.report().output.command;
      way_rad += (command.position_rad - was_rad).cwiseAbs();
      simulated.advance();
      if (command.velocity_rad_s.cwiseAbs().maxCoeff() == 0) {
        break;
      }
    }
    ASSERT_LE(periods * kLoopPeriod, standing_s) << run.reproduce() << ", case " << i;
    for (int j = 0; j < 7; ++j) {
      const double v = std::abs(before.velocity_rad_s[j]);
      ASSERT_LE(way_rad[j], v * v / (2 * a[j]) + v * kLoopPeriod + 1e-12) << run.reproduce() << ", case " << i;
    }
    longest_s = std::max(longest_s, periods * kLoopPeriod);
    fastest_rad_s = std::max(fastest_rad_s, before.velocity_rad_s.cwiseAbs().maxCoeff());
  }
  EXPECT_GT(fastest_rad_s, 0.3) << "nothing to stop";
  RecordProperty("longest_s", std::to_string(longest_s));
}

TEST_F(BlindStop, GoesOnWhenTheStateIsBack) {
  control::PolygonTask task(test::hexagon(model_));
  AvoidanceLoop loop({model_}, task, cameras_, settings_);
  control::SimulatedArm simulated(settings_.controller.limits, kLoopPeriod, test::bent());
  Arm arm(simulated);
  ASSERT_TRUE(loop.start(arm));
  for (int k = 0; k < 900; ++k) {
    arm.fault = k >= 300 && k < 600 ? std::optional(Fault::no_state) : std::nullopt;
    EXPECT_EQ(loop.cycle(arm, k * kLoopPeriod), !arm.fault.has_value()) << k;
    EXPECT_EQ(loop.report().evaluated, !arm.fault.has_value());
    simulated.advance();
    if (k == 599) {
      EXPECT_EQ(loop.report().output.command.velocity_rad_s.norm(), 0);
      EXPECT_NEAR(loop.report().reason.late_s, 0.6, 1e-9);
    }
  }
  EXPECT_GT(loop.report().output.command.velocity_rad_s.norm(), 0.1);
  EXPECT_EQ(simulated.not_followed(), 0);
}

TEST_F(BlindStop, AsksAtOnceWhenTheStateIsBack) {
  settings_.evaluate_every = 5;
  control::PolygonTask task(test::hexagon(model_));
  AvoidanceLoop loop({model_}, task, cameras_, settings_);
  control::SimulatedArm simulated(settings_.controller.limits, kLoopPeriod, test::bent());
  Arm arm(simulated);
  ASSERT_TRUE(loop.start(arm));
  for (int k = 0; k < 20; ++k) {
    arm.fault = k == 11 || k == 12 ? std::optional(Fault::no_state) : std::nullopt;
    (void)loop.cycle(arm, k * kLoopPeriod);
    EXPECT_EQ(loop.report().evaluated, k == 0 || k == 5 || k == 10 || k == 13 || k == 18) << k;
    simulated.advance();
  }
}

// The joints brake alike, but a long tool goes farther than the flange that holds it.
TEST_F(BlindStop, TellsTheWayOfThePartThatGoesFarthest) {
  const auto way_m = [&](double tool_m) {
    settings_.parts[0].capsule = Capsule::point({0, 0, tool_m});
    control::PolygonTask task(test::hexagon(model_));
    AvoidanceLoop loop({model_}, task, cameras_, settings_);
    control::SimulatedArm simulated(settings_.controller.limits, kLoopPeriod, test::bent());
    Arm arm(simulated);
    EXPECT_TRUE(loop.start(arm));
    for (int k = 0; k < 200; ++k) {
      EXPECT_TRUE(loop.cycle(arm, k * kLoopPeriod));
      simulated.advance();
    }
    arm.fault = Fault::no_state;
    EXPECT_FALSE(loop.cycle(arm, 200 * kLoopPeriod));
    return loop.report().reason.braking_m;
  };
  const double of_flange_m = way_m(0);
  EXPECT_GT(of_flange_m, 0.001);
  EXPECT_GT(way_m(2), 1.5 * of_flange_m);
}

TEST_F(BlindStop, ALostCameraLimitsMotionAndDoesNotPush) {
  for (const ProximityState state : {ProximityState::unmeasured, ProximityState::measured}) {
    cameras_ = {};
    control::PolygonTask task(test::hexagon(model_));
    AvoidanceLoop loop({model_}, task, cameras_, settings_);
    control::SimulatedArm arm(settings_.controller.limits, kLoopPeriod, test::bent());
    ASSERT_TRUE(loop.start(arm));
    double fastest_m_s = 0;
    for (int k = 0; k < 1500; ++k) {
      if (k == 250) {
        cameras_.frozen_from_s[1] = 0.5;  // the first one goes on
      }
      const bool lost = k * kLoopPeriod > 0.5 + settings_.max_image_age_s;
      cameras_.distance_m = lost ? 0.02 : 5;
      cameras_.state = state;
      ASSERT_TRUE(loop.cycle(arm, k * kLoopPeriod));
      arm.advance();
      EXPECT_EQ(loop.report().lost_cameras, lost ? 1 : 0) << k;
      if (lost) {
        fastest_m_s = std::max(fastest_m_s, loop.report().output.repulsion_m_s.norm());
        EXPECT_EQ(loop.report().reason.late_camera, std::optional<std::size_t>(1));
      }
    }
    if (state == ProximityState::measured) {
      EXPECT_GT(fastest_m_s, 0.1) << "what the other camera measures does push";
    } else {
      EXPECT_EQ(fastest_m_s, 0) << "unknown space does not";
      EXPECT_LT(loop.report().output.command.velocity_rad_s.norm(), 0.01);
      EXPECT_THAT(
          std::string(describe(loop.report().reason, buffer_)),
          AllOf(HasSubstr("0.02 m from space without a reading"), HasSubstr("; camera 1: last image 2.5 s ago")));
    }
  }
}

TEST_F(BlindStop, ReasonsAreOneSentence) {
  const auto sentence = [&](const MotionReason& reason) { return std::string(describe(reason, buffer_)); };
  MotionReason reason;
  EXPECT_EQ(sentence(reason), "nothing is within the laws' range");
  reason.part = 3;
  reason.link = "lwr_4_link";
  reason.clear_m = 0.123;
  reason.braking_m = 0.0456;
  const std::array<std::pair<MotionLimit, const char*>, 7> all{{
      {MotionLimit::obstacle, "part 3 (lwr_4_link) is 0.123 m from a surface, stands within 0.0456 m"},
      {MotionLimit::budget,
       "part 3 (lwr_4_link) is at least 0.123 m away, the budget ended the search, stands within 0.0456 m"},
      {MotionLimit::blind_layer,
       "part 3 (lwr_4_link) is nearer to something than its blind layer is thick, stands within 0.0456 m"},
      {MotionLimit::unknown_distance, "part 3 (lwr_4_link) has no distance, stands within 0.0456 m"},
      {MotionLimit::no_images, "braking: no camera has a new image, stands within 0.0456 m"},
      {MotionLimit::no_joint_state, "braking: no joint state for ? s, stands within 0.0456 m"},
      {MotionLimit::clock, "braking: the clock went back, stands still or is not a number, stands within 0.0456 m"},
  }};
  reason.state = ProximityState::measured;
  for (const auto& [limit, words] : all) {
    reason.limit = limit;
    EXPECT_EQ(sentence(reason), words);
    EXPECT_EQ(brakes(limit), std::string(words).starts_with("braking"));
  }
  reason.braking_m = 0.008331;
  EXPECT_THAT(sentence(reason), HasSubstr("stands within 0.0084 m")) << "rounded up";
  reason.braking_m = 1.51e-30;
  EXPECT_THAT(sentence(reason), HasSubstr("stands within 0 m"));
  reason.limit = MotionLimit::no_images;
  reason.late_camera = 2;
  EXPECT_THAT(sentence(reason), HasSubstr("; camera 2 has no image"));
  std::array<char, 10> small{};
  EXPECT_EQ(describe(reason, small), "braking: n");
}

TEST_F(BlindStop, SaysThatAnAssumptionIsBroken) {
  control::PolygonTask task(test::hexagon(model_));
  AvoidanceLoop loop({model_}, task, cameras_, settings_);
  control::SimulatedArm simulated(settings_.controller.limits, kLoopPeriod, test::bent());
  Arm arm(simulated);
  ASSERT_TRUE(loop.start(arm));
  ASSERT_TRUE(loop.cycle(arm, 1));
  EXPECT_EQ(describe(loop.report().reason, buffer_), "nothing is within the laws' range");
  cameras_.found.images = 3;
  cameras_.found.time_s = 0.75;
  ASSERT_TRUE(loop.cycle(arm, 1.25));
  EXPECT_EQ(loop.report().impossible.images, 3);
  EXPECT_THAT(
      std::string(describe(loop.report().reason, buffer_)),
      HasSubstr("; 3 images show a surface where nothing could be, last 0.5 s ago: v_max, calibration or clock"));
  arm.fault = Fault::no_state;
  ASSERT_FALSE(loop.cycle(arm, 1.35));
  EXPECT_THAT(std::string(describe(loop.report().reason, buffer_)), HasSubstr("last 0.6 s ago"));
}

TEST_F(BlindStop, SaysSinceWhenSomethingMayBeThere) {
  control::PolygonTask task(test::hexagon(model_));
  cameras_.distance_m = 0.25;
  cameras_.state = ProximityState::occluded;
  AvoidanceLoop loop({model_}, task, cameras_, settings_);
  control::SimulatedArm simulated(settings_.controller.limits, kLoopPeriod, test::bent());
  ASSERT_TRUE(loop.start(simulated));
  ASSERT_TRUE(loop.cycle(simulated, 3));
  EXPECT_THAT(std::string(describe(loop.report().reason, buffer_)),
              HasSubstr(" is 0.25 m from space hidden behind a surface, stands within "));
  cameras_.remembered.state = PastState::possible_again;
  cameras_.remembered.possible_since_s = 3.5;
  ASSERT_TRUE(loop.cycle(simulated, 4));
  EXPECT_THAT(
      std::string(describe(loop.report().reason, buffer_)),
      HasSubstr(" is 0.25 m from space hidden behind a surface, where nothing could be until 0.5 s ago, stands"));
  EXPECT_EQ(cameras_.asked_world, loop.answers()[*loop.report().reason.part].nearest.nearest_world);
  cameras_.distance_m = 5;
  ASSERT_TRUE(loop.cycle(simulated, 4.1));
  EXPECT_EQ(loop.report().reason.past.state, PastState::not_told) << "nothing limits";
}

TEST_F(BlindStop, NamesThePartWithTheLeastRoom) {
  control::PolygonTask task(test::hexagon(model_));
  cameras_.distance_m = 0.3;
  AvoidanceLoop loop({model_}, task, cameras_, settings_);
  control::SimulatedArm arm(settings_.controller.limits, kLoopPeriod, test::bent());
  ASSERT_TRUE(loop.start(arm));
  for (int k = 0; k < 200; ++k) {
    ASSERT_TRUE(loop.cycle(arm, k * kLoopPeriod));
    arm.advance();
  }
  const MotionReason& reason = loop.report().reason;
  EXPECT_EQ(reason.limit, MotionLimit::obstacle);
  ASSERT_TRUE(reason.part.has_value());
  EXPECT_EQ(reason.link, model_.links()[settings_.parts[*reason.part].link].name);
  EXPECT_EQ(reason.clear_m, 0.3);
  // The way of that part's point while every joint brakes evenly, by small steps.
  control::JointVector q = loop.report().output.command.position_rad;
  control::JointVector v = loop.report().output.command.velocity_rad_s;
  const robot::LinkCapsule& part = settings_.parts[*reason.part];
  const auto at_world = [&] {
    return Eigen::Vector3d(robot::PlacedRobot{model_}.link_poses({q.data(), 7})[part.link] * part.capsule.a);
  };
  const Eigen::Vector3d begin_world = at_world();
  constexpr double kStep_s = 1e-5;
  while (v.cwiseAbs().maxCoeff() > 0) {
    for (int j = 0; j < 7; ++j) {
      const double slower =
          std::max(0.0, std::abs(v[j]) - settings_.controller.limits.acceleration_rad_s2[j] * kStep_s);
      v[j] = std::copysign(slower, v[j]);
    }
    q += kStep_s * v;
  }
  const double way_m = (at_world() - begin_world).norm();
  EXPECT_GT(way_m, 0.001);
  EXPECT_LE(way_m, reason.braking_m * 1.01);
}

TEST_F(BlindStop, NamesTheCameraThatNeverSentAnything) {
  for (const std::size_t silent : {0U, 1U}) {
    cameras_ = {};
    cameras_.frozen_from_s[silent] = kNaN;
    cameras_.frozen_from_s[1 - silent] = 1;
    control::PolygonTask task(test::hexagon(model_));
    AvoidanceLoop loop({model_}, task, cameras_, settings_);
    control::SimulatedArm arm(settings_.controller.limits, kLoopPeriod, test::bent());
    ASSERT_TRUE(loop.start(arm));
    ASSERT_TRUE(loop.cycle(arm, 3));
    EXPECT_EQ(loop.report().lost_cameras, 2);
    EXPECT_EQ(loop.report().reason.late_camera, std::optional<std::size_t>(silent));
    EXPECT_TRUE(std::isnan(loop.report().reason.late_s));
  }
}

TEST_F(BlindStop, TellsTheThickestLayer) {
  control::PolygonTask task(test::hexagon(model_));
  AvoidanceLoop loop({model_}, task, cameras_, settings_);
  control::SimulatedArm arm(settings_.controller.limits, kLoopPeriod, test::bent());
  ASSERT_TRUE(loop.start(arm));
  cameras_.layer_of_part_m = {0.01, 0.05, 0.02};
  ASSERT_TRUE(loop.cycle(arm, 1));
  EXPECT_EQ(loop.report().blind_m, 0.05);
  cameras_.layer_of_part_m = {0.01, kNaN, 0.02};
  ASSERT_TRUE(loop.cycle(arm, 2));
  EXPECT_TRUE(std::isnan(loop.report().blind_m)) << "one is not known";
}

// The end effector's push and the body's limits begin at distances of their own.
TEST_F(BlindStop, NamesAPartWithinTheRangeOfItsLaw) {
  settings_.end_effector_limits = false;
  settings_.controller.repulsion.rho_m = 0.6;
  settings_.controller.body.rho_m = 0.3;
  control::PolygonTask task(test::hexagon(model_));
  AvoidanceLoop loop({model_}, task, cameras_, settings_);
  control::SimulatedArm arm(settings_.controller.limits, kLoopPeriod, test::bent());
  ASSERT_TRUE(loop.start(arm));
  cameras_.of_part_m = {5, 0.5};
  ASSERT_TRUE(loop.cycle(arm, 1));
  EXPECT_EQ(loop.report().reason.limit, MotionLimit::none) << "a part of the body";
  cameras_.of_part_m = {0.5, 5};
  ASSERT_TRUE(loop.cycle(arm, 2));
  EXPECT_EQ(loop.report().reason.limit, MotionLimit::obstacle) << "the end effector";
  EXPECT_EQ(loop.report().reason.part, std::optional<std::size_t>(0));
}

TEST_F(BlindStop, AgesAreLimited) {
  const auto refused = [&](double age_s) {
    settings_.max_image_age_s = age_s;
    control::PolygonTask task(test::hexagon(model_));
    return depthgrid::test::thrown_message([&] { AvoidanceLoop({model_}, task, cameras_, settings_); });
  };
  EXPECT_EQ(refused(0.1), "");
  EXPECT_THAT(refused(0), HasSubstr("age of 0 s"));
  EXPECT_THAT(refused(std::numeric_limits<double>::infinity()), HasSubstr("age of inf s"));
  EXPECT_THAT(refused(kNaN), HasSubstr("age of nan s"));
}

}  // namespace
}  // namespace depthgrid::avoidance
