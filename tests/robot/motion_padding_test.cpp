// The padding for an error of time contains every link that moved within it, and is not much too large.
#include "depthgrid/robot/motion_padding.hpp"

#include <gtest/gtest.h>

#include <iostream>

#include "depthgrid/robot/kuka_lwr4.hpp"
#include "depthgrid/robot/link_capsules.hpp"
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

}  // namespace
}  // namespace depthgrid::robot
