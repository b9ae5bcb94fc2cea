// Nothing allocates from the first cycle on.
#include <gtest/gtest.h>

#include <array>

#include "control/cell.hpp"
#include "support/allocation_guard.hpp"

namespace depthgrid::control {
namespace {

using depthgrid::test::AllocationGuard;

TEST(NoAllocation, FromDistancesToTheArm) {
  DEPTHGRID_REQUIRE_ALLOCATION_COUNT();
  for (int kind = 0; kind < 4; ++kind) {
    ControllerSettings settings = test::lwr_settings();
    settings.saturation.variant = kind == 0 ? SaturationVariant::basic : SaturationVariant::optimal;
    settings.body.law = static_cast<BodyLaw>(kind % 3);
    settings.pivot = PivotSettings{};
    Controller controller(settings);
    ASSERT_TRUE(controller.start(test::lwr_bent()));
    PolygonTask task(test::lwr_hexagon());
    SimulatedArm arm(settings.limits, settings.period_s, test::lwr_bent(), 4);
    const test::Sphere sphere{test::lwr_flange(test::lwr_bent()).p_world + Eigen::Vector3d(0.15, 0.1, 0), 0.05};
    RobotPort& port = arm;
    JointState state;
    for (int k = 0; k < 300; ++k) {
      const JointVector q = controller.last().position_rad;
      const test::LwrPoint tip = test::lwr_flange(q);
      std::vector<BodyPoint> body;
      for (const test::LwrPoint& point : test::lwr_body(q)) {
        body.push_back({point.jacobian, obstacle_of(test::sphere_proximity(point.p_world, sphere))});
      }
      Task turn{TaskJacobian::Zero(3, 7), TaskVector::Zero(3)};
      turn.jacobian.rightCols<3>().setIdentity();
      const std::array<Task, 2> further{turn, turn};
      const Proximity at_tip = test::sphere_proximity(tip.p_world, sphere);
      bool working = true;
      const AllocationGuard guard;
      const Obstacle obstacle = obstacle_of(at_tip, at_tip.direction_world, 0.01, 1.6);
      const CycleOutput output = controller.cycle({.task = {tip.jacobian, task.desired_velocity(tip.p_world)},
                                                   .end_effector = obstacle,
                                                   .body = body,
                                                   .further_tasks = std::span(further).first(k % 3)});
      working = port.write(output.command) && port.read(state) && working;
      arm.advance();
      ASSERT_EQ(guard.allocations(), 0) << "kind " << kind << ", cycle " << k;
      ASSERT_TRUE(working);
    }
  }
}

TEST(NoAllocation, WhereNothingIsFiniteEither) {
  DEPTHGRID_REQUIRE_ALLOCATION_COUNT();
  Controller controller(test::lwr_settings());
  const test::LwrPoint tip = test::lwr_flange(test::lwr_bent());
  BodyPoint broken{tip.jacobian, {}};
  broken.jacobian(1, 1) = std::numeric_limits<double>::quiet_NaN();
  const AllocationGuard guard;
  EXPECT_FALSE(controller.start(JointVector::Constant(7, std::numeric_limits<double>::quiet_NaN())));
  EXPECT_FALSE(controller.start(JointVector::Zero(2)));
  for (int k = 0; k < 10; ++k) {
    (void)controller.cycle({.task = {broken.jacobian, Eigen::Vector3d::Constant(1)},
                            .end_effector = {},
                            .body = {&broken, 1},
                            .further_tasks = {}});
    (void)controller.cycle({});
  }
  EXPECT_EQ(guard.allocations(), 0);
}

}  // namespace
}  // namespace depthgrid::control
