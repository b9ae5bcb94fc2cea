// The box of admissible velocities: braking is exact, and a stop stays possible whatever is requested.
#include "depthgrid/control/joint_box.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "control/lwr.hpp"
#include "depthgrid/control/command_limiter.hpp"
#include "support/random_run.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::control {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Period by period, as a robot would do it.
double brake_by_hand(double velocity, double acceleration, double period) {
  double way = 0;
  for (double v = velocity; v > 0; v -= acceleration * period) {
    way += period * v;
  }
  return way;
}

TEST(JointBox, StoppingDistanceIsThatOfBrakingPeriodByPeriod) {
  for (const double v : {0.0, 1e-6, 0.0104, 0.0105, 0.3, 1.0, 2.9}) {
    EXPECT_NEAR(stopping_distance(v, 5.2, 0.002), brake_by_hand(v, 5.2, 0.002), 1e-12) << v;
    EXPECT_EQ(stopping_distance(-v, 5.2, 0.002), stopping_distance(v, 5.2, 0.002));
  }
}

TEST(JointBox, LargestStoppableIsTheInverseOfStoppingDistance) {
  for (const double gap : {1e-9, 1e-6, 2e-5, 2.1e-5, 1e-3, 0.1, 3.0}) {
    const double v = largest_stoppable(gap, 5.2, 0.002);
    EXPECT_NEAR(stopping_distance(v, 5.2, 0.002), gap, 1e-12) << gap;
  }
  EXPECT_EQ(largest_stoppable(0, 5.2, 0.002), 0);
  EXPECT_EQ(largest_stoppable(-1, 5.2, 0.002), 0);
  EXPECT_EQ(largest_stoppable(kNaN, 5.2, 0.002), 0);
  // Not more than the textbook's sqrt(2 A gap), which forgets that the period before braking is travelled too.
  EXPECT_LT(largest_stoppable(0.1, 5.2, 0.002), std::sqrt(2 * 5.2 * 0.1));
}

TEST(JointBox, OutsideItsRangeAJointMayOnlyMoveBack) {
  const JointLimits limits = test::lwr_limits();
  JointVector q = JointVector::Zero(7);
  q[0] = limits.highest_rad[0] + 0.1;
  q[1] = limits.lowest_rad[1] - 0.1;
  const JointBox box = admissible_velocities(limits, q, JointVector::Zero(7), 0.002);
  EXPECT_EQ(box.upper_rad_s[0], 0);
  EXPECT_LT(box.lower_rad_s[0], 0);
  EXPECT_EQ(box.lower_rad_s[1], 0);
  EXPECT_GT(box.upper_rad_s[1], 0);
}

TEST(JointBox, TooFastIsBrakedWithAllThereIs) {
  const JointLimits limits = test::lwr_limits();
  const double step = limits.acceleration_rad_s2[0] * 0.002;
  JointVector q = JointVector::Zero(7);
  JointVector v = JointVector::Zero(7);
  v[0] = limits.velocity_rad_s[0] + 1;  // faster than allowed
  q[1] = limits.highest_rad[1] - 0.001;
  v[1] = 1.0;  // no longer to be stopped in time
  q[2] = limits.highest_rad[2] + 0.01;
  v[2] = 0.5;  // outside and moving out
  const JointBox box = admissible_velocities(limits, q, v, 0.002);
  for (int i = 0; i < 3; ++i) {
    EXPECT_DOUBLE_EQ(box.upper_rad_s[i], v[i] - step) << i;
    EXPECT_DOUBLE_EQ(box.lower_rad_s[i], v[i] - step) << i;
  }
}

TEST(JointBox, WhatIsNotFiniteClosesTheJoint) {
  const JointLimits limits = test::lwr_limits();
  JointVector q = JointVector::Zero(7);
  q[3] = kNaN;
  JointVector v = JointVector::Zero(7);
  v[4] = kInfinity;
  const JointBox box = admissible_velocities(limits, q, v, 0.002);
  EXPECT_TRUE(is_proper(box));
  for (const int i : {3, 4}) {
    EXPECT_EQ(box.lower_rad_s[i], 0);
    EXPECT_EQ(box.upper_rad_s[i], 0);
  }
  EXPECT_TRUE(is_proper(admissible_velocities(limits, JointVector::Zero(3), v, 0.002)));
}

TEST(JointBox, TighteningNeverLeavesTheBox) {
  const JointBox box{JointVector::Constant(4, -1), JointVector::Constant(4, 2)};
  JointBox limits{JointVector(4), JointVector(4)};
  limits.lower_rad_s << -kInfinity, 3, -9, kNaN;
  limits.upper_rad_s << 1, 4, -5, 1;
  const JointBox tight = tightened(box, limits);
  EXPECT_EQ(tight.lower_rad_s, JointVector(Eigen::Vector4d(-1, 2, -1, 0)));
  EXPECT_EQ(tight.upper_rad_s, JointVector(Eigen::Vector4d(1, 2, -1, 1)));
}

JointLimits random_limits(std::mt19937_64& engine, int joints) {
  std::uniform_real_distribution<double> unit(0, 1);
  const auto draw = [&](double low, double high) {
    return JointVector(JointVector::NullaryExpr(joints, [&] { return low * std::pow(high / low, unit(engine)); }));
  };
  JointLimits limits;
  limits.lowest_rad = -draw(0.001, 3);
  limits.highest_rad = draw(0.001, 3);
  limits.velocity_rad_s = draw(0.05, 4);
  limits.acceleration_rad_s2 = draw(0.1, 100);
  return limits;
}

/// Requests that jump, by velocity and by position, with what is not finite among them.
TEST(CommandLimiter, KeepsAllLimitsWhateverIsRequestedAndCanAlwaysStop) {
  const auto run = depthgrid::test::random_run(60);
  std::int64_t commands = 0;
  for (std::int64_t i = 0; i < run.count; ++i) {
    const std::uint64_t seed = run.seed + static_cast<std::uint64_t>(i);
    SCOPED_TRACE("DEPTHGRID_TEST_SEED=" + std::to_string(seed) + " DEPTHGRID_TEST_COUNT=1");
    std::mt19937_64 engine(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    const int joints = std::uniform_int_distribution<int>(1, 9)(engine);
    const double period = i % 2 == 0 ? 0.002 : 0.01;
    const JointLimits limits = random_limits(engine, joints);
    CommandLimiter limiter(limits, period);
    ASSERT_TRUE(limiter.start(0.5 * (limits.lowest_rad + limits.highest_rad), JointVector::Zero(joints)));
    const auto check = [&](const JointCommand& before, const JointCommand& now) {
      ++commands;
      ASSERT_GE((now.position_rad - limits.lowest_rad).minCoeff(), -1e-12);
      ASSERT_GE((limits.highest_rad - now.position_rad).minCoeff(), -1e-12);
      ASSERT_GE((limits.velocity_rad_s - now.velocity_rad_s.cwiseAbs()).minCoeff(), 0.0);
      const JointVector change = (now.velocity_rad_s - before.velocity_rad_s).cwiseAbs();
      ASSERT_GE((limits.acceleration_rad_s2 * period - change).minCoeff(), -1e-12);
      ASSERT_LE((now.position_rad - before.position_rad - period * now.velocity_rad_s).cwiseAbs().maxCoeff(), 1e-15);
    };
    JointVector request = JointVector::Zero(joints);
    bool by_position = false;
    for (int k = 0; k < 3000; ++k) {
      if (unit(engine) > 0.99) {
        by_position = unit(engine) > 0;
        request = JointVector::NullaryExpr(joints, [&] { return 5 * unit(engine); });
        if (unit(engine) > 0.8) {
          request[0] = unit(engine) > 0 ? kNaN : kInfinity;
        }
      }
      const JointCommand before = limiter.last();
      check(before, by_position ? limiter.step_towards(request) : limiter.step(request));
      if (k % 100 == 0) {
        CommandLimiter stopping = limiter;  // braking from here: it must come to rest without leaving anything
        for (int n = 0; n < 100000 && stopping.last().velocity_rad_s.cwiseAbs().maxCoeff() > 0; ++n) {
          const JointCommand moving = stopping.last();
          check(moving, stopping.step(JointVector::Zero(joints)));
          ASSERT_LE((stopping.last().velocity_rad_s.cwiseAbs() - moving.velocity_rad_s.cwiseAbs()).maxCoeff(), 0.0);
        }
        ASSERT_EQ(stopping.last().velocity_rad_s.cwiseAbs().maxCoeff(), 0.0);
      }
      if (::testing::Test::HasFatalFailure()) {
        return;
      }
    }
  }
  RecordProperty("commands", static_cast<int>(commands));
}

TEST(CommandLimiter, ReachesAPositionWithoutPassingIt) {
  CommandLimiter limiter(test::lwr_limits(), 0.002);
  ASSERT_TRUE(limiter.start(JointVector::Zero(7), JointVector::Zero(7)));
  const JointVector target = test::lwr_bent();
  for (int k = 0; k < 2000; ++k) {
    limiter.step_towards(target);
    for (int i = 0; i < 7; ++i) {
      ASSERT_LE(std::abs(limiter.last().position_rad[i]), std::abs(target[i]) + 1e-12);
    }
  }
  EXPECT_LE((limiter.last().position_rad - target).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(CommandLimiter, ComesBackFromOutside) {
  const JointLimits limits = test::lwr_limits();
  CommandLimiter limiter(limits, 0.002);
  JointVector q = JointVector::Zero(7);
  q[0] = limits.highest_rad[0] + 0.2;
  JointVector v = JointVector::Zero(7);
  v[0] = 1.0;
  ASSERT_TRUE(limiter.start(q, v));
  EXPECT_FALSE(limiter.start(JointVector::Constant(7, kNaN), v));
  EXPECT_FALSE(limiter.start(JointVector::Zero(3), JointVector::Zero(3)));
  const double farthest = q[0] + stopping_distance(1.0, limits.acceleration_rad_s2[0], 0.002);
  for (int k = 0; k < 5000; ++k) {
    limiter.step(JointVector::Constant(7, k < 2500 ? 1.0 : -1.0));
    ASSERT_LE(limiter.last().position_rad[0], farthest);
  }
  EXPECT_LT(limiter.last().position_rad[0], limits.highest_rad[0]);
}

TEST(JointLimits, AreChecked) {
  using depthgrid::test::thrown_message;
  JointLimits limits = test::lwr_limits();
  EXPECT_EQ(thrown_message([&] { validate(limits); }), "");
  limits.velocity_rad_s[2] = 0;
  EXPECT_EQ(thrown_message([&] { validate(limits); }),
            "joint limits: velocity of joint 2 is 0 rad/s, must be greater than 0 and finite");
  limits = test::lwr_limits();
  limits.lowest_rad[6] = limits.highest_rad[6];
  EXPECT_NE(thrown_message([&] { validate(limits); }), "");
  limits = test::lwr_limits();
  limits.acceleration_rad_s2.conservativeResize(6);
  EXPECT_NE(thrown_message([&] { validate(limits); }), "");
  EXPECT_NE(thrown_message([&] { validate(JointLimits{}); }), "");
  EXPECT_NE(thrown_message([&] { CommandLimiter(test::lwr_limits(), 0); }), "");
  EXPECT_NE(thrown_message([&] { CommandLimiter(test::lwr_limits(), kNaN); }), "");
}

}  // namespace
}  // namespace depthgrid::control
