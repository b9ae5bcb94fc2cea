// The saturation where it is special: singular, redundant, contradicting, violated, not finite.
#include "depthgrid/control/saturation.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "control/saturation_problem.hpp"
#include "support/random_run.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::control {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

JointBox symmetric(int joints, double limit) {
  return {JointVector::Constant(joints, -limit), JointVector::Constant(joints, limit)};
}

/// A planar arm: three joints that all push along x, with levers 3, 2 and 1.
Task push(double speed) {
  Task task{TaskJacobian(1, 3), TaskVector::Constant(1, speed)};
  task.jacobian << 3, 2, 1;
  return task;
}

class BothVariants : public ::testing::TestWithParam<SaturationVariant> {
 protected:
  Saturation saturation{SaturationSettings{GetParam(), 0.03}};
};

INSTANTIATE_TEST_SUITE_P(Saturation, BothVariants,
                         ::testing::Values(SaturationVariant::basic, SaturationVariant::optimal),
                         [](const auto& variant) {
                           return variant.param == SaturationVariant::basic ? "basic" : "optimal";
                         });

TEST_P(BothVariants, WithinTheBoxIsThePseudoinverse) {
  const Task task = push(1.4);
  const SaturationResult result = saturation.solve({&task, 1}, symmetric(3, 1));
  EXPECT_EQ(result.tasks[0].outcome, TaskOutcome::full);
  EXPECT_NEAR(result.velocity_rad_s[0], 0.3, 1e-9);
  EXPECT_NEAR(result.velocity_rad_s[1], 0.2, 1e-9);
  EXPECT_NEAR(result.velocity_rad_s[2], 0.1, 1e-9);
}

TEST_P(BothVariants, WhatOneJointLacksTheOthersDo) {
  const Task task = push(5.5);  // the pseudoinverse asks 1.18, 0.79, 0.39
  const SaturationResult result = saturation.solve({&task, 1}, symmetric(3, 1));
  EXPECT_EQ(result.tasks[0].outcome, TaskOutcome::full);
  EXPECT_NEAR(result.velocity_rad_s[0], 1, 1e-9);
  EXPECT_NEAR(result.velocity_rad_s[1], 1, 1e-9);
  EXPECT_NEAR(result.velocity_rad_s[2], 0.5, 1e-9);
}

TEST_P(BothVariants, TheJointThatLacksMostIsTheOneThatSaturates) {
  Task task = push(5.5);
  task.jacobian << 1, 2, 3;  // the pseudoinverse asks 0.39, 0.79, 1.18
  const SaturationResult result = saturation.solve({&task, 1}, symmetric(3, 1));
  EXPECT_EQ(result.tasks[0].outcome, TaskOutcome::full);
  EXPECT_NEAR(result.velocity_rad_s[0], 0.5, 1e-9);
  EXPECT_NEAR(result.velocity_rad_s[2], 1, 1e-9);
}

TEST_P(BothVariants, TooMuchIsScaled) {
  const Task task = push(12);
  const SaturationResult result = saturation.solve({&task, 1}, symmetric(3, 1));
  EXPECT_EQ(result.tasks[0].outcome, TaskOutcome::scaled);
  EXPECT_NEAR(result.tasks[0].scale, 0.5, 1e-7);
  EXPECT_LE((result.velocity_rad_s - JointVector::Ones(3)).cwiseAbs().maxCoeff(), 1e-7);
}

TEST_P(BothVariants, ASingularTaskLosesWhatItCannotDo) {
  // The third direction moves with no joint.
  Task task{TaskJacobian::Zero(3, 7), TaskVector(Eigen::Vector3d(0.1, 0.2, 0.3))};
  task.jacobian(0, 0) = 1;
  task.jacobian(1, 3) = 0.5;
  const SaturationResult result = saturation.solve({&task, 1}, symmetric(7, 1));
  EXPECT_EQ(result.tasks[0].outcome, TaskOutcome::full);
  EXPECT_NEAR(result.tasks[0].left_out, 0.3, 1e-12);
  EXPECT_NEAR(result.velocity_rad_s[0], 0.1, 1e-9);
  EXPECT_NEAR(result.velocity_rad_s[3], 0.4, 1e-9);
  task.jacobian.setZero();
  const SaturationResult none = saturation.solve({&task, 1}, symmetric(7, 1));
  EXPECT_LE(none.velocity_rad_s.norm(), 1e-9);
  EXPECT_NEAR(none.tasks[0].left_out, task.velocity.norm(), 1e-12);
}

TEST_P(BothVariants, NearASingularityJointSpeedStaysBounded) {
  for (double s = 1.0; s > 1e-12; s *= 0.7) {
    Task task{TaskJacobian::Zero(2, 3), TaskVector::Constant(2, 1.0)};
    task.jacobian(0, 0) = 1;
    task.jacobian(1, 1) = s;
    const SaturationResult result = saturation.solve({&task, 1}, symmetric(3, 1e6));
    EXPECT_LE(std::abs(result.velocity_rad_s[1]), 1.2 / 0.03) << s;
    EXPECT_NEAR(result.velocity_rad_s[0], 1.0, 1e-6) << s;
  }
}

TEST_P(BothVariants, ALowerTaskDoesNotDisturbAHigherOne) {
  std::array<Task, 2> tasks{push(1.4), push(-1.4)};  // the same point, the other way
  const SaturationResult contradicting = saturation.solve(tasks, symmetric(3, 1));
  EXPECT_NEAR(tasks[0].jacobian.row(0).dot(contradicting.velocity_rad_s), 1.4, 1e-9);
  EXPECT_NEAR(contradicting.tasks[1].left_out, 2.8, 1e-9);
  tasks[1] = {TaskJacobian::Zero(1, 3), TaskVector::Constant(1, -0.5)};
  tasks[1].jacobian(0, 2) = 1;  // the last joint alone
  const SaturationResult beside = saturation.solve(tasks, symmetric(3, 1));
  EXPECT_EQ(beside.tasks[1].outcome, TaskOutcome::full);
  EXPECT_NEAR(tasks[0].jacobian.row(0).dot(beside.velocity_rad_s), 1.4, 1e-9);
  EXPECT_NEAR(beside.velocity_rad_s[2], -0.5, 1e-9);
}

TEST_P(BothVariants, WhatIsNotFiniteBrakes) {
  JointBox box = symmetric(3, 1);
  box.lower_rad_s[1] = 0.25;  // this joint cannot stop yet
  for (const double wrong : {kNaN, std::numeric_limits<double>::infinity()}) {
    Task task = push(1);
    task.velocity[0] = wrong;
    SaturationResult result = saturation.solve({&task, 1}, box);
    EXPECT_EQ(result.tasks[0].outcome, TaskOutcome::invalid);
    EXPECT_EQ(result.velocity_rad_s, JointVector(Eigen::Vector3d(0, 0.25, 0)));
    task = push(1);
    task.jacobian(0, 1) = wrong;
    result = saturation.solve({&task, 1}, box);
    EXPECT_EQ(result.tasks[0].outcome, TaskOutcome::invalid);
    const std::array<Task, 2> second{push(1), task};
    EXPECT_EQ(saturation.solve(second, box).velocity_rad_s, JointVector(Eigen::Vector3d(0, 0.25, 0)));
    const ApproachLimit limit{JointVector::Constant(3, wrong), 0};
    task = push(1);
    EXPECT_EQ(saturation.solve({&task, 1}, box, {}, {&limit, 1}).tasks[0].outcome, TaskOutcome::invalid);
  }
  const Task two_joints{TaskJacobian::Ones(1, 2), TaskVector::Ones(1)};
  EXPECT_EQ(saturation.solve({&two_joints, 1}, box).tasks[0].outcome, TaskOutcome::invalid);
}

TEST_P(BothVariants, ABoxThatIsNoneGivesRest) {
  const Task task = push(1);
  JointBox reversed = symmetric(3, 1);
  reversed.lower_rad_s[0] = 2;
  JointBox unknown = symmetric(3, 1);
  unknown.upper_rad_s[0] = kNaN;
  for (const JointBox& box : {reversed, unknown}) {
    const SaturationResult result = saturation.solve({&task, 1}, box);
    EXPECT_EQ(result.velocity_rad_s, JointVector(JointVector::Zero(3)));
    EXPECT_EQ(result.tasks[0].outcome, TaskOutcome::invalid);
  }
}

TEST_P(BothVariants, WithoutTasksJointsBrake) {
  JointBox box = symmetric(3, 1);
  box.upper_rad_s[2] = -0.5;
  EXPECT_EQ(saturation.solve({}, box).velocity_rad_s, JointVector(Eigen::Vector3d(0, 0, -0.5)));
}

TEST(Saturation, OptimalComesNearestToThePreferredVelocity) {
  Saturation saturation({});
  const Task task = push(1.4);
  const JointVector preferred = Eigen::Vector3d(0.2, 0.3, 0.2);  // does the task already
  const SaturationResult result = saturation.solve({&task, 1}, symmetric(3, 1), preferred);
  EXPECT_LE((result.velocity_rad_s - preferred).norm(), 1e-9);
}

TEST(Saturation, BrakingIsTurnedTowardsATaskThatCannotBeDoneYet) {
  // All joints still move backwards; the task wants forwards.
  Saturation saturation({});
  const Task task = push(1);
  const JointBox box{JointVector::Constant(3, -0.5), JointVector::Constant(3, -0.3)};
  const SaturationResult result = saturation.solve({&task, 1}, box);
  EXPECT_LE((result.velocity_rad_s - JointVector::Constant(3, -0.3)).norm(), 1e-9);
  EXPECT_NE(result.tasks[0].outcome, TaskOutcome::full);
}

/// n . J qd <= speed holds for every answer, and costs no more of the task than it must.
TEST(Saturation, ApproachLimitsHoldAndScaleIsTheLinearProgrammes) {
  const auto run = depthgrid::test::random_run(2000);
  Saturation saturation({});
  int limited = 0;
  for (std::int64_t i = 0; i < run.count; ++i) {
    const std::uint64_t seed = run.seed + static_cast<std::uint64_t>(i);
    const test::SaturationProblem problem = test::make_saturation_problem(seed, true);
    SCOPED_TRACE(test::paste(problem, true));
    const int joints = problem.box.joints();
    std::mt19937_64 engine(seed);
    std::normal_distribution<double> gauss;
    test::ScaleProgramme programme;
    const auto count = static_cast<int>(seed % 9);
    programme.gradients.resize(count, joints);
    programme.speeds.resize(count);
    std::vector<ApproachLimit> limits;
    for (int k = 0; k < count; ++k) {
      limits.push_back(
          {JointVector::NullaryExpr(joints, [&] { return gauss(engine); }), 0.3 * std::abs(gauss(engine))});
      programme.gradients.row(k) = limits.back().gradient.transpose() / limits.back().gradient.norm();
      programme.speeds[k] = limits.back().speed_m_s / limits.back().gradient.norm();
    }
    const auto first = std::span(problem.tasks).first(1);
    const SaturationResult result = saturation.solve(first, problem.box, problem.preferred, limits);
    ASSERT_NE(result.tasks[0].outcome, TaskOutcome::given_up);
    ASSERT_LE((problem.box.lower_rad_s - result.velocity_rad_s).maxCoeff(), 0);
    ASSERT_LE((result.velocity_rad_s - problem.box.upper_rad_s).maxCoeff(), 0);
    if (count > 0) {
      ASSERT_LE((programme.gradients * Eigen::VectorXd(result.velocity_rad_s) - programme.speeds).maxCoeff(), 1e-8);
    }
    const test::ReferenceRows rows = test::reference_rows(first[0], Eigen::MatrixXd(0, joints), 0.03);
    programme.rows = rows.rows;
    programme.fixed = Eigen::VectorXd::Zero(rows.rows.rows());
    programme.slope = rows.left * Eigen::VectorXd(first[0].velocity);
    programme.taken.resize(0, joints);
    ASSERT_NEAR(result.tasks[0].scale, test::largest_scale(programme, problem.box).value_or(-1), 2e-6);
    ASSERT_LE(test::optimality_residual(result.velocity_rad_s, problem.preferred, rows.units, problem.box,
                                        programme.gradients, programme.speeds),
              1e-6);
    limited += result.tasks[0].outcome == TaskOutcome::scaled ? 1 : 0;
  }
  EXPECT_GT(limited, 0);
}

TEST(Saturation, AnApproachLimitThatBrakingCannotKeepIsWidened) {
  Saturation saturation({});
  Task task = push(0.7);
  task.jacobian << 0, 0, 1;
  const JointBox box{JointVector::Constant(3, 0.2), JointVector::Constant(3, 1)};
  const ApproachLimit limit{Eigen::Vector3d(1, 0, 0), 0.1};  // braking still makes 0.2
  const SaturationResult result = saturation.solve({&task, 1}, box, {}, {&limit, 1});
  EXPECT_EQ(result.tasks[0].outcome, TaskOutcome::full);  // what has nothing to do with the limit goes on
  EXPECT_LE((result.velocity_rad_s - JointVector(Eigen::Vector3d(0.2, 0.2, 0.7))).norm(), 1e-8);
}

TEST(Saturation, SettingsAreChecked) {
  EXPECT_NE(depthgrid::test::thrown_message([] { Saturation({SaturationVariant::basic, 0}); }), "");
  EXPECT_NE(depthgrid::test::thrown_message([] { Saturation({SaturationVariant::basic, kNaN}); }), "");
}

}  // namespace
}  // namespace depthgrid::control
