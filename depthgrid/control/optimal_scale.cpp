#include <algorithm>
#include <cmath>

#include "depthgrid/control/saturation_variants.hpp"

namespace depthgrid::control {
namespace {

/// The scale s stands in the programme as kScaleUnit s, and is drawn towards 2: then a hundredth of a millionth of s is
/// worth as much as all that the joints could come nearer to the preferred velocity. So s is short of the largest one
/// by at most |box|^2 / (2 kScaleUnit^2).
constexpr double kScaleUnit = 1e4;
constexpr double kBeyondFull = 2.0;
/// Above this a scale is 1 but for rounding.
constexpr double kFull = 1 - 1e-9;
/// A gradient shorter than this limits nothing.
constexpr double kNoGradient = 1e-9;

void set_equalities(const ScaleProblem& problem, ProjectionProblem& programme) noexcept {
  const auto joints = static_cast<int>(problem.base.size());
  const auto taken = static_cast<int>(problem.taken.rows());
  const auto task = static_cast<int>(problem.rows.rows());
  programme.equality.setZero(taken + task, joints + 1);
  programme.equality_value.resize(taken + task);
  programme.equality.topLeftCorner(taken, joints) = problem.taken;
  programme.equality.bottomLeftCorner(task, joints) = problem.rows;
  programme.equality.col(joints).tail(task) = -problem.slope / kScaleUnit;
  // Row by row: the analyzer believes that Eigen's product of a matrix and a vector reads what was never written.
  for (int k = 0; k < taken; ++k) {
    programme.equality_value[k] = problem.taken.row(k).dot(problem.base);
  }
  for (int k = 0; k < task; ++k) {
    programme.equality_value[taken + k] = problem.rows.row(k).dot(problem.base) + problem.offset[k];
  }
}

/// Approach limits as rows of length one, each wide enough for braking.
void set_limits(std::span<const ApproachLimit> limits, const JointBox& box, ProjectionProblem& programme) noexcept {
  const int joints = box.joints();
  const JointVector slowest = braking(box);
  programme.inequality.setZero(std::min<Eigen::Index>(static_cast<Eigen::Index>(limits.size()), kMaxInequalities),
                               joints + 1);
  programme.inequality_value.setZero(programme.inequality.rows());
  for (int row = 0; row < programme.inequality.rows(); ++row) {
    const ApproachLimit& limit = limits[static_cast<std::size_t>(row)];
    const double length = limit.gradient.norm();
    if (length > kNoGradient) {
      programme.inequality.row(row).head(joints) = limit.gradient.transpose() / length;
      programme.inequality_value[row] = std::max(limit.speed_m_s, limit.gradient.dot(slowest)) / length;
    }
  }
}

}  // namespace

std::optional<ScaleAnswer> optimal_scale(const ScaleProblem& problem, const JointBox& box, const JointVector& preferred,
                                         std::span<const ApproachLimit> limits, Projection& projection) noexcept {
  const int joints = box.joints();
  ProjectionProblem& programme = projection.problem();
  programme.wanted.setZero(joints + 1);
  if (preferred.size() == joints && preferred.allFinite()) {
    programme.wanted.head(joints) = preferred;
  }
  programme.wanted[joints] = kBeyondFull * kScaleUnit;
  programme.lower.resize(joints + 1);
  programme.lower << box.lower_rad_s, 0.0;
  programme.upper.resize(joints + 1);
  programme.upper << box.upper_rad_s, kScaleUnit;
  set_equalities(problem, programme);
  set_limits(limits, box, programme);
  if (projection.solve() != ProjectionStatus::solved) {
    return std::nullopt;
  }
  const double scale = std::clamp(projection.solution()[joints] / kScaleUnit, 0.0, 1.0);
  return ScaleAnswer{clamped(projection.solution().head(joints), box), scale >= kFull ? 1.0 : scale};
}

}  // namespace depthgrid::control
