#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "depthgrid/control/saturation_variants.hpp"

namespace depthgrid::control {
namespace {

/// Squared share of a direction that the joints left must still have.
constexpr double kRankLost = 1e-6;
/// A velocity that leaves the box by less counts as inside.
constexpr double kHeld = 1e-11;

using Gram = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::DontAlign, kMaxJoints, kMaxJoints>;

/// The shortest change of the joints that are not saturated: change = fixed + s moved.
struct Line {
  JointVector fixed, moved;
};

struct Critical {
  double scale;
  int joint;
};

class Loop {
 public:
  Loop(const ScaleProblem& problem, const JointBox& box) noexcept
      : problem_(problem), box_(box), all_rows_(problem.taken), held_(JointVector::Zero(box.joints())) {
    append(all_rows_, problem.rows);
  }

  std::optional<ScaleAnswer> run() noexcept {
    std::optional<ScaleAnswer> best;
    for (int round = 0; round <= box_.joints(); ++round) {
      const std::optional<Line> line = shortest();
      if (!line) {
        break;
      }
      if (const JointVector whole = problem_.base + line->fixed + line->moved; lies_inside(whole)) {
        return ScaleAnswer{clamped(whole, box_), 1.0};
      }
      const Critical critical = largest_scale(*line);
      const JointVector at_scale = problem_.base + line->fixed + critical.scale * line->moved;
      if (lies_inside(at_scale) && (!best || critical.scale > best->scale)) {
        best = ScaleAnswer{clamped(at_scale, box_), critical.scale};
      }
      if (critical.joint < 0) {
        break;
      }
      saturate(critical.joint, (problem_.base + line->fixed + line->moved)[critical.joint]);
    }
    return best;
  }

 private:
  [[nodiscard]] std::optional<Line> shortest() const noexcept {
    const auto count = static_cast<int>(all_rows_.rows());
    JointRows free_rows = all_rows_;
    for (int i = 0; i < box_.joints(); ++i) {
      if (saturated_[static_cast<std::size_t>(i)]) {
        free_rows.col(i).setZero();
      }
    }
    const Gram gram = free_rows * free_rows.transpose();
    const Eigen::LDLT<Gram> solver(gram);
    if (count > 0 && !(solver.vectorD().minCoeff() > kRankLost)) {
      return std::nullopt;
    }
    JointVector fixed_value = -(all_rows_ * held_);
    JointVector moved_value = JointVector::Zero(count);
    const auto task = static_cast<int>(problem_.rows.rows());
    fixed_value.tail(task) += problem_.offset;
    moved_value.tail(task) = problem_.slope;
    solver.solveInPlace(fixed_value);
    solver.solveInPlace(moved_value);
    Line line;
    line.fixed = held_ + free_rows.transpose() * fixed_value;
    line.moved = free_rows.transpose() * moved_value;
    return line;
  }

  [[nodiscard]] bool lies_inside(const JointVector& velocity) const noexcept {
    return ((velocity - box_.lower_rad_s).array() >= -kHeld).all() &&
           ((box_.upper_rad_s - velocity).array() >= -kHeld).all();
  }

  /// The largest s in [0, 1] that keeps the joints that are not saturated inside, and the joint that limits it; s = 0
  /// where there is none.
  [[nodiscard]] Critical largest_scale(const Line& line) const noexcept {
    double highest = std::numeric_limits<double>::infinity();
    double lowest = 0;
    int joint = -1;
    for (int i = 0; i < box_.joints(); ++i) {
      const double a = line.moved[i];
      const double b = problem_.base[i] + line.fixed[i];
      if (saturated_[static_cast<std::size_t>(i)] || std::abs(a) <= std::numeric_limits<double>::min()) {
        continue;
      }
      const double to_lower = (box_.lower_rad_s[i] - b) / a;
      const double to_upper = (box_.upper_rad_s[i] - b) / a;
      lowest = std::max(lowest, std::min(to_lower, to_upper));
      if (std::max(to_lower, to_upper) < highest) {
        highest = std::max(to_lower, to_upper);
        joint = i;
      }
    }
    return {highest >= lowest ? std::min(1.0, highest) : 0.0, joint};
  }

  void saturate(int joint, double wanted) noexcept {
    saturated_[static_cast<std::size_t>(joint)] = true;
    const double bound = wanted > box_.upper_rad_s[joint] ? box_.upper_rad_s[joint] : box_.lower_rad_s[joint];
    held_[joint] = bound - problem_.base[joint];
  }

  const ScaleProblem& problem_;
  const JointBox& box_;
  JointRows all_rows_;
  JointVector held_;  ///< change of the saturated joints
  std::array<bool, kMaxJoints> saturated_{};
};

}  // namespace

std::optional<ScaleAnswer> basic_scale(const ScaleProblem& problem, const JointBox& box) noexcept {
  return Loop(problem, box).run();
}

}  // namespace depthgrid::control
