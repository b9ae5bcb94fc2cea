// The letter's task in a closed loop, and commands that stay within the limits whatever comes in.
#include "depthgrid/control/controller.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "control/cell.hpp"
#include "support/random_run.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::control {
namespace {

using Eigen::Vector3d;
using test::Cell;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const test::Sphere kFarAway{{0, 0, -100}, 0.1};

double distance_to_edge(const Vector3d& p, const PolygonSettings& polygon) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.vertices_world.size(); ++i) {
    const Vector3d& a = polygon.vertices_world[i];
    const Vector3d& b = polygon.vertices_world[(i + 1) % polygon.vertices_world.size()];
    const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (p - a - t * (b - a)).norm());
  }
  return nearest;
}

class Variants : public ::testing::TestWithParam<SaturationVariant> {};
INSTANTIATE_TEST_SUITE_P(Task, Variants, ::testing::Values(SaturationVariant::basic, SaturationVariant::optimal),
                         [](const auto& variant) {
                           return variant.param == SaturationVariant::basic ? "basic" : "optimal";
                         });

TEST_P(Variants, RunsAlongTheHexagonAtItsSpeed) {
  ControllerSettings settings = test::lwr_settings();
  settings.saturation.variant = GetParam();
  Cell cell(settings, 0);
  const PolygonSettings polygon = test::lwr_hexagon();
  double worst = 0, fastest = 0;
  std::int64_t first_lap_end = 0;
  int at_speed = 0, counted = 0;
  Vector3d before = test::lwr_flange(test::lwr_bent()).p_world;
  for (int k = 0; k < 10000; ++k) {
    cell.period(kFarAway);
    ASSERT_TRUE(cell.taken);
    const double speed = (cell.tip_world - before).norm() / 0.002;
    before = cell.tip_world;
    if (cell.task.vertices_reached() >= 1) {
      worst = std::max(worst, distance_to_edge(cell.tip_world, polygon));
      fastest = std::max(fastest, speed);
      ++counted;
      at_speed += speed > 0.39 ? 1 : 0;
    }
    if (cell.task.vertices_reached() == 7 && first_lap_end == 0) {
      first_lap_end = k;
    }
  }
  RecordProperty("path error, um", static_cast<int>(1e6 * worst));
  std::cout << "path error " << 1e3 * worst << " mm, fastest " << fastest << " m/s, at speed "
            << 100.0 * at_speed / counted << " %, vertices " << cell.task.vertices_reached() << '\n';
  EXPECT_EQ(cell.arm.not_followed(), 0);
  EXPECT_LT(worst, 0.006);  // corners are cut by up to the arrival distance of 5 mm
  EXPECT_LT(fastest, 0.405);
  EXPECT_GT(at_speed, 0.45 * counted);          // the rest is spent at the corners
  EXPECT_GT(cell.task.vertices_reached(), 24);  // 20 s at 0.2 m an edge
}

TEST(Controller, EvadesASphereAndResumes) {
  for (const BodyLaw law : {BodyLaw::risk, BodyLaw::approach_speed, BodyLaw::approach_row}) {
    ControllerSettings settings = test::lwr_settings();
    settings.body.law = law;
    Cell cell(settings, 5);
    const Vector3d middle = test::lwr_flange(test::lwr_bent()).p_world;
    double tip = test::kRho, body = test::kRho, farthest_off = 0, fastest_approach = 0;
    std::int64_t reached_before = 0, reached_after = 0;
    for (int k = 0; k < 15000; ++k) {
      // Comes in from the front at 0.3 m/s, stays where the task is, and leaves.
      const double t = 0.002 * k;
      const double away = t < 10 ? std::max(0.1, 1.5 - 0.3 * std::max(0.0, t - 4)) : 0.1 + 0.3 * std::max(0.0, t - 14);
      cell.period({middle + Vector3d(away, 0, 0), 0.05});
      tip = std::min(tip, cell.tip_m);
      body = std::min(body, cell.nearest_m);
      for (const BodyPoint& point : cell.near_points) {
        if (*point.obstacle.distance_m < 0.1 && point.obstacle.direction_world) {
          const Vector3d velocity = point.jacobian * cell.output.command.velocity_rad_s;
          fastest_approach = std::max(fastest_approach, velocity.dot(*point.obstacle.direction_world));
        }
      }
      farthest_off = std::max(farthest_off, (cell.tip_world - middle).norm());
      reached_before = t < 4 ? cell.task.vertices_reached() : reached_before;
      reached_after = t < 22 ? cell.task.vertices_reached() : reached_after;
    }
    std::cout << "law " << static_cast<int>(law) << ": tip " << tip << " m, body " << body
              << " m, approach within 0.1 m at " << fastest_approach << " m/s, farthest off " << farthest_off
              << " m, vertices " << reached_before << ", " << reached_after << ", " << cell.task.vertices_reached()
              << '\n';
    EXPECT_GT(tip, 0.15);
    EXPECT_GT(body, 0.02);  // the body does not retreat: the sphere comes to it
    EXPECT_LT(fastest_approach, 0.12);
    EXPECT_GT(farthest_off, 0.2);
    EXPECT_GT(cell.task.vertices_reached(), reached_after + 5);
    EXPECT_EQ(cell.arm.not_followed(), 0);
  }
}

/// Everything jumps and much is not finite; the command stays within all limits.
TEST(Controller, KeepsTheLimitsWhateverComesIn) {
  const auto run = depthgrid::test::random_run(40);
  for (std::int64_t i = 0; i < run.count; ++i) {
    const std::uint64_t seed = run.seed + static_cast<std::uint64_t>(i);
    SCOPED_TRACE("DEPTHGRID_TEST_SEED=" + std::to_string(seed) + " DEPTHGRID_TEST_COUNT=1");
    std::mt19937_64 engine(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    ControllerSettings settings = test::lwr_settings();
    settings.saturation.variant = seed % 3 == 0 ? SaturationVariant::basic : SaturationVariant::optimal;
    settings.body.law = seed % 3 == 0 ? BodyLaw::risk : static_cast<BodyLaw>(seed % 3);
    settings.pivot = seed % 2 == 0 ? std::optional<PivotSettings>(PivotSettings{}) : std::nullopt;
    const JointLimits& limits = settings.limits;
    Controller controller(settings);
    ASSERT_TRUE(controller.start(test::lwr_bent()));
    const auto wild = [&] {
      const double x = unit(engine);
      return x > 0.999 ? kNaN : (x < -0.999 ? -std::numeric_limits<double>::infinity() : 3 * x);
    };
    for (int k = 0; k < 500; ++k) {
      const JointCommand before = controller.last();
      const test::LwrPoint tip = test::lwr_flange(before.position_rad);
      std::vector<BodyPoint> body;
      for (const test::LwrPoint& point : test::lwr_body(before.position_rad)) {
        Proximity proximity;
        proximity.distance_m = 0.1 * std::abs(wild());
        proximity.direction_world = Vector3d(wild(), wild(), wild());
        body.push_back({point.jacobian, obstacle_of(proximity)});
        body.back().jacobian(0, 0) += 0 * wild();
      }
      const CycleOutput output = controller.cycle({.task = {tip.jacobian, Vector3d(wild(), wild(), wild())},
                                                   .end_effector = body[static_cast<std::size_t>(k) % 8].obstacle,
                                                   .body = body,
                                                   .further_tasks = {}});
      const JointCommand& now = output.command;
      ASSERT_TRUE(now.position_rad.allFinite());
      ASSERT_GE((now.position_rad - limits.lowest_rad).minCoeff(), -1e-12);
      ASSERT_GE((limits.highest_rad - now.position_rad).minCoeff(), -1e-12);
      ASSERT_GE((limits.velocity_rad_s - now.velocity_rad_s.cwiseAbs()).minCoeff(), 0.0);
      const JointVector change = (now.velocity_rad_s - before.velocity_rad_s).cwiseAbs();
      ASSERT_GE((limits.acceleration_rad_s2 * settings.period_s - change).minCoeff(), -1e-12);
    }
  }
}

TEST(Controller, WithoutADirectionTheTaskSlowsByTheRisk) {
  Controller controller(test::lwr_settings());
  ASSERT_TRUE(controller.start(test::lwr_bent()));
  const test::LwrPoint tip = test::lwr_flange(test::lwr_bent());
  for (int k = 0; k < 200; ++k) {
    const CycleOutput output = controller.cycle(
        {.task = {tip.jacobian, Vector3d(0.4, 0, 0)}, .end_effector = {}, .body = {}, .further_tasks = {}});
    ASSERT_LE((tip.jacobian * output.command.velocity_rad_s).norm(), 0.4 * 0.0026);
    ASSERT_EQ(output.repulsion_m_s.norm(), 0);
  }
}

TEST(Controller, AnUnknownBodyPointStopsTheArm) {
  Cell cell(test::lwr_settings(), 0);
  for (int k = 0; k < 1000; ++k) {
    cell.period(kFarAway);
  }
  EXPECT_GT(cell.controller.last().velocity_rad_s.norm(), 0.1);
  const BodyPoint unknown{test::lwr_flange(cell.controller.last().position_rad).jacobian, {}};
  for (int k = 0; k < 500; ++k) {
    const test::LwrPoint tip = test::lwr_flange(cell.controller.last().position_rad);
    (void)cell.controller.cycle({.task = {tip.jacobian, Vector3d(0.4, 0, 0)},
                                 .end_effector = obstacle_of(test::sphere_proximity(tip.p_world, kFarAway)),
                                 .body = {&unknown, 1},
                                 .further_tasks = {}});
  }
  EXPECT_LT((unknown.jacobian * cell.controller.last().velocity_rad_s).norm(), 0.02);
}

TEST(Controller, WhatDoesNotPushDoesNotPushByMemoryEither) {
  const test::LwrPoint tip = test::lwr_flange(test::lwr_bent());
  for (const bool pushes : {true, false}) {
    Controller controller(test::lwr_settings());
    ASSERT_TRUE(controller.start(test::lwr_bent()));
    Obstacle near{.distance_m = 0.05, .direction_world = Vector3d::UnitX()};
    near.hybrid_direction_world = Vector3d::UnitX();
    const auto repulsion_m_s = [&](const Obstacle& obstacle) {
      return controller
          .cycle({.task = {tip.jacobian, Vector3d::Zero()}, .end_effector = obstacle, .body = {}, .further_tasks = {}})
          .repulsion_m_s.norm();
    };
    EXPECT_GT(repulsion_m_s(near), 0.1);
    Obstacle contact{.distance_m = 0.0, .direction_world = {}};
    contact.pushes = pushes;
    EXPECT_EQ(repulsion_m_s(contact) > 0, pushes);
    contact.pushes = true;
    EXPECT_EQ(repulsion_m_s(contact) > 0, pushes) << "nor afterwards";
  }
}

TEST(Controller, AnUnknownDistanceDoesNotPushByMemory) {
  const test::LwrPoint tip = test::lwr_flange(test::lwr_bent());
  Controller controller(test::lwr_settings());
  ASSERT_TRUE(controller.start(test::lwr_bent()));
  const Obstacle near{.distance_m = 0.05, .direction_world = Vector3d::UnitX()};
  for (const Obstacle& obstacle : {near, Obstacle{}, Obstacle{}}) {
    const CycleOutput output = controller.cycle(
        {.task = {tip.jacobian, Vector3d::Zero()}, .end_effector = obstacle, .body = {}, .further_tasks = {}});
    EXPECT_EQ(output.repulsion_m_s.norm() > 0, obstacle.distance_m.has_value());
  }
}

TEST(Controller, BrakesWithEveryJointsOwnAcceleration) {
  Cell cell(test::lwr_settings(), 0);
  for (int k = 0; k < 1000; ++k) {
    cell.period(kFarAway);
  }
  const JointLimits limits = test::lwr_settings().limits;
  const double period_s = test::lwr_settings().period_s;
  JointVector before = cell.controller.last().velocity_rad_s;
  ASSERT_GT(before.norm(), 0.1);
  for (int k = 0; k < 1000; ++k) {
    const JointVector now = cell.controller.brake().command.velocity_rad_s;
    for (int j = 0; j < limits.joints(); ++j) {
      const double expected = std::max(0.0, std::abs(before[j]) - limits.acceleration_rad_s2[j] * period_s);
      ASSERT_NEAR(std::abs(now[j]), expected, 1e-12);
      ASSERT_GE(now[j] * before[j], 0);
    }
    before = now;
  }
  EXPECT_EQ(before.norm(), 0);
}

TEST(Controller, SettingsAreChecked) {
  using depthgrid::test::thrown_message;
  ControllerSettings settings = test::lwr_settings();
  EXPECT_EQ(thrown_message([&] { validate(settings); }), "");
  settings.body.law = BodyLaw::approach_row;
  settings.saturation.variant = SaturationVariant::basic;
  EXPECT_NE(thrown_message([&] { Controller controller(settings); }), "");
  settings = test::lwr_settings();
  settings.posture_rad.conservativeResize(3);
  EXPECT_NE(thrown_message([&] { Controller controller(settings); }), "");
  settings = test::lwr_settings();
  settings.period_s = 0;
  EXPECT_NE(thrown_message([&] { Controller controller(settings); }), "");
  EXPECT_NE(thrown_message([] { PolygonTask task(PolygonSettings{}); }), "");
  EXPECT_NE(thrown_message([] { (void)vertical_hexagon(Vector3d::Zero(), 0.2, Vector3d::UnitZ()); }), "");
  EXPECT_NE(thrown_message([] { SimulatedArm arm(test::lwr_limits(), 0.002, test::lwr_bent(), -1); }), "");
  EXPECT_NE(thrown_message([] { SimulatedArm arm(test::lwr_limits(), 0.002, JointVector::Constant(7, 9)); }), "");
}

TEST(SimulatedArm, IsLateByItsLatencyAndCountsWhatItCannotFollow) {
  SimulatedArm arm(test::lwr_limits(), 0.002, JointVector::Zero(7), 3);
  CommandLimiter limiter(test::lwr_limits(), 0.002);
  ASSERT_TRUE(limiter.start(JointVector::Zero(7), JointVector::Zero(7)));
  std::vector<JointVector> commanded;
  JointState state;
  for (int k = 0; k < 200; ++k) {
    commanded.push_back(limiter.step(JointVector::Constant(7, 0.5)).position_rad);
    ASSERT_TRUE(arm.write(limiter.last()));
    arm.advance();
    ASSERT_TRUE(arm.read(state));
    if (k >= 3) {
      ASSERT_LE((state.position_rad - commanded[static_cast<std::size_t>(k - 3)]).cwiseAbs().maxCoeff(), 1e-12);
    }
  }
  EXPECT_NEAR(state.time_s, 0.4, 1e-12);
  EXPECT_EQ(arm.not_followed(), 0);
  EXPECT_FALSE(arm.write({JointVector::Constant(7, kNaN), JointVector::Zero(7)}));
  EXPECT_FALSE(arm.write({JointVector::Zero(3), JointVector::Zero(3)}));
  const JointVector far = state.position_rad + JointVector::Ones(7);
  for (int k = 0; k < 2000; ++k) {  // a jump: it goes there as fast as it can, then stays
    ASSERT_TRUE(arm.write({far, JointVector::Zero(7)}));
    arm.advance();
  }
  EXPECT_GT(arm.not_followed(), 0);
  ASSERT_TRUE(arm.read(state));
  EXPECT_LE((state.position_rad - far).cwiseAbs().maxCoeff(), 1e-9);
}

}  // namespace
}  // namespace depthgrid::control
