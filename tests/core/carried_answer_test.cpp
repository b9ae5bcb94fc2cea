// What an answer still says about a capsule that has moved, and about obstacles that have: never too far, and as far as
// what moved allows.
#include "depthgrid/core/carried_answer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "support/random_run.hpp"

namespace depthgrid {
namespace {

using Eigen::Vector3d;

class Chance {
 public:
  explicit Chance(std::uint64_t seed) : engine_(seed) {}
  double between(double low, double high) { return std::uniform_real_distribution(low, high)(engine_); }
  Vector3d within(double half_m) {
    return {between(-half_m, half_m), between(-half_m, half_m), between(-half_m, half_m)};
  }
  Vector3d of_length(double length_m) { return length_m * (within(1) + Vector3d(1e-3, 0, 0)).normalized(); }

 private:
  std::mt19937_64 engine_;
};

double distance_m(const Capsule& capsule, const std::vector<Vector3d>& obstacles) {
  double least_m = std::numeric_limits<double>::infinity();
  for (const Vector3d& p : obstacles) {
    least_m = std::min(least_m, std::max(0.0, distance_to_axis(capsule, p) - capsule.radius_m));
  }
  return least_m;
}

Answer answer_for(const Capsule& capsule, const std::vector<Vector3d>& obstacles, double rho_m) {
  Answer answer;
  const double d_m = distance_m(capsule, obstacles);
  answer.nearest.distance_m = std::min(d_m, rho_m);
  answer.nearest.state = d_m < rho_m ? ProximityState::measured : ProximityState::beyond_rho;
  answer.distance_now_m = answer.nearest.distance_m;
  if (d_m < rho_m) {
    answer.nearest.nearest_world = *std::min_element(
        obstacles.begin(), obstacles.end(),
        [&](const auto& p, const auto& q) { return distance_to_axis(capsule, p) < distance_to_axis(capsule, q); });
  }
  return answer;
}

TEST(CarriedAnswer, NeverExceedsTheDistanceAfterBothHaveMoved) {
  const auto run = test::random_run(20000);
  Chance chance(run.seed);
  std::int64_t positive = 0;
  for (std::int64_t i = 0; i < run.count; ++i) {
    const Capsule asked{chance.within(0.5), chance.within(0.5), chance.between(0, 0.1)};
    std::vector<Vector3d> obstacles(5);
    std::generate(obstacles.begin(), obstacles.end(), [&] { return chance.within(1.5); });
    const Answer answer = answer_for(asked, obstacles, 0.8);
    const double most_m = chance.between(0, 0.2);
    const Capsule now{asked.a + chance.of_length(chance.between(0, most_m)),
                      asked.b + chance.of_length(chance.between(0, most_m)), chance.between(0, 0.1)};
    const double elapsed_s = chance.between(0, 0.1);
    for (Vector3d& p : obstacles) {
      p += chance.of_length(chance.between(0, 2 * elapsed_s));
    }
    const Answer carried = carried_over(answer, asked, now, elapsed_s, 2);
    ASSERT_LE(carried.distance_now_m, distance_m(now, obstacles) + 1e-12) << "case " << i << ", " << run.reproduce();
    positive += carried.distance_now_m > 0 ? 1 : 0;
  }
  EXPECT_GT(positive, run.count / 4);
}

TEST(CarriedAnswer, IsExactWhereTheRobotMovesStraightAtTheObstacle) {
  const std::vector<Vector3d> wall{{1, 0, 0}};
  const Capsule asked = Capsule::sphere({0, 0, 0}, 0.1);
  const Answer answer = answer_for(asked, wall, 2);
  const Answer nearer = carried_over(answer, asked, Capsule::sphere({0.3, 0, 0}, 0.1), 0.05, 2);
  EXPECT_NEAR(nearer.nearest.distance_m, 0.6, 1e-12);
  EXPECT_NEAR(nearer.distance_now_m, 0.5, 1e-12);
  EXPECT_EQ(nearer.on_axis_world, Vector3d(0.3, 0, 0));
  EXPECT_EQ(nearer.nearest.direction_world, Vector3d(1, 0, 0));
  const Answer thicker = carried_over(answer, asked, Capsule::sphere({0, 0, 0}, 0.25), 0, 2);
  EXPECT_NEAR(thicker.distance_now_m, 0.75, 1e-12);
  // Thinner than it was: what was said then still holds, no more.
  EXPECT_NEAR(carried_over(answer, asked, Capsule::point({0, 0, 0}), 0, 2).distance_now_m, 0.9, 1e-12);
  EXPECT_EQ(carried_over(answer, asked, Capsule::point({5, 0, 0}), 0, 2).distance_now_m, 0);
}

TEST(CarriedAnswer, TheBorderComesNearerToo) {
  Answer answer;
  answer.nearest.distance_m = 0.5;
  answer.nearest.known_to_m = 0.2;
  answer.distance_now_m = 0.2;
  const Capsule here = Capsule::point({0, 0, 0});
  const Answer carried = carried_over(answer, here, Capsule::point({0, 0.15, 0}), 0.01, 1);
  EXPECT_NEAR(carried.nearest.known_to_m, 0.05, 1e-12);
  EXPECT_NEAR(carried.distance_now_m, 0.04, 1e-12);
}

TEST(CarriedAnswer, WhatIsNotKnownStaysNotKnown) {
  const Capsule here = Capsule::point({0, 0, 0});
  Answer answer = answer_for(here, {{1, 0, 0}}, 2);
  EXPECT_TRUE(std::isnan(carried_over(answer, here, here, -0.001, 2).distance_now_m));
  EXPECT_TRUE(std::isnan(carried_over(answer, here, here, Proximity::kNaN, 2).distance_now_m));
  EXPECT_TRUE(std::isnan(carried_over(answer, here, here, 0, Proximity::kNaN).distance_now_m));
  for (const Capsule& broken : {Capsule::point({Proximity::kNaN, 0, 0}), Capsule{{0, 0, 0}, {0, 0, 0}, -1},
                                Capsule::sphere({0, 0, 0}, std::numeric_limits<double>::infinity())}) {
    EXPECT_EQ(carried_over(answer, here, broken, 0, 2).nearest.state, ProximityState::not_evaluated);
    EXPECT_TRUE(std::isnan(carried_over(answer, here, broken, 0, 2).distance_now_m));
  }
  answer.distance_now_m = Proximity::kNaN;
  EXPECT_TRUE(std::isnan(carried_over(answer, here, here, 0, 2).distance_now_m));
  EXPECT_TRUE(std::isnan(carried_over({}, here, here, 0, 2).nearest.distance_m));
}

}  // namespace
}  // namespace depthgrid
