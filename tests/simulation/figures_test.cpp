// The person and the arm keep their proportions in every pose.
#include "depthgrid/simulation/figures.hpp"

#include <gtest/gtest.h>

#include "simulation/random_scenes.hpp"

namespace depthgrid::simulation::testing {
namespace {

TEST(Figures, PersonKeepsLimbLengthsAndReachesWithinReach) {
  for (int n = 0; n < count(500); ++n) {
    Random random(seed() + static_cast<unsigned long>(n));
    PersonPose pose;
    pose.feet_world = {random.uniform(-2, 2), random.uniform(-2, 2), 0};
    pose.heading_rad = random.uniform(-3, 3);
    pose.lean_rad = random.uniform(-0.1, 0.6);
    const auto standing = person(pose);
    const Eigen::Vector3d shoulder = standing[5].a;
    const double reach_m = random.uniform(0.3, 0.9);
    pose.left_fingertips_world = shoulder + reach_m * random.unit();
    const auto parts = person(pose);
    const auto length = [&](std::size_t i) { return (parts[i].b - parts[i].a).norm(); };
    const std::string where = "case seed " + std::to_string(seed() + static_cast<unsigned long>(n));
    ASSERT_NEAR(length(5), 0.30, 1e-9) << where;
    ASSERT_NEAR(length(6), 0.26, 1e-3) << where;
    ASSERT_NEAR(length(7), 0.15, 1e-9) << where;
    ASSERT_EQ(parts[5].a, shoulder) << where;
    ASSERT_EQ(parts[5].b, parts[6].a) << where;
    ASSERT_EQ(parts[6].b, parts[7].a) << where;
    ASSERT_NEAR((parts[7].b - pose.left_fingertips_world).norm(), std::max(0.0, reach_m - 0.71), 1e-5) << where;
    ASSERT_LE(parts[5].b.z(), std::max(parts[5].a.z(), parts[6].b.z()) + 1e-9) << where;
    for (const Capsule& part : parts) {
      validate(part);
    }
  }
}

TEST(Figures, PersonStandsOnTheFloorAndIsAsTallAsStated) {
  double lowest = 10;
  double highest = 0;
  for (const Capsule& part : person({})) {
    lowest = std::min({lowest, part.a.z() - part.radius_m, part.b.z() - part.radius_m});
    highest = std::max({highest, part.a.z() + part.radius_m, part.b.z() + part.radius_m});
  }
  EXPECT_NEAR(lowest, 0, 1e-9);
  EXPECT_NEAR(highest, 1.75, 1e-9);
}

TEST(Figures, ArmStandsUprightAtZeroAndIsRigid) {
  const Arm upright = arm(Pose::Identity(), {});
  EXPECT_NEAR((upright.axis_world[4] - Eigen::Vector3d(0, 0, kArmLength)).norm(), 0, 1e-12);
  for (int n = 0; n < count(200); ++n) {
    Random random(seed() + static_cast<unsigned long>(n));
    ArmAngles angles;
    for (double& angle : angles) {
      angle = random.uniform(-2, 2);
    }
    const Arm posed = arm(random.pose(1), angles);
    double along_m = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const double link_m = (upright.axis_world[i + 1] - upright.axis_world[i]).norm();
      ASSERT_NEAR((posed.axis_world[i + 1] - posed.axis_world[i]).norm(), link_m, 1e-9);
      ASSERT_NEAR((point_on_axis(posed, along_m) - posed.axis_world[i]).norm(), 0, 1e-9);
      along_m += link_m;
    }
    ASSERT_NEAR(along_m, kArmLength, 1e-12);
    ASSERT_EQ(point_on_axis(posed, 5.0), posed.axis_world[4]);
    ASSERT_EQ(point_on_axis(posed, -1.0), posed.axis_world[0]);
    for (const double share : {0.0, 0.3, 0.6, 0.9}) {
      const Eigen::Vector3d p = point_on_axis(posed, share * kArmLength);
      bool covered = false;
      for (const Capsule& link : posed.links) {
        covered = covered || contains(link, p);
      }
      ASSERT_TRUE(covered) << "axis at " << share << " of its length lies outside all links";
    }
  }
}

TEST(Figures, FirstJointTurnsTheArmAboutItsColumn) {
  const Arm posed = arm(Pose::Identity(), {std::acos(0.0), -std::acos(0.0), 0, 0, 0, 0, 0});
  // The second axis is -y: a negative angle leans towards +x, which the first joint then turns to +y.
  EXPECT_NEAR((posed.axis_world[2] - Eigen::Vector3d(0, 0.4, 0.3105)).norm(), 0, 1e-9);
}

}  // namespace
}  // namespace depthgrid::simulation::testing
