// Random problems for the saturation, each made from its seed alone, and the oracle's answers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "depthgrid/control/saturation.hpp"

namespace depthgrid::control::test {

struct SaturationProblem {
  std::uint64_t seed = 0;
  std::vector<Task> tasks;
  JointBox box;
  JointVector preferred;
};

/// 1 to 10 joints, 1 to 3 tasks of 1 to 6 rows; regular, nearly singular and singular Jacobians, tasks that contradict
/// each other, requests from tiny to far too fast, joints without play; `rest`: standing still lies in the box.
[[nodiscard]] SaturationProblem make_saturation_problem(std::uint64_t seed, bool rest);

/// What to paste into a test, and how to run it alone.
[[nodiscard]] std::string paste(const SaturationProblem& problem, bool rest);

/// The directions that a task can move beside `taken`, and the request in them, by another decomposition than the
/// product's.
struct ReferenceRows {
  Eigen::MatrixXd rows;   ///< of J, turned: u_i^T J P
  Eigen::MatrixXd left;   ///< phi_i u_i^T, so left * r is what the rows should make
  Eigen::MatrixXd units;  ///< orthonormal rows that span rows
};
[[nodiscard]] ReferenceRows reference_rows(const Task& task, const Eigen::MatrixXd& taken, double floor);

/// Linear programme: the largest s in [0, 1] with rows qd = fixed + s slope, taken qd = taken_value, qd in the box
/// (and, where there are any, gradients qd <= speeds). Nothing when there is none.
struct ScaleProgramme {
  Eigen::MatrixXd rows;
  Eigen::VectorXd fixed, slope;
  Eigen::MatrixXd taken;
  Eigen::VectorXd taken_value;
  Eigen::MatrixXd gradients;
  Eigen::VectorXd speeds;
};
[[nodiscard]] std::optional<double> largest_scale(const ScaleProgramme& programme, const JointBox& box);

/// How far qd is from being the point of {rows qd' = rows qd, box, gradients} nearest to preferred: the smallest
/// residual of its optimality conditions over all multipliers of the right sign, found by a linear programme.
[[nodiscard]] double optimality_residual(const JointVector& qd, const JointVector& preferred,
                                         const Eigen::MatrixXd& rows, const JointBox& box,
                                         const Eigen::MatrixXd& gradients = {}, const Eigen::VectorXd& speeds = {});

}  // namespace depthgrid::control::test
