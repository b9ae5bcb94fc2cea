// The saturation against linear programmes, on random problems: DEPTHGRID_TEST_SEED, DEPTHGRID_TEST_COUNT.
#include <gtest/gtest.h>

#include "control/saturation_problem.hpp"
#include "support/random_run.hpp"

namespace depthgrid::control::test {
namespace {

constexpr double kFloor = 0.03;
constexpr double kScaleTolerance = 2e-6;
constexpr double kRowTolerance = 1e-8;

double outside(const JointVector& qd, const JointBox& box) {
  return std::max((box.lower_rad_s - qd).maxCoeff(), (qd - box.upper_rad_s).maxCoeff());
}

Eigen::MatrixXd stacked(const Eigen::MatrixXd& above, const Eigen::MatrixXd& below) {
  Eigen::MatrixXd all(above.rows() + below.rows(), below.cols());
  all << above, below;
  return all;
}

/// Tasks, their results and the motion after each of them.
struct Solved {
  std::vector<SaturationResult> after;  ///< of the first k + 1 tasks alone
};

Solved solve_prefixes(const SaturationProblem& problem, SaturationVariant variant) {
  Saturation saturation({variant, kFloor});
  Solved solved;
  for (std::size_t k = 1; k <= problem.tasks.size(); ++k) {
    solved.after.push_back(saturation.solve(std::span(problem.tasks).first(k), problem.box,
                                            variant == SaturationVariant::optimal ? problem.preferred : JointVector()));
  }
  return solved;
}

struct Tally {
  std::int64_t tasks = 0, full = 0, scaled = 0, turned = 0, given_up = 0, short_of_largest = 0;
  double largest_gap = 0;
};

void count(Tally& tally, TaskOutcome outcome) {
  ++tally.tasks;
  tally.full += outcome == TaskOutcome::full ? 1 : 0;
  tally.scaled += outcome == TaskOutcome::scaled ? 1 : 0;
  tally.turned += outcome == TaskOutcome::turned ? 1 : 0;
  tally.given_up += outcome == TaskOutcome::given_up ? 1 : 0;
}

void check(const SaturationProblem& problem, SaturationVariant variant, Tally& tally) {
  const Solved solved = solve_prefixes(problem, variant);
  const bool optimal = variant == SaturationVariant::optimal;
  const int joints = problem.box.joints();
  Eigen::MatrixXd taken(0, joints);
  JointVector before = braking(problem.box);
  for (std::size_t k = 0; k < problem.tasks.size(); ++k) {
    const JointVector& qd = solved.after[k].velocity_rad_s;
    const TaskResult& result = solved.after[k].tasks[k];
    SCOPED_TRACE("task " + std::to_string(k));
    ASSERT_LE(outside(qd, problem.box), 0.0);
    ASSERT_GE(result.scale, 0.0);
    ASSERT_LE(result.scale, 1.0);
    const Task& task = problem.tasks[k];
    const ReferenceRows reference = reference_rows(task, taken, kFloor);
    // In the task's own direction: rows (qd - base) = left (s xd - J base).
    const Eigen::VectorXd base = k == 0 ? Eigen::VectorXd::Zero(joints) : Eigen::VectorXd(before);
    ScaleProgramme direct;
    direct.rows = reference.rows;
    direct.fixed = reference.rows * base - reference.left * (Eigen::MatrixXd(task.jacobian) * base);
    direct.slope = reference.left * Eigen::VectorXd(task.velocity);
    direct.taken = taken;
    direct.taken_value = taken * Eigen::VectorXd(before);
    const std::optional<double> largest = largest_scale(direct, problem.box);
    // From the motion before towards it.
    ScaleProgramme turned = direct;
    turned.fixed = reference.rows * Eigen::VectorXd(before);
    turned.slope =
        reference.left * (Eigen::VectorXd(task.velocity) - Eigen::MatrixXd(task.jacobian) * Eigen::VectorXd(before));

    count(tally, result.outcome);
    ASSERT_NE(result.outcome, TaskOutcome::invalid);
    if (result.outcome == TaskOutcome::given_up) {
      ASSERT_EQ(qd, before);
      if (optimal) {
        ASSERT_LE(largest.value_or(0), kScaleTolerance);
        ASSERT_LE(largest_scale(turned, problem.box).value_or(0), kScaleTolerance);
      } else {
        tally.short_of_largest += largest ? 1 : 0;
      }
      continue;
    }
    const ScaleProgramme& used = result.outcome == TaskOutcome::turned ? turned : direct;
    const Eigen::VectorXd missed = used.rows * Eigen::VectorXd(qd) - used.fixed - result.scale * used.slope;
    ASSERT_LE(missed.size() == 0 ? 0.0 : missed.cwiseAbs().maxCoeff(), kRowTolerance) << "s = " << result.scale;
    if (taken.rows() > 0) {
      ASSERT_LE((taken * Eigen::VectorXd(qd - before)).cwiseAbs().maxCoeff(), kRowTolerance)
          << "disturbs a task before";
    }
    if (result.outcome == TaskOutcome::turned) {
      ASSERT_TRUE(optimal);
      ASSERT_LE(largest.value_or(0), kScaleTolerance) << "a multiple of xd is possible";
      const std::optional<double> share = largest_scale(turned, problem.box);
      ASSERT_TRUE(share.has_value());
      ASSERT_NEAR(result.scale, *share, kScaleTolerance);
    } else {
      ASSERT_TRUE(largest.has_value()) << "the oracle finds no scale, the saturation " << result.scale;
      ASSERT_LE(result.scale, *largest + kScaleTolerance);
      if (optimal) {
        ASSERT_GE(result.scale, *largest - kScaleTolerance);
      } else if (result.scale < *largest - kScaleTolerance) {
        ++tally.short_of_largest;
        tally.largest_gap = std::max(tally.largest_gap, *largest - result.scale);
      }
    }
    const Eigen::MatrixXd all = stacked(taken, reference.units);
    if (optimal) {
      ASSERT_LE(optimality_residual(qd, problem.preferred, all, problem.box), 1e-6) << "not the nearest to preferred";
    }
    taken = all;
    before = qd;
  }
}

void run(SaturationVariant variant, bool rest, std::int64_t default_count, Tally& tally) {
  const auto random = depthgrid::test::random_run(default_count);
  for (std::int64_t i = 0; i < random.count; ++i) {
    const SaturationProblem problem = make_saturation_problem(random.seed + static_cast<std::uint64_t>(i), rest);
    SCOPED_TRACE(paste(problem, rest));
    check(problem, variant, tally);
    if (::testing::Test::HasFatalFailure()) {
      return;
    }
  }
  ::testing::Test::RecordProperty("tasks", static_cast<int>(tally.tasks));
  std::cout << "tasks " << tally.tasks << ": full " << tally.full << ", scaled " << tally.scaled << ", turned "
            << tally.turned << ", given up " << tally.given_up << "; below the largest scale " << tally.short_of_largest
            << ", by at most " << tally.largest_gap << '\n';
}

TEST(SaturationOracle, OptimalEqualsTheLinearProgrammeWithRestInTheBox) {
  Tally tally;
  run(SaturationVariant::optimal, true, 4000, tally);
}

TEST(SaturationOracle, OptimalEqualsTheLinearProgrammeWithoutRestInTheBox) {
  Tally tally;
  run(SaturationVariant::optimal, false, 4000, tally);
}

TEST(SaturationOracle, BasicIsFeasibleAndNeverAboveTheLinearProgramme) {
  Tally tally;
  run(SaturationVariant::basic, true, 4000, tally);
}

TEST(SaturationOracle, BasicIsFeasibleWithoutRestInTheBox) {
  Tally tally;
  run(SaturationVariant::basic, false, 4000, tally);
}

}  // namespace
}  // namespace depthgrid::control::test
