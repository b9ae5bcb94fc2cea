// What a task can ask of the joints beside the tasks before it: orthonormal rows instead of its Jacobian. Internal.
//
//   J P = U S Vt,  P: the null space of the rows taken before
//   J (x - x0) = r  becomes  Vt (x - x0) = F U^T r,  F = phi(s) / s
//
// phi is 1 for singular values s from `floor` upward and falls smoothly to 0 below it, so that near a singularity the
// part of the task that would need infinite joint speed is left out of the request, instead of bending all of it.
#pragma once

#include "depthgrid/control/joints.hpp"

namespace depthgrid::control {

/// Orthonormal rows in joint space, at most one a joint.
using JointRows =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::DontAlign | Eigen::RowMajor, kMaxJoints, kMaxJoints>;

/// One task in the coordinates that it can move.
class TaskRows {
 public:
  /// `taken`: orthonormal rows of the tasks before, with as many columns as `jacobian`. Everything must be finite.
  TaskRows(const TaskJacobian& jacobian, const JointRows& taken, double floor) noexcept;

  /// Orthonormal, and orthogonal to the rows taken before; as many as the task has directions left.
  [[nodiscard]] const JointRows& rows() const noexcept { return rows_; }
  /// F U^T r: what the rows must make for a task velocity r.
  [[nodiscard]] TaskVector values_of(const TaskVector& r) const noexcept;
  /// |r - U phi U^T r|: how much of r is left out.
  [[nodiscard]] double left_out(const TaskVector& r) const noexcept;

 private:
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::DontAlign, kMaxTaskRows, kMaxTaskRows>;
  JointRows rows_;
  Square directions_;  ///< U, one column a row of rows_
  TaskVector phi_;
  TaskVector inverse_;  ///< phi / s
};

/// Appends rows; at most as many as there are columns.
void append(JointRows& rows, const JointRows& more) noexcept;

}  // namespace depthgrid::control
