// Joint positions at the time of an exposure: interpolated, held or not known, while another thread adds.
#include "depthgrid/robot/joint_history.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace depthgrid::robot
