// Solids against an independent description, by random cases.
#include "depthgrid/simulation/shapes.hpp"

#include <gtest/gtest.h>

#include "depthgrid/core/error.hpp"
#include "simulation/random_scenes.hpp"

namespace depthgrid::simulation::testing {
namespace {

constexpr double kRounding = 1e-9;

TEST(Shapes, IntersectionAgreesWithMarchingAlongTheLine) {
  for (int n = 0; n < count(3000); ++n) {
    Random random(seed() + static_cast<unsigned long>(n));
    const Solid solid = random.solid();
    const SignedDistance outside = solid.grown(0);
    Line line{random.in_cube(3), random.unit() * random.uniform(0.5, 2)};
    if (random.integer(0, 9) == 0) {
      line.direction = Eigen::Vector3d::UnitX();  // parallel to faces and axes now and then
    } else if (random.integer(0, 1) == 0) {
      line.direction = random.in_cube(1.5) - line.origin;  // towards the solids
    }
    const Interval hit = solid.intersect(line);
    const auto at = [&](double t) { return Eigen::Vector3d(line.origin + t * line.direction); };
    const std::string where = "case seed " + std::to_string(seed() + static_cast<unsigned long>(n)) + ": " +
                              solid.text + ", line " + code(line.origin) + " + t " + code(line.direction);
    for (int i = -600; i <= 600; ++i) {
      const double t = i * 0.01;
      const double d = outside(at(t));
      if (d < -kRounding) {
        ASSERT_TRUE(hit.entry <= t && t <= hit.exit) << where << ", t " << t << ", signed distance " << d;
      } else if (d > kRounding) {
        ASSERT_FALSE(hit.entry <= t && t <= hit.exit) << where << ", t " << t << ", signed distance " << d;
      }
    }
    if (!hit.empty()) {
      for (const double t : {hit.entry, hit.exit}) {
        if (std::abs(t) < 100) {
          ASSERT_NEAR(outside(at(t)), 0, kRounding) << where << ", end at t " << t;
        }
      }
    }
  }
}

TEST(Shapes, NearestPointAndMembershipAgreeWithTheSignedDistance) {
  for (int n = 0; n < count(20000); ++n) {
    Random random(seed() + static_cast<unsigned long>(n));
    const Solid solid = random.solid();
    const Eigen::Vector3d p = random.in_cube(2.5);
    const double d = solid.grown(0)(p);
    const Eigen::Vector3d nearest = solid.nearest(p);
    const std::string where = "case seed " + std::to_string(seed() + static_cast<unsigned long>(n)) + ": " +
                              solid.text + ", point " + code(p);
    ASSERT_NEAR((nearest - p).norm(), std::max(0.0, d), kRounding) << where;
    ASSERT_LE(solid.grown(0)(nearest), kRounding) << where;
    if (std::abs(d) > kRounding) {
      ASSERT_EQ(solid.contains(p), d < 0) << where;
    }
  }
}

TEST(Shapes, NoSampleOfTheSolidIsNearerThanTheNearestPoint) {
  for (int n = 0; n < count(200); ++n) {
    Random random(seed() + static_cast<unsigned long>(n));
    const Solid solid = random.solid();
    const Eigen::Vector3d p = random.in_cube(2.5);
    const double d = (solid.nearest(p) - p).norm();
    double brute = std::numeric_limits<double>::infinity();
    constexpr double kReach = 0.02;
    const Eigen::Vector3d around = solid.nearest(p);
    for (int i = 0; i < 4000; ++i) {
      // Half of the samples near the answer, so that brute force comes close to it.
      const Eigen::Vector3d q = i % 2 == 0 ? random.in_cube(2.5) : Eigen::Vector3d(around + random.in_cube(kReach));
      if (solid.contains(q)) {
        brute = std::min(brute, (q - p).norm());
      }
    }
    const std::string where = "case seed " + std::to_string(seed() + static_cast<unsigned long>(n)) + ": " +
                              solid.text + ", point " + code(p);
    ASSERT_GE(brute, d - kRounding) << where;
    ASSERT_LE(brute, d + 2 * kReach) << where;
  }
}

TEST(Shapes, TransformedSolidHasTheSameDistances) {
  Random random(seed());
  for (int n = 0; n < 200; ++n) {
    const Pose T_A_world = random.pose(2);
    const Eigen::Vector3d p = random.in_cube(2);
    const Plane plane{random.unit(), random.uniform(-1, 1)};
    const Box box{random.pose(1), {0.1, 0.2, 0.3}};
    const Capsule capsule{random.in_cube(1), random.in_cube(1), 0.1};
    const auto distance = [](const auto& shape, const Eigen::Vector3d& q) {
      return (nearest_point(shape, q) - q).norm();
    };
    EXPECT_NEAR(distance(plane, p), distance(transformed(T_A_world, plane), T_A_world * p), kRounding);
    EXPECT_NEAR(distance(box, p), distance(transformed(T_A_world, box), T_A_world * p), kRounding);
    EXPECT_NEAR(distance(capsule, p), distance(transformed(T_A_world, capsule), T_A_world * p), kRounding);
  }
}

template <class Shape>
std::string refusal(const Shape& shape) {
  try {
    validate(shape);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Shapes, BrokenOnesAreRefusedWithValueAndRule) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal(Plane{{0, 0, 2}, 0}), "plane: normal (0 0 2) has length 2, must be 1");
  EXPECT_EQ(refusal(Plane{{0, 0, 1}, infinite}), "plane: offset is inf m, must be finite");
  EXPECT_EQ(refusal(Plane{{nan, 0, 1}, 0}), "plane: normal is (nan   0   1), must be finite");
  EXPECT_EQ(refusal(Box{Pose::Identity(), {1, 0, 1}}), "box: half size in y is 0 m, must be a positive finite number");
  Box sheared;
  sheared.T_world_box.linear()(0, 1) = 0.5;
  EXPECT_EQ(refusal(sheared), "box: rotation deviates from orthonormal by 0.5, must be at most 1e-09");
  Box nowhere;
  nowhere.T_world_box.translation().z() = nan;
  EXPECT_EQ(refusal(nowhere), "box: centre is (  0   0 nan), must be finite");
  EXPECT_EQ(refusal(Sphere{{0, 0, 0}, -0.1}), "sphere: radius is -0.1 m, must be a positive finite number");
  EXPECT_EQ(refusal(Sphere{{0, infinite, 0}, 0.1}), "sphere: centre is (  0 inf   0), must be finite");
  EXPECT_EQ(refusal(Capsule{{0, 0, 0}, {0, 0, 1}, nan}), "capsule: radius is nan m, must be a positive finite number");
  EXPECT_EQ(refusal(Capsule{{0, 0, 0}, {nan, 0, 1}, 0.1}), "capsule: end b is (nan   0   1), must be finite");
}

}  // namespace
}  // namespace depthgrid::simulation::testing
