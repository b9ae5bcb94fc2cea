// Repulsion, pivot, limits from the body's points, and what is kept after contact.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "control/lwr.hpp"
#include "depthgrid/control/body_limits.hpp"
#include "depthgrid/control/contact_memory.hpp"
#include "depthgrid/control/pivot.hpp"
#include "depthgrid/control/repulsion.hpp"
#include "support/random_run.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::control {
namespace {

using Eigen::Vector3d;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Proximity answer(double distance_m, const Vector3d& direction) {
  Proximity proximity;
  proximity.distance_m = distance_m;
  proximity.direction_world = direction;
  proximity.state = ProximityState::measured;
  return proximity;
}

TEST(Repulsion, MagnitudeIsTheLogisticOfTheDistance) {
  const std::array<double, 4> expected{0.9975, 0.9526, 0.5, 0.0474};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(risk(0.1 * static_cast<double>(i), 0.4, 6), expected[i], 1e-4);
  }
  EXPECT_EQ(risk(0.2, 0.4, 6), 0.5);
  EXPECT_NEAR(risk(0.4 - 1e-9, 0.4, 6), 0.0025, 1e-4);
  EXPECT_EQ(risk(0.4, 0.4, 6), 0);
  EXPECT_EQ(risk(-1, 0.4, 6), risk(0, 0.4, 6));
  EXPECT_EQ(risk(kNaN, 0.4, 6), risk(0, 0.4, 6));
  EXPECT_EQ(risk(Obstacle{}, 0.4, 6), risk(0, 0.4, 6));
}

TEST(Repulsion, PointsAwayInEveryForm) {
  const Vector3d mean(0.3, 0.3, 0);  // as printed: not of length one
  const Obstacle obstacle = obstacle_of(answer(0.2, Vector3d::UnitX()), mean);
  RepulsionSettings settings;
  const double v = 0.75;
  settings.form = RepulsionForm::nearest;
  EXPECT_LE((repulsive_velocity(obstacle, settings) + v * Vector3d::UnitX()).norm(), 1e-12);
  settings.form = RepulsionForm::letter;
  EXPECT_LE((repulsive_velocity(obstacle, settings) + v * mean).norm(), 1e-12);
  settings.form = RepulsionForm::unit_mean;
  EXPECT_LE((repulsive_velocity(obstacle, settings) + v * mean.normalized()).norm(), 1e-12);
  settings.form = RepulsionForm::corrected;
  EXPECT_LE((repulsive_velocity(obstacle, settings) + v * mean.normalized()).norm(), 1e-12);
}

TEST(Repulsion, ObstaclesOnBothSidesCancelInTheLettersFormOnly) {
  const Obstacle obstacle = obstacle_of(answer(0.1, Vector3d::UnitX()), Vector3d::Zero());
  RepulsionSettings settings;
  settings.form = RepulsionForm::letter;
  EXPECT_EQ(repulsive_velocity(obstacle, settings).norm(), 0);
  settings.form = RepulsionForm::corrected;
  EXPECT_GT(-repulsive_velocity(obstacle, settings).x(), 1.0);
}

TEST(Repulsion, NeedsADirection) {
  RepulsionSettings settings;
  EXPECT_EQ(repulsive_velocity(Obstacle{}, settings).norm(), 0);
  EXPECT_EQ(repulsive_velocity(obstacle_of(answer(0, Vector3d::Zero())), settings).norm(), 0);
  EXPECT_EQ(repulsive_velocity(obstacle_of(answer(0.4, Vector3d::UnitX())), settings).norm(), 0);
}

TEST(Obstacle, AgesWithTheImage) {
  EXPECT_EQ(obstacle_of(answer(0.3, Vector3d::UnitX())).distance_m, 0.3);
  EXPECT_NEAR(*obstacle_of(answer(0.3, Vector3d::UnitX()), Vector3d::Zero(), 0.05, 2).distance_m, 0.2, 1e-12);
  EXPECT_FALSE(obstacle_of(Proximity{}).distance_m.has_value());
  EXPECT_FALSE(obstacle_of(answer(0.3, Vector3d::UnitX()), Vector3d::Zero(), -1, 2).distance_m.has_value());
  EXPECT_FALSE(obstacle_of(answer(0.3, Vector3d::Constant(kNaN))).direction_world.has_value());
}

TEST(Repulsion, SettingsAreChecked) {
  using depthgrid::test::thrown_message;
  EXPECT_EQ(thrown_message([] { validate(RepulsionSettings{.rho_m = 0}); }),
            "repulsion: rho is 0 m, must be greater than 0 and finite");
  EXPECT_NE(thrown_message([] { validate(RepulsionSettings{.v_max_m_s = -1}); }), "");
  EXPECT_NE(thrown_message([] { validate(RepulsionSettings{.alpha = kNaN}); }), "");
  EXPECT_NE(thrown_message([] { validate(BodySettings{.stop_m = 0.5}); }), "");
  EXPECT_NE(thrown_message([] { validate(BodySettings{.gain_per_s = 0}); }), "");
  EXPECT_NE(thrown_message([] { validate(PivotSettings{.rate_m_s2 = 0}); }), "");
}

TEST(Pivot, KeepsLengthAndPlaneAndTurnsAwayFromAnApproachingObstacle) {
  std::mt19937_64 engine(depthgrid::test::random_run(1).seed);
  std::normal_distribution<double> gauss;
  const auto draw = [&] { return Vector3d(gauss(engine), gauss(engine), gauss(engine)); };
  int turned = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vector3d v = draw();
    const Vector3d before = v - 0.01 * draw();
    const Vector3d pivot = pivoted(v, before, 0.01, {});
    const Vector3d a = (v - before).normalized();
    EXPECT_NEAR(pivot.norm(), v.norm(), 1e-9);
    EXPECT_NEAR(pivot.dot(v.cross(a)), 0, 1e-9);  // in the plane of V and its rate
    const double beta = std::acos(a.dot(v.normalized()));
    const double gamma = std::acos(std::clamp(a.dot(pivot.normalized()), -1.0, 1.0));
    if (beta < std::numbers::pi / 2) {
      ++turned;
      EXPECT_LE(std::abs(gamma), std::numbers::pi / 2 + 1e-9);
    } else {
      EXPECT_EQ(pivot, v);  // it recedes
    }
  }
  EXPECT_GT(turned, 300);
}

TEST(Pivot, LeavesWhatHasNoDirection) {
  const Vector3d v(1, 0, 0);
  EXPECT_EQ(pivoted(v, v, 0.01, {}), v);
  EXPECT_EQ(pivoted(v, Vector3d::Zero(), 0.01, {}), v);  // straight on
  EXPECT_EQ(pivoted(Vector3d::Zero(), v, 0.01, {}), Vector3d(Vector3d::Zero()));
  EXPECT_EQ(pivoted(v, Vector3d::Zero(), 0, {}), v);
  EXPECT_EQ(pivoted(v, Vector3d::Constant(kNaN), 0.01, {}), v);
}

/// Random poses of an arm, points of its body and directions.
template <class Check>
void for_random_points(const Check& check) {
  const auto run = depthgrid::test::random_run(2000);
  for (std::int64_t i = 0; i < run.count; ++i) {
    const std::uint64_t seed = run.seed + static_cast<std::uint64_t>(i);
    SCOPED_TRACE("DEPTHGRID_TEST_SEED=" + std::to_string(seed) + " DEPTHGRID_TEST_COUNT=1");
    std::mt19937_64 engine(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    JointVector q(7);
    for (int k = 0; k < 7; ++k) {
      q[k] = 2 * unit(engine);
    }
    const auto body = test::lwr_body(q);
    const auto& point = body[static_cast<std::size_t>(i) % body.size()];
    const Vector3d n = Vector3d(unit(engine), unit(engine), unit(engine)).normalized();
    check(point, n, 0.2 + 0.2 * unit(engine));
  }
}

TEST(BodyLimits, RiskScalesExactlyTheJointsThatApproach) {
  const JointVector v = test::lwr_limits().velocity_rad_s;
  for_random_points([&](const test::LwrPoint& point, const Vector3d& n, double distance) {
    JointBox box{-v, v};
    limit_by_obstacle(box, v, point.jacobian, obstacle_of(answer(distance, n)), {});
    const double left = 1 - risk(distance, 0.4, 6);
    for (int i = 0; i < 7; ++i) {
      const double lever = point.jacobian.col(i).dot(n);
      EXPECT_DOUBLE_EQ(box.upper_rad_s[i], lever > 1e-9 ? v[i] * left : v[i]);
      EXPECT_DOUBLE_EQ(box.lower_rad_s[i], lever < -1e-9 ? -v[i] * left : -v[i]);
    }
  });
}

TEST(BodyLimits, ApproachSpeedHoldsForEveryMotionInTheBox) {
  const JointVector v = test::lwr_limits().velocity_rad_s;
  const BodySettings settings{.law = BodyLaw::approach_speed};
  for_random_points([&](const test::LwrPoint& point, const Vector3d& n, double distance) {
    JointBox box{-v, v};
    limit_by_obstacle(box, v, point.jacobian, obstacle_of(answer(distance, n)), settings);
    const double allowed = 2.0 * std::max(0.0, distance - 0.05);
    EXPECT_LE(fastest_approach(box, point.jacobian, n), std::max(allowed, 0.0) + 1e-9);
    // Retreat is as free as before.
    EXPECT_NEAR(fastest_approach(box, point.jacobian, -n), fastest_approach({-v, v}, point.jacobian, -n), 1e-9);
    const auto row = approach_limit(point.jacobian, obstacle_of(answer(distance, n)), settings);
    EXPECT_TRUE(row.has_value());
    EXPECT_NEAR(row->speed_m_s, allowed, 1e-12);
  });
}

TEST(BodyLimits, WhatIsUnknownStopsAllThatMovesThePoint) {
  const JointVector v = test::lwr_limits().velocity_rad_s;
  const test::LwrPoint elbow = test::lwr_body(test::lwr_bent())[3];  // moved by the first joints only
  for (const BodyLaw law : {BodyLaw::risk, BodyLaw::approach_speed, BodyLaw::approach_row}) {
    JointBox box{-v, v};
    limit_by_obstacle(box, v, elbow.jacobian, Obstacle{}, {.law = law});
    EXPECT_LT(box.upper_rad_s[0], 0.01);
    EXPECT_GT(box.lower_rad_s[1], -0.01);
    EXPECT_EQ(box.upper_rad_s[6], v[6]);
    EXPECT_FALSE(approach_limit(elbow.jacobian, Obstacle{}, {.law = law}).has_value());
  }
  JointBox box{-v, v};
  PointJacobian unknown = elbow.jacobian;
  unknown(0, 0) = kNaN;
  limit_by_obstacle(box, v, unknown, obstacle_of(answer(1, Vector3d::UnitX())), {});
  EXPECT_EQ(box.upper_rad_s.norm() + box.lower_rad_s.norm(), 0);
}

TEST(ContactMemory, KeepsADirectionForAWhile) {
  ContactMemory memory;
  const Obstacle touching = obstacle_of(answer(0, Vector3d::Zero()));
  EXPECT_FALSE(memory.completed(touching, 1, 0.002, 0.01).direction_world.has_value());
  (void)memory.completed(obstacle_of(answer(0.1, Vector3d::UnitY())), 1, 0.002, 0.01);
  for (int k = 0; k < 4; ++k) {
    const Obstacle completed = memory.completed(touching, 1, 0.002, 0.01);
    ASSERT_TRUE(completed.direction_world.has_value());
    EXPECT_EQ(*completed.direction_world, Vector3d::UnitY());
    EXPECT_EQ(completed.distance_m, 0.0);
  }
  EXPECT_FALSE(memory.completed(touching, 2, 0.002, 0.01).direction_world.has_value());  // another point
  (void)memory.completed(touching, 1, 0.002, 0.01);
  EXPECT_FALSE(memory.completed(touching, 1, 0.002, 0.01).direction_world.has_value());  // too old
  EXPECT_FALSE(memory.completed(touching, 1000, 0.002, 1).direction_world.has_value());
}

}  // namespace
}  // namespace depthgrid::control
