// The padding for an error of time contains every link that moved within it, and is not much too large.
#include "depthgrid/robot/motion_padding.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>

#include "depthgrid/robot/joint_history.hpp"
#include "depthgrid/robot/kuka_lwr4.hpp"
#include "depthgrid/robot/link_capsules.hpp"
#include "robot/random_arm.hpp"
#include "robot/robot_support.hpp"
#include "support/random_run.hpp"

namespace depthgrid::robot {
namespace {

/// How far the capsules' ends moved: a point of a capsule moves at least that far somewhere, and its bound must hold
/// for points all over its surface.
double moved_m(const LinkCapsule& item, const Pose& before, const Pose& after, Random& random) {
  double most = 0;
  for (int k = 0; k < 20; ++k) {
    const Eigen::Vector3d p = item.capsule.a + random.uniform(0, 1) * (item.capsule.b - item.capsule.a) +
                              item.capsule.radius_m * random.unit();
    most = std::max(most, (after * p - before * p).norm());
  }
  return most;
}

TEST(MotionPadding, ContainsWhatMoved) {
  const RobotModel model = kuka_lwr4();
  const std::vector<LinkCapsule> capsules = link_capsules(model);
  const test::RandomRun run = test::random_run(3000);
  double greatest_share = 0;
  for (std::int64_t i = 0; i < run.count; ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i));
    const std::vector<double> q = random.positions(model);
    const double time_error_s = random.uniform(0, 0.1);
    std::vector<double> speeds;
    std::vector<double> moved_q = q;
    for (std::size_t j = 0; j < q.size(); ++j) {
      speeds.push_back(random.integer(0, 2) == 0 ? 0.0 : random.uniform(0, model.joints()[j].max_speed));
      const double part = random.integer(0, 1) == 0 ? 1.0 : random.uniform(0, 1);
      moved_q[j] += (random.integer(0, 1) == 0 ? 1 : -1) * part * speeds[j] * time_error_s;
    }
    const std::vector<Pose> before = link_poses(model, q);
    const std::vector<Pose> after = link_poses(model, moved_q);
    std::vector<double> padding_m(capsules.size());
    motion_padding(model, capsules, before, speeds, time_error_s, padding_m);
    EXPECT_EQ(padding_m[0], 0.0);  // the base does not move
    for (std::size_t k = 0; k < capsules.size(); ++k) {
      const double moved = moved_m(capsules[k], before[capsules[k].link], after[capsules[k].link], random);
      ASSERT_LE(moved, padding_m[k] + 1e-12) << "capsule " << k << " of case " << i << "; " << run.reproduce();
      greatest_share = padding_m[k] > 0 ? std::max(greatest_share, moved / padding_m[k]) : greatest_share;
    }
  }
  std::cout << "most of a bound that was needed: " << greatest_share << "\n";
  if (run.count >= 1000) {
    EXPECT_GT(greatest_share, 0.8);
  }
}

// Arms with sliding joints, and with some that follow others at another speed. Where things are is worked out by the
// test's own matrices.
TEST(MotionPadding, ContainsWhatMovedOnRandomArms) {
  const test::RandomRun run = test::random_run(2000);
  double greatest_share = 0;
  int mimicking = 0;
  for (std::int64_t i = 0; i < run.count; ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i));
    const RandomArm arm(random);
    mimicking += arm.mimics() ? 1 : 0;
    const PlacedRobot placed = arm.placed();
    const int joints = arm.joints();
    Eigen::VectorXd before(joints);
    Eigen::VectorXd after(joints);
    std::vector<double> speeds;
    const double time_error_s = random.uniform(0, 0.1);
    for (int j = 0; j < joints; ++j) {
      before[j] = random.uniform(-3, 3);
      speeds.push_back(random.integer(0, 2) == 0 ? 0.0 : random.uniform(0, 3));
      after[j] = before[j] + (random.integer(0, 1) == 0 ? 1 : -1) * speeds.back() * time_error_s;
    }
    std::vector<LinkCapsule> capsules;
    for (int link = 1; link < arm.links(); ++link) {
      capsules.push_back({static_cast<std::size_t>(link), {random.in_cube(0.3), random.in_cube(0.3), 0.05}});
    }
    const std::vector<Pose> poses = placed.link_poses({before.data(), static_cast<std::size_t>(joints)});
    std::vector<double> padding_m(capsules.size());
    motion_padding(placed.model, capsules, poses, speeds, time_error_s, padding_m);
    for (std::size_t k = 0; k < capsules.size(); ++k) {
      const Capsule& capsule = capsules[k].capsule;
      const int link = static_cast<int>(capsules[k].link);
      for (int n = 0; n < 20; ++n) {
        const Eigen::Vector3d p =
            capsule.a + random.uniform(0, 1) * (capsule.b - capsule.a) + capsule.radius_m * random.unit();
        const double moved = (arm.at(after, link, p) - arm.at(before, link, p)).norm();
        ASSERT_LE(moved, padding_m[k] + 1e-12) << "capsule " << k << " of case " << i << "; " << run.reproduce();
        greatest_share = padding_m[k] > 0 ? std::max(greatest_share, moved / padding_m[k]) : greatest_share;
      }
    }
  }
  if (run.count >= 1000) {
    EXPECT_GT(greatest_share, 0.9);
    EXPECT_GT(mimicking, 100);
  }
}

TEST(MotionPadding, NothingMovesInNoTime) {
  const RobotModel model = kuka_lwr4();
  const std::vector<LinkCapsule> capsules = link_capsules(model);
  std::vector<double> padding_m(capsules.size(), 1.0);
  const std::vector<double> speeds(7, std::numeric_limits<double>::infinity());
  motion_padding(model, capsules, link_poses(model, std::vector<double>(7, 0.1)), speeds, 0.0, padding_m);
  for (const double padding : padding_m) {
    EXPECT_EQ(padding, 0.0);
  }
}

/// Largest padding for motion at the tip, by what is known of the joints.
struct TipRow {
  double limits_m = 0;         ///< their greatest speeds
  double samples_m = 0;        ///< samples every 2 ms on both sides of the exposure
  double accelerations_m = 0;  ///< and 10 rad/s^2
  double newest_m = 0;         ///< the same, and no sample after the exposure
  double moved_m = 0;          ///< how far a point of the tip's capsule really was, most
};

TipRow tip_row(double speed_part, double time_error_s, const test::RandomRun& run) {
  const RobotModel model = kuka_lwr4();
  const std::vector<LinkCapsule> capsules = link_capsules(model);
  std::vector<double> limits;
  for (const Joint& joint : model.joints()) {
    limits.push_back(joint.max_speed);
  }
  const std::vector<double> unknown(7, std::numeric_limits<double>::infinity());
  const std::vector<double> accelerations(7, 10.0);
  TipRow row;
  for (std::int64_t i = 0; i < run.count; ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i));
    const std::vector<double> q = random.positions(model);
    std::vector<double> speeds;
    for (const double limit : limits) {
      speeds.push_back((random.integer(0, 1) == 0 ? 1 : -1) * speed_part * limit);
    }
    const auto position = [&](double time_s) {
      std::vector<double> at = q;
      for (std::size_t j = 0; j < at.size(); ++j) {
        at[j] += speeds[j] * time_s;
      }
      return at;
    };
    const std::vector<Pose> poses = link_poses(model, q);
    const auto padding_m = [&](double last_s, const std::vector<double>& most_acceleration) {
      JointHistory history(7, 200, 0.02, 0.0);
      for (int k = -100; 0.002 * k <= last_s + 1e-9; ++k) {
        (void)history.add(0.002 * k, position(0.002 * k));
      }
      std::vector<double> away(7);
      EXPECT_TRUE(history.greatest_motion(0, time_error_s, q, limits, most_acceleration, away));
      for (std::size_t j = 0; j < away.size(); ++j) {
        away[j] = std::isfinite(most_acceleration[j]) ? away[j] : std::min(away[j], limits[j] * time_error_s);
      }
      std::vector<double> result_m(capsules.size());
      motion_padding(model, capsules, poses, away, 1.0, result_m);
      return result_m.back();
    };
    std::vector<double> all_m(capsules.size());
    motion_padding(model, capsules, poses, limits, time_error_s, all_m);
    row.limits_m = std::max(row.limits_m, all_m.back());
    row.samples_m = std::max(row.samples_m, padding_m(0.1, unknown));
    row.accelerations_m = std::max(row.accelerations_m, padding_m(0.1, accelerations));
    row.newest_m = std::max(row.newest_m, padding_m(0.0, accelerations));
    for (const double time_s : {-time_error_s, time_error_s}) {
      row.moved_m = std::max(row.moved_m, moved_m(capsules.back(), poses[capsules.back().link],
                                                  link_poses(model, position(time_s))[capsules.back().link], random));
    }
  }
  return row;
}

// Prints the table of docs/robot.md; that is with DEPTHGRID_TEST_COUNT=400.
TEST(MotionPadding, FollowsTheMeasuredMotion) {
  const test::RandomRun run = test::random_run(20);
  std::printf(
      "| speeds | time error | moved, most | by the limits | by samples | and accelerations | no sample after |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  for (const double part : {0.0, 0.1, 0.25, 0.5, 1.0}) {
    for (const double time_error_s : {0.02, 0.05}) {
      const TipRow row = tip_row(part, time_error_s, run);
      EXPECT_LE(row.moved_m, row.accelerations_m + 1e-9);
      EXPECT_LE(row.accelerations_m, row.samples_m + 1e-4);
      EXPECT_LE(row.samples_m, row.limits_m + 1e-12);
      EXPECT_LE(row.accelerations_m, row.newest_m + 1e-4);
      if (part == 0.0) {
        EXPECT_LT(row.accelerations_m, 1e-4) << "a standing arm has no padding for motion";
      }
      std::printf("| %.0f %% | %.0f ms | %.0f mm | %.0f mm | %.0f mm | %.1f mm | %.0f mm |\n", 100 * part,
                  1e3 * time_error_s, 1e3 * row.moved_m, 1e3 * row.limits_m, 1e3 * row.samples_m,
                  1e3 * row.accelerations_m, 1e3 * row.newest_m);
    }
  }
}

}  // namespace
}  // namespace depthgrid::robot
