#include "depthgrid/control/projection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depthgrid::control {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// A normal of length one that sticks out of the active ones by less than this depends on them.
constexpr double kDependent = 1e-9;
/// A constraint that is violated by less than this holds.
constexpr double kHolds = 1e-9;
/// One that the others decide holds when it is violated by less than this.
constexpr double kStuck = 1e-8;
/// An equality that depends on others may be off by this.
constexpr double kConsistent = 1e-9;

}  // namespace

Projection::Variables Projection::normal_of(int constraint) const noexcept {
  const int n = static_cast<int>(problem_.wanted.size());
  Variables normal = Variables::Zero(n);
  if (constraint < n) {
    normal[constraint] = 1;
  } else if (constraint < 2 * n) {
    normal[constraint - n] = -1;
  } else {
    normal = -problem_.inequality.row(constraint - 2 * n).transpose();
  }
  return normal;
}

/// Negative when violated.
double Projection::slack_of(int constraint) const noexcept {
  const int n = static_cast<int>(problem_.wanted.size());
  if (constraint < n) {
    return x_[constraint] - problem_.lower[constraint];
  }
  if (constraint < 2 * n) {
    return problem_.upper[constraint - n] - x_[constraint - n];
  }
  return problem_.inequality_value[constraint - 2 * n] - problem_.inequality.row(constraint - 2 * n).dot(x_);
}

/// Turns columns `column` and `column + 1` of the basis.
void Projection::rotate_basis(int column, double c, double s) noexcept {
  for (int i = 0; i < basis_.rows(); ++i) {
    const double left = basis_(i, column);
    const double right = basis_(i, column + 1);
    basis_(i, column) = c * left + s * right;
    basis_(i, column + 1) = -s * left + c * right;
  }
}

/// Takes in the normal whose coordinates stand in d_.
void Projection::activate(int constraint) noexcept {
  for (int j = static_cast<int>(d_.size()) - 2; j >= active_; --j) {
    const double length = std::hypot(d_[j], d_[j + 1]);
    if (length > 0) {
      rotate_basis(j, d_[j] / length, d_[j + 1] / length);
      d_[j] = length;
      d_[j + 1] = 0;
    }
  }
  triangle_.col(active_).head(active_ + 1) = d_.head(active_ + 1);
  constraint_at_[static_cast<std::size_t>(active_)] = constraint;
  if (constraint != kEquality) {
    is_active_[static_cast<std::size_t>(constraint)] = true;
  }
  ++active_;
}

void Projection::release(int place) noexcept {
  is_active_[static_cast<std::size_t>(constraint_at_[static_cast<std::size_t>(place)])] = false;
  for (int j = place; j + 1 < active_; ++j) {
    triangle_.col(j).head(j + 2) = triangle_.col(j + 1).head(j + 2);
    multiplier_[j] = multiplier_[j + 1];
    constraint_at_[static_cast<std::size_t>(j)] = constraint_at_[static_cast<std::size_t>(j) + 1];
  }
  --active_;
  for (int j = place; j < active_; ++j) {
    const double length = std::hypot(triangle_(j, j), triangle_(j + 1, j));
    if (length > 0) {
      const double c = triangle_(j, j) / length;
      const double s = triangle_(j + 1, j) / length;
      for (int k = j; k < active_; ++k) {
        const double above = triangle_(j, k);
        const double below = triangle_(j + 1, k);
        triangle_(j, k) = c * above + s * below;
        triangle_(j + 1, k) = -s * above + c * below;
      }
      rotate_basis(j, c, s);
    }
  }
}

ProjectionStatus Projection::take_equalities() noexcept {
  const int n = static_cast<int>(problem_.wanted.size());
  for (int row = 0; row < problem_.equality.rows(); ++row) {
    const double missing = problem_.equality_value[row] - problem_.equality.row(row).dot(x_);
    d_ = basis_.transpose() * problem_.equality.row(row).transpose();
    const double length_squared = d_.tail(n - active_).squaredNorm();
    if (length_squared <= kDependent * kDependent) {
      if (std::abs(missing) > kConsistent * (1 + std::abs(problem_.equality_value[row]))) {
        return ProjectionStatus::infeasible;
      }
      continue;
    }
    x_ += (missing / length_squared) * (basis_.rightCols(n - active_) * d_.tail(n - active_));
    multiplier_[active_] = 0;
    activate(kEquality);
  }
  equalities_ = active_;
  return ProjectionStatus::solved;
}

int Projection::most_violated() const noexcept {
  const int constraints = static_cast<int>(2 * problem_.wanted.size() + problem_.inequality.rows());
  int worst = -1;
  double least = -kHolds;
  for (int i = 0; i < constraints; ++i) {
    if (!is_active_[static_cast<std::size_t>(i)]) {
      const double slack = slack_of(i);
      if (slack < least) {
        least = slack;
        worst = i;
      }
    }
  }
  return worst;
}

/// The normal at hand as a combination of the active ones: R r = d, from the last row up.
Projection::Variables Projection::in_active_normals() const noexcept {
  Variables r = d_.head(active_);
  for (int j = active_ - 1; j >= 0; --j) {
    r[j] /= triangle_(j, j);
    r.head(j) -= r[j] * triangle_.col(j).head(j);
  }
  return r;
}

/// Moves to where this constraint holds too, releasing others on the way.
ProjectionStatus Projection::satisfy(int constraint, int most_steps) noexcept {
  const int n = static_cast<int>(problem_.wanted.size());
  const Variables normal = normal_of(constraint);
  double multiplier = 0;
  while (++steps_ <= most_steps) {
    d_.noalias() = basis_.transpose() * normal;
    const double length_squared = d_.tail(n - active_).squaredNorm();
    const Variables r = in_active_normals();
    double dual_step = kInfinity;
    int leaving = -1;
    for (int j = equalities_; j < active_; ++j) {
      if (r[j] > kDependent && multiplier_[j] / r[j] < dual_step) {
        dual_step = multiplier_[j] / r[j];
        leaving = j;
      }
    }
    const bool movable = length_squared > kDependent * kDependent;
    const double primal_step = movable ? -slack_of(constraint) / length_squared : kInfinity;
    const double step = std::min(primal_step, dual_step);
    if (step == kInfinity) {
      if (slack_of(constraint) < -kStuck) {
        return ProjectionStatus::infeasible;
      }
      is_active_[static_cast<std::size_t>(constraint)] = true;  // rounding: it holds as well as it can
      return ProjectionStatus::solved;
    }
    multiplier_.head(active_) -= step * r;
    multiplier += step;
    if (movable) {
      x_.noalias() += step * (basis_.rightCols(n - active_) * d_.tail(n - active_));
    }
    if (primal_step <= dual_step) {
      multiplier_[active_] = multiplier;
      activate(constraint);
      return ProjectionStatus::solved;
    }
    release(leaving);
  }
  return ProjectionStatus::gave_up;
}

ProjectionStatus Projection::solve() noexcept {
  const int n = static_cast<int>(problem_.wanted.size());
  x_ = problem_.wanted;
  basis_.setIdentity(n, n);
  triangle_.setZero(n, n);
  d_.setZero(n);
  multiplier_.setZero(n);
  is_active_.fill(false);
  active_ = 0;
  steps_ = 0;
  const int most_steps = 10 * (2 * n + static_cast<int>(problem_.inequality.rows()));
  ProjectionStatus status = take_equalities();
  while (status == ProjectionStatus::solved) {
    const int constraint = most_violated();
    if (constraint < 0) {
      return ProjectionStatus::solved;
    }
    status = satisfy(constraint, most_steps);
  }
  return status;
}

}  // namespace depthgrid::control
