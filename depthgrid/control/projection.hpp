// The point of a polyhedron that is nearest to a given one: the quadratic programme behind the optimal saturation.
//
//   minimise |x - wanted|^2   subject to   E x = e,   lower <= x <= upper,   A x <= b
//
// Goldfarb and Idnani's dual active set method (Mathematical Programming 27, 1983) for a Hessian of one: it begins at
// `wanted`, takes the equalities in, then the worst violation after the other, and lets go of what no longer holds it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "depthgrid/control/joints.hpp"

namespace depthgrid::control {

/// Most variables: the joints and the scale of a task.
inline constexpr int kMaxVariables = kMaxJoints + 1;
/// Most general inequalities: one for each point of the body.
inline constexpr int kMaxInequalities = 32;

enum class ProjectionStatus : std::uint8_t {
  solved,
  infeasible,  ///< no point satisfies all constraints (to 1e-9 of their scale)
  gave_up,     ///< more steps than a few for every constraint: not met in any test
};

/// All sizes consistent; lower <= upper, everything finite; rows of E and A of a length near one.
struct ProjectionProblem {
  using Variables = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::DontAlign, kMaxVariables, 1>;
  using EqualityRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::DontAlign | Eigen::RowMajor,
                                     kMaxVariables, kMaxVariables>;
  using InequalityRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::DontAlign | Eigen::RowMajor,
                                       kMaxInequalities, kMaxVariables>;
  using InequalityValues = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::DontAlign, kMaxInequalities, 1>;

  Variables wanted;
  EqualityRows equality;     ///< E
  Variables equality_value;  ///< e
  Variables lower;
  Variables upper;
  InequalityRows inequality;          ///< A
  InequalityValues inequality_value;  ///< b
};

/// One problem and the scratch memory to solve it. Not for two threads at once; solve() does not allocate, lock or
/// throw.
class Projection {
 public:
  using Variables = ProjectionProblem::Variables;

  /// What solve() solves.
  [[nodiscard]] ProjectionProblem& problem() noexcept { return problem_; }

  [[nodiscard]] ProjectionStatus solve() noexcept;

  /// The answer of the last solve() that was solved.
  [[nodiscard]] const Variables& solution() const noexcept { return x_; }
  /// Active set changes of the last solve().
  [[nodiscard]] int steps() const noexcept { return steps_; }

 private:
  /// Constraints are numbered: lower bounds, upper bounds, inequalities. kEquality stands for any equality.
  static constexpr int kEquality = -1;

  [[nodiscard]] ProjectionStatus take_equalities() noexcept;
  [[nodiscard]] int most_violated() const noexcept;
  [[nodiscard]] ProjectionStatus satisfy(int constraint, int most_steps) noexcept;
  [[nodiscard]] Variables normal_of(int constraint) const noexcept;
  [[nodiscard]] Variables in_active_normals() const noexcept;
  [[nodiscard]] double slack_of(int constraint) const noexcept;
  void activate(int constraint) noexcept;
  void release(int place) noexcept;
  void rotate_basis(int column, double c, double s) noexcept;

  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::DontAlign, kMaxVariables, kMaxVariables>;
  ProjectionProblem problem_;
  Variables x_;
  Square basis_;     ///< orthogonal; its first `active_` columns span the active normals
  Square triangle_;  ///< the active normals in that basis
  Variables d_;      ///< the normal at hand in that basis
  Variables multiplier_;
  std::array<int, kMaxVariables> constraint_at_{};
  std::array<bool, 2 * kMaxVariables + kMaxInequalities> is_active_{};
  int active_ = 0;
  int equalities_ = 0;
  int steps_ = 0;
};

}  // namespace depthgrid::control
