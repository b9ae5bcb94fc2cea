#include "depthgrid/control/task_rows.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace depthgrid::control {
namespace {

/// A direction that moves by less than this share of the floor is none: below it the rows would not be orthonormal.
constexpr double kNoDirection = 1e-3;

using TaskGram = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxTaskRows, kMaxTaskRows>;

double phi_of(double s, double floor) noexcept {
  if (s >= floor) {
    return 1.0;
  }
  const double damping_squared = 0.25 * (floor * floor - s * s);
  return s * s / (s * s + damping_squared);
}

}  // namespace

TaskRows::TaskRows(const TaskJacobian& jacobian, const JointRows& taken, double floor) noexcept {
  TaskJacobian left = jacobian;
  if (taken.rows() > 0) {
    left.noalias() -= (jacobian * taken.transpose()).eval() * taken;
  }
  const TaskGram gram = left * left.transpose();
  const Eigen::SelfAdjointEigenSolver<TaskGram> eigen(gram);
  const auto rows = static_cast<int>(jacobian.rows());
  const auto room = static_cast<int>(jacobian.cols() - taken.rows());
  rows_.resize(0, jacobian.cols());
  directions_.resize(rows, 0);
  phi_.resize(0);
  inverse_.resize(0);
  int kept = 0;
  for (int i = rows - 1; i >= 0 && kept < room; --i) {  // largest first
    const double s = std::sqrt(std::max(0.0, eigen.eigenvalues()[i]));
    if (!(s > kNoDirection * floor)) {
      break;
    }
    ++kept;
    rows_.conservativeResize(kept, Eigen::NoChange);
    directions_.conservativeResize(Eigen::NoChange, kept);
    phi_.conservativeResize(kept);
    inverse_.conservativeResize(kept);
    directions_.col(kept - 1) = eigen.eigenvectors().col(i);
    // Once more orthogonal to the rows before: of a small direction rounding leaves a share of the large ones.
    JointVector row = left.transpose() * eigen.eigenvectors().col(i);
    for (int k = 0; k < taken.rows(); ++k) {
      row -= taken.row(k).dot(row) * taken.row(k).transpose();
    }
    for (int k = 0; k + 1 < kept; ++k) {
      row -= rows_.row(k).dot(row) * rows_.row(k).transpose();
    }
    rows_.row(kept - 1) = row.normalized().transpose();
    phi_[kept - 1] = phi_of(s, floor);
    inverse_[kept - 1] = phi_[kept - 1] / s;
  }
}

TaskVector TaskRows::values_of(const TaskVector& r) const noexcept {
  return inverse_.cwiseProduct((directions_.transpose() * r).eval());
}

double TaskRows::left_out(const TaskVector& r) const noexcept {
  const TaskVector reached = directions_ * phi_.cwiseProduct((directions_.transpose() * r).eval());
  return (r - reached).norm();
}

void append(JointRows& rows, const JointRows& more) noexcept {
  const auto before = static_cast<int>(rows.rows());
  const int count = std::min(static_cast<int>(more.rows()), static_cast<int>(rows.cols()) - before);
  rows.conservativeResize(before + count, Eigen::NoChange);
  rows.bottomRows(count) = more.topRows(count);
}

}  // namespace depthgrid::control
