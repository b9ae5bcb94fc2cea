#include "depthgrid/control/saturation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "depthgrid/control/saturation_variants.hpp"
#include "depthgrid/control/task_rows.hpp"
#include "depthgrid/core/error.hpp"

namespace depthgrid::control {
namespace {

bool is_valid(const Task& task, int joints) noexcept {
  return task.jacobian.cols() == joints && task.jacobian.rows() == task.velocity.size() && task.velocity.size() > 0 &&
         task.jacobian.allFinite() && task.velocity.allFinite();
}

bool are_valid(std::span<const ApproachLimit> limits, int joints) noexcept {
  return std::all_of(limits.begin(), limits.end(), [joints](const ApproachLimit& limit) {
    return limit.gradient.size() == joints && limit.gradient.allFinite() && std::isfinite(limit.speed_m_s);
  });
}

/// Finds the scale of one problem with the variant that is set.
struct Solver {
  SaturationVariant variant;
  const JointBox& box;
  const JointVector& preferred;
  std::span<const ApproachLimit> limits;
  Projection& projection;

  [[nodiscard]] std::optional<ScaleAnswer> solve(const ScaleProblem& problem) const noexcept {
    return variant == SaturationVariant::basic ? basic_scale(problem, box)
                                               : optimal_scale(problem, box, preferred, limits, projection);
  }
};

/// One task beside those before it, which left `velocity`.
TaskResult add_task(const Task& task, bool first, double floor, const Solver& solver, JointRows& taken,
                    JointVector& velocity) noexcept {
  const TaskRows rows(task.jacobian, taken, floor);
  TaskResult result;
  const TaskVector no_offset = TaskVector::Zero(rows.rows().rows());
  // Towards s xd: from rest, or from what the tasks before do with this one.
  const JointVector base = first ? JointVector(JointVector::Zero(velocity.size())) : velocity;
  const TaskVector done = task.jacobian * base;
  result.left_out = rows.left_out(task.velocity - done);
  std::optional<ScaleAnswer> answer =
      solver.solve({taken, rows.rows(), base, -rows.values_of(done), rows.values_of(task.velocity)});
  if (answer) {
    result.outcome = answer->scale >= 1.0 ? TaskOutcome::full : TaskOutcome::scaled;
  } else if (solver.variant == SaturationVariant::optimal) {
    // No multiple of xd: from the slowest motion towards xd, which can always stay where it begins.
    const TaskVector before = task.jacobian * velocity;
    answer = solver.solve({taken, rows.rows(), velocity, no_offset, rows.values_of(task.velocity - before)});
    result.left_out = rows.left_out(task.velocity - before);
    result.outcome = answer ? TaskOutcome::turned : TaskOutcome::given_up;
  } else {
    result.outcome = TaskOutcome::given_up;
  }
  if (answer) {
    result.scale = answer->scale;
    velocity = answer->velocity_rad_s;
    append(taken, rows.rows());
  }
  return result;
}

}  // namespace

void validate(const SaturationSettings& settings) {
  if (!(std::isfinite(settings.singular_value_floor) && settings.singular_value_floor > 0)) {
    fail("saturation: singular value floor is ", settings.singular_value_floor, ", must be greater than 0 and finite");
  }
}

Saturation::Saturation(const SaturationSettings& settings) : settings_(settings) { validate(settings); }

SaturationResult Saturation::solve(std::span<const Task> tasks, const JointBox& box, const JointVector& preferred_rad_s,
                                   std::span<const ApproachLimit> limits) noexcept {
  const int joints = box.joints();
  SaturationResult result;
  result.velocity_rad_s = JointVector::Zero(joints);
  if (!is_proper(box)) {
    return result;
  }
  result.velocity_rad_s = braking(box);
  if (!are_valid(limits, joints)) {
    return result;
  }
  const Solver solver{settings_.variant, box, preferred_rad_s, limits, projection_};
  JointRows taken(0, joints);
  const std::size_t count = std::min<std::size_t>(tasks.size(), kMaxTasks);
  for (std::size_t k = 0; k < count; ++k) {
    if (!is_valid(tasks[k], joints)) {
      result.velocity_rad_s = braking(box);
      result.tasks = {};
      return result;
    }
    result.tasks[k] = add_task(tasks[k], k == 0, settings_.singular_value_floor, solver, taken, result.velocity_rad_s);
  }
  return result;
}

}  // namespace depthgrid::control
