#include "depthgrid/core/proximity.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <string>

namespace depthgrid {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr std::array kStates{ProximityState::not_evaluated, ProximityState::measured,   ProximityState::occluded,
                             ProximityState::unmeasured,    ProximityState::unobserved, ProximityState::outside,
                             ProximityState::beyond_rho};

Proximity answer(ProximityState state, double distance_m) {
  Proximity result;
  result.state = state;
  result.distance_m = distance_m;
  return result;
}

TEST(Proximity, HoldsNoNumbersUntilItIsFilled) {
  const Proximity empty;
  EXPECT_EQ(empty.state, ProximityState::not_evaluated);
  EXPECT_TRUE(std::isnan(empty.distance_m));
  EXPECT_TRUE(empty.nearest_world.array().isNaN().all());
  EXPECT_TRUE(empty.direction_world.array().isNaN().all());
  EXPECT_FALSE(empty.camera.has_value());
  EXPECT_FALSE(empty.stale);
  EXPECT_FALSE(empty.budget);
  EXPECT_FALSE(has_distance(empty));
}

TEST(Proximity, EveryStateHasItsOwnName) {
  std::set<std::string> names;
  for (const ProximityState state : kStates) {
    names.insert(std::string(to_string(state)));
  }
  EXPECT_EQ(names, (std::set<std::string>{"not_evaluated", "measured", "occluded", "unmeasured", "unobserved",
                                          "outside", "beyond_rho"}));
}

TEST(Proximity, HasADistanceWhereThatIsANumber) {
  EXPECT_TRUE(has_distance(answer(ProximityState::measured, 0.1)));
  EXPECT_TRUE(has_distance(answer(ProximityState::beyond_rho, 0.4)));
  EXPECT_TRUE(has_distance(answer(ProximityState::outside, 0.0)));  // where outside space counts as obstacle
  EXPECT_FALSE(has_distance(answer(ProximityState::outside, Proximity::kNaN)));
  EXPECT_FALSE(has_distance(answer(ProximityState::not_evaluated, Proximity::kNaN)));
}

TEST(LowerBoundAfter, ShrinksByTheFastestMotion) {
  EXPECT_DOUBLE_EQ(lower_bound_after(answer(ProximityState::measured, 0.3), 0.1, 1.6), 0.14);
  EXPECT_DOUBLE_EQ(lower_bound_after(answer(ProximityState::beyond_rho, 0.4), 0.05, 2.0), 0.3);
  EXPECT_DOUBLE_EQ(lower_bound_after(answer(ProximityState::occluded, 0.3), 0.0, 1.6), 0.3);
  EXPECT_DOUBLE_EQ(lower_bound_after(answer(ProximityState::unobserved, 0.3), 100.0, 0.0), 0.3);
}

TEST(LowerBoundAfter, IsNeverNegative) {
  EXPECT_EQ(lower_bound_after(answer(ProximityState::measured, 0.3), 1.0, 1.6), 0.0);
  EXPECT_EQ(lower_bound_after(answer(ProximityState::measured, 0.3), kInfinity, 1.6), 0.0);
  EXPECT_EQ(lower_bound_after(answer(ProximityState::measured, 0.0), 0.0, 1.6), 0.0);
}

TEST(LowerBoundAfter, HasNoAnswerForNonsense) {
  const Proximity measured = answer(ProximityState::measured, 0.3);
  EXPECT_TRUE(std::isnan(lower_bound_after(measured, -1e-9, 1.6)));
  EXPECT_TRUE(std::isnan(lower_bound_after(measured, Proximity::kNaN, 1.6)));
  EXPECT_TRUE(std::isnan(lower_bound_after(measured, 0.1, Proximity::kNaN)));
  EXPECT_TRUE(std::isnan(lower_bound_after(measured, 0.1, -1.0)));
  EXPECT_TRUE(std::isnan(lower_bound_after(answer(ProximityState::outside, Proximity::kNaN), 0.1, 1.6)));
  EXPECT_TRUE(std::isnan(lower_bound_after({}, 0.1, 1.6)));
}

TEST(LowerBoundAfter, InfiniteTimeAtNoSpeedOrInfiniteSpeedAtOnceGivesNothingAway) {
  // 0 times infinity is no number; the only bound left is 0.
  const Proximity measured = answer(ProximityState::measured, 0.3);
  EXPECT_FALSE(lower_bound_after(measured, kInfinity, 0.0) > 0.0);
  EXPECT_FALSE(lower_bound_after(measured, 0.0, kInfinity) > 0.0);
}

}  // namespace
}  // namespace depthgrid
