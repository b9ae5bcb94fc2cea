// Joint positions at the time of an exposure: interpolated, held or not known, while another thread adds.
#include "depthgrid/robot/joint_history.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

#include "robot/robot_support.hpp"
#include "support/allocation_guard.hpp"
#include "support/random_run.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::robot {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

TEST(JointHistory, RefusesSettings) {
  EXPECT_NE(test::thrown_message([] { const JointHistory unused(0, 10, 1, 0); }), "");
  EXPECT_NE(test::thrown_message([] { const JointHistory unused(7, 1, 1, 0); }), "");
  EXPECT_NE(test::thrown_message([] { const JointHistory unused(7, 10, 0, 0); }), "");
  EXPECT_NE(test::thrown_message([] { const JointHistory unused(7, 10, kNone, 0); }), "");
  EXPECT_NE(test::thrown_message([] { const JointHistory unused(7, 10, 1, -1); }), "");
}

TEST(JointHistory, SaysWhereTheAnswerComesFrom) {
  JointHistory history(2, 4, 0.15, 0.05);
  std::array<double, 2> q{};
  EXPECT_EQ(history.at(0, q).answer, JointAnswer::no_samples);
  const auto add = [&](double time_s) { return history.add(time_s, std::array{10 * time_s, -time_s}); };
  ASSERT_TRUE(add(1.0));
  EXPECT_EQ(history.at(1.0, q).answer, JointAnswer::interpolated);
  EXPECT_EQ(history.at(0.9, q).answer, JointAnswer::too_old);
  ASSERT_TRUE(add(1.1));
  EXPECT_FALSE(add(1.1));
  EXPECT_FALSE(add(0.5));
  EXPECT_FALSE(add(kNone));
  EXPECT_FALSE(history.add(2.0, std::array{1.0, kNone}));
  EXPECT_FALSE(history.add(2.0, std::array{1.0}));
  EXPECT_EQ(history.at(1.025, q).answer, JointAnswer::interpolated);
  EXPECT_NEAR(q[0], 10.25, 1e-12);
  EXPECT_NEAR(q[1], -1.025, 1e-12);
  const JointsAtTime held = history.at(1.14, q);
  EXPECT_EQ(held.answer, JointAnswer::held);
  EXPECT_NEAR(held.time_error_s, 0.04, 1e-12);
  EXPECT_NEAR(q[0], 11, 1e-12);
  EXPECT_EQ(history.at(1.16, q).answer, JointAnswer::too_new);
  EXPECT_EQ(history.at(kNone, q).answer, JointAnswer::too_new);
  EXPECT_FALSE(history.at(kNone, q).known());
  ASSERT_TRUE(add(1.3));
  EXPECT_EQ(history.at(1.2, q).answer, JointAnswer::gap);
  EXPECT_EQ(history.at(1.3, q).answer, JointAnswer::interpolated);
  ASSERT_TRUE(add(1.4));
  ASSERT_TRUE(add(1.5));  // the first is gone
  EXPECT_EQ(history.at(1.05, q).answer, JointAnswer::too_old);
  EXPECT_EQ(history.at(1.1, q).answer, JointAnswer::interpolated);
  std::array<double, 3> wrong{};
  EXPECT_EQ(history.at(1.5, wrong).answer, JointAnswer::no_samples);
}

TEST(JointHistory, FollowsASmoothMotionToTheStatedError) {
  const test::RandomRun run = test::random_run(20);
  for (std::int64_t i = 0; i < run.count; ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i));
    constexpr double kStep = 0.002;
    const double speed = random.uniform(1, 20);
    JointHistory history(1, 500, 0.01, 0);
    const auto joint = [&](double t) { return std::sin(speed * t); };  // acceleration at most speed^2
    double t = 0;
    for (int k = 0; k < 700; ++k) {
      t += kStep;
      history.add(t, std::array{joint(t)});
    }
    for (int k = 0; k < 300; ++k) {
      const double asked = random.uniform(t - 498 * kStep, t);
      std::array<double, 1> q{};
      ASSERT_EQ(history.at(asked, q).answer, JointAnswer::interpolated) << run.reproduce();
      ASSERT_LE(std::abs(q[0] - joint(asked)), kStep * kStep / 8 * speed * speed + 1e-12) << run.reproduce();
    }
  }
}

// All joints of a sample are equal and follow the time, so a torn sample shows.
TEST(JointHistory, IsReadWhileItIsWritten) {
  JointHistory history(7, 16, 1.0, 0.0);
  std::atomic<bool> done{false};
  const auto ask = [&] {
    std::array<double, 7> q{};
    long known = 0;
    double latest = 0;
    while (!done.load()) {
      for (double back = 0; back < 20; back += 1.5) {
        const double time_s = std::max(1.0, latest - back);
        if (history.at(time_s, q).known()) {
          ++known;
          for (const double position : q) {
            ASSERT_NEAR(position, time_s, 1e-9);
          }
        }
      }
      while (history.at(latest + 1, q).known()) {
        ++latest;
      }
      if (history.at(latest, q).answer == JointAnswer::too_old) {
        latest += 8;
      }
    }
    EXPECT_GT(known, 0);
  };
  std::thread first(ask);
  std::thread second(ask);
  for (int k = 1; k <= 100000; ++k) {
    std::array<double, 7> q{};
    q.fill(k);
    history.add(k, q);
    if (k % 256 == 0) {
      std::this_thread::yield();
    }
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  done = true;
  first.join();
  second.join();
}

TEST(JointHistory, AllocatesNothing) {
  DEPTHGRID_REQUIRE_ALLOCATION_COUNT();
  JointHistory history(7, 100, 1.0, 1.0);
  std::array<double, 7> q{};
  const test::AllocationGuard guard;
  history.add(1, q);
  history.add(2, q);
  const JointsAtTime joints = history.at(1.5, q);
  const auto allocations = guard.allocations();
  EXPECT_EQ(allocations, 0);
  EXPECT_TRUE(joints.known());
}

/// Positions over time whose speed and acceleration keep their bounds: the speed is linear between knots 20 ms apart.
class Motion {
 public:
  Motion(Random& random, double most_speed, double most_acceleration) {
    double speed = 0;
    double position = random.uniform(-2, 2);
    for (int k = 0; k <= kKnots; ++k) {
      knots_.push_back({position, speed});
      const double change = most_acceleration * kStep_s;
      const double next = std::clamp(speed + random.uniform(-1, 1) * change, -most_speed, most_speed);
      position += 0.5 * (speed + next) * kStep_s;
      speed = next;
    }
  }
  [[nodiscard]] double at(double time_s) const {
    const int k = std::clamp(static_cast<int>(time_s / kStep_s), 0, kKnots - 1);
    const Knot& knot = knots_[static_cast<std::size_t>(k)];
    const double acceleration = (knots_[static_cast<std::size_t>(k + 1)].speed - knot.speed) / kStep_s;
    const double since_s = time_s - k * kStep_s;
    return knot.position + (knot.speed + 0.5 * acceleration * since_s) * since_s;
  }
  static constexpr double kStep_s = 0.02;
  static constexpr int kKnots = 60;

 private:
  struct Knot {
    double position = 0;
    double speed = 0;
  };
  std::vector<Knot> knots_;
};

// Never smaller than the true motion, whatever the joints did within their stated speed and acceleration.
TEST(JointHistory, TheGreatestMotionContainsEveryMotionWithinTheStatedBounds) {
  const test::RandomRun run = test::random_run(3000);
  double tightest = 0;
  int known = 0;
  for (std::int64_t i = 0; i < run.count; ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i));
    const std::string what = "case " + std::to_string(i) + "; " + run.reproduce();
    const std::array most_speed{random.uniform(0, 3), random.uniform(0, 3)};
    const std::array most_acceleration{random.uniform(0, 30), random.uniform(0, 30)};
    const std::array motions{Motion(random, most_speed[0], most_acceleration[0]),
                             Motion(random, most_speed[1], most_acceleration[1])};
    JointHistory history(2, 300, 0.05, 0.05);
    double newest_s = 0;
    for (double time_s = 0.1; time_s < 0.6; time_s += random.uniform(0.001, 0.01)) {
      ASSERT_TRUE(history.add(time_s, std::array{motions[0].at(time_s), motions[1].at(time_s)}));
      newest_s = time_s;
    }
    const double time_s =
        random.integer(0, 2) == 0 ? newest_s + random.uniform(-0.02, 0.05) : random.uniform(0.15, newest_s);
    const double error_s = random.integer(0, 3) == 0 ? 0.0 : random.uniform(0, 0.05);
    std::array<double, 2> q{};
    if (!history.at(time_s, q).known()) {
      continue;
    }
    const auto bounds = [&](std::span<const double> speeds, std::span<const double> accelerations) {
      std::array<double, 2> away{};
      EXPECT_TRUE(history.greatest_motion(time_s, error_s, q, speeds, accelerations, away)) << what;
      return away;
    };
    constexpr double kInf = std::numeric_limits<double>::infinity();
    const std::array unknown{kInf, kInf};
    const std::array<std::array<double, 2>, 3> all{bounds(most_speed, most_acceleration), bounds(most_speed, unknown),
                                                   bounds(unknown, most_acceleration)};
    ++known;
    for (std::size_t j = 0; j < 2; ++j) {
      double moved = 0;
      for (int k = -40; k <= 40; ++k) {
        moved = std::max(moved, std::abs(motions[j].at(time_s + error_s * k / 40) - q[j]));
      }
      for (const auto& away : all) {
        ASSERT_LE(moved, away[j] + 1e-12) << what;
      }
      tightest = all[0][j] > 1e-6 ? std::max(tightest, moved / all[0][j]) : tightest;
    }
  }
  EXPECT_GT(known, 1000 * run.count / 3000);
  if (run.count >= 1000) {
    EXPECT_GT(tightest, 0.95) << "no more than needed, somewhere";
  }
}

TEST(JointHistory, AStandingJointHasNotMoved) {
  JointHistory history(1, 100, 0.02, 0.01);
  for (int k = 0; k < 50; ++k) {
    ASSERT_TRUE(history.add(0.002 * k, std::array{0.7}));
  }
  constexpr std::array kSpeed{2.0};
  constexpr std::array kAcceleration{10.0};
  constexpr std::array kUnknown{std::numeric_limits<double>::infinity()};
  std::array q{0.7};
  std::array<double, 1> away{};
  // With samples on both sides: what it may do between two of them.
  ASSERT_TRUE(history.greatest_motion(0.05, 0.02, q, kSpeed, kAcceleration, away));
  EXPECT_NEAR(away[0], 10 * 0.002 * 0.002 / 8, 1e-12);
  ASSERT_TRUE(history.greatest_motion(0.05, 0.02, q, kSpeed, kUnknown, away));
  EXPECT_NEAR(away[0], 2 * 0.002 / 2, 1e-12);
  // After the newest it may have set off.
  ASSERT_TRUE(history.greatest_motion(0.098, 0.02, q, kSpeed, kAcceleration, away));
  EXPECT_NEAR(away[0], 10 * (0.002 * 0.02 + 0.02 * 0.02 / 2), 1e-12);
  ASSERT_TRUE(history.greatest_motion(0.098, 0.02, q, kSpeed, kUnknown, away));
  EXPECT_NEAR(away[0], 2 * 0.02, 1e-12);
  // Where it was before the first sample nobody knows.
  EXPECT_FALSE(history.greatest_motion(0.01, 0.02, q, kSpeed, kAcceleration, away));
  EXPECT_FALSE(history.greatest_motion(0.05, -0.02, q, kSpeed, kAcceleration, away));
  EXPECT_FALSE(history.greatest_motion(0.05, 0.02, {}, kSpeed, kAcceleration, away));
}

}  // namespace
}  // namespace depthgrid::robot
