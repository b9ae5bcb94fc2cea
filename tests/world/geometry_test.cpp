// Closed forms against sampling.
#include "world/geometry.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/random_run.hpp"
#include "world/random.hpp"

namespace depthgrid::world {
namespace {

using Eigen::Vector3d;

Capsule random_capsule(Random& random, double reach_m) {
  const Vector3d a = random.in_box(Vector3d::Constant(-reach_m), Vector3d::Constant(reach_m));
  const Vector3d b = random.chance(0.2) ? a : random.in_box(Vector3d::Constant(-reach_m), Vector3d::Constant(reach_m));
  return {a, b, random.uniform(0.01, 0.3)};
}

TEST(Geometry, DistancesAreThoseOfTheNearestOfManyPoints) {
  const test::RandomRun run = test::random_run(300);
  constexpr int kParts = 200;
  for (std::int64_t i = 0; i < run.count; ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i), 0);
    const Capsule a = random_capsule(random, 1);
    Capsule b = random_capsule(random, 1);
    if (random.chance(0.2)) {
      b.b = b.a + random.uniform(-1, 1) * (a.b - a.a);  // parallel
    }
    double least_m = 1e9;
    for (int j = 0; j <= kParts; ++j) {
      const Vector3d on_a = a.a + static_cast<double>(j) / kParts * (a.b - a.a);
      for (int k = 0; k <= kParts; ++k) {
        least_m = std::min(least_m, (on_a - b.a - static_cast<double>(k) / kParts * (b.b - b.a)).norm());
      }
    }
    const double distance_m = segment_distance_m(a.a, a.b, b.a, b.b);
    EXPECT_LE(distance_m, least_m + 1e-12) << i << "; " << run.reproduce();
    EXPECT_GE(distance_m, least_m - 0.02) << i << "; " << run.reproduce();
    EXPECT_NEAR(distance_m, segment_distance_m(b.b, b.a, a.a, a.b), 1e-9) << i << "; " << run.reproduce();
    EXPECT_NEAR(gap_m(a, b), distance_m - a.radius_m - b.radius_m, 1e-12);
  }
}

TEST(Geometry, ARayEntersWhereItMeetsTheSurfaceFirst) {
  const test::RandomRun run = test::random_run(300);
  int met = 0;
  for (std::int64_t i = 0; i < run.count; ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i), 1);
    const Capsule capsule = random_capsule(random, 1);
    const Vector3d ray = random.in_box({-0.8, -0.8, 1}, {0.8, 0.8, 1.0});
    const auto hit = first_hit(capsule, ray);
    const double last = hit.value_or(3);
    for (int k = 0; k < 400 && last > 0; ++k) {
      const double s = last * k / 400.0;
      EXPECT_GE(gap_m(capsule, Vector3d(s * ray)), -1e-9) << i << "; " << run.reproduce();
    }
    if (hit) {
      ++met;
      EXPECT_TRUE(*hit == 0 || std::abs(gap_m(capsule, Vector3d(*hit * ray))) < 1e-9) << i << "; " << run.reproduce();
    }
  }
  EXPECT_GT(met, run.count / 10);
}

TEST(Geometry, WallsAreHalfSpaces) {
  const HalfSpace floor{Vector3d::UnitZ(), 0.5};
  EXPECT_DOUBLE_EQ(gap_m({{0, 0, 1}, {3, 0, 2}, 0.1}, floor), 0.4);
  EXPECT_DOUBLE_EQ(gap_m({{0, 0, 0.2}, {3, 0, 2}, 0.1}, floor), -0.4);
}

}  // namespace
}  // namespace depthgrid::world
