// Saturation in the null space at velocity level: the joint velocities within a box that do as much of a task as they
// can, where one joint that is at its limit leaves its share to the others.
//
//   largest s in [0, 1] with J qd = s xd, lower <= qd <= upper; among these qd the one nearest to a preferred velocity
//
// Several tasks in the order of their priority: each does as much as is left beside those before it, and does not
// disturb them.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "depthgrid/control/approach_limit.hpp"
#include "depthgrid/control/joint_box.hpp"
#include "depthgrid/control/projection.hpp"

namespace depthgrid::control {

/// Most tasks of one call.
inline constexpr int kMaxTasks = 4;

/// jacobian * velocity of the joints = velocity.
struct Task {
  TaskJacobian jacobian;
  TaskVector velocity;
};

enum class SaturationVariant : std::uint8_t {
  basic,    ///< the algorithm of Flacco, De Luca and Khatib (2012): saturates the most critical joint, never lets go. A
            ///< scale that is feasible, not always the largest; knows neither preferred velocity nor approach limits
  optimal,  ///< the largest scale, and the nearest qd to the preferred one, as a quadratic programme
};

struct SaturationSettings {
  SaturationVariant variant = SaturationVariant::optimal;
  /// Directions of a task with a singular value below this (m/s for a joint velocity of length 1 rad/s) are asked for
  /// less, down to not at all.
  double singular_value_floor = 0.03;
};

/// Throws Error with value and rule.
void validate(const SaturationSettings& settings);

/// What became of a task.
enum class TaskOutcome : std::uint8_t {
  full,    ///< s = 1
  scaled,  ///< s < 1 in the task's own direction
  turned,  ///< the box excludes rest and every multiple of xd: from the slowest motion (the task before it) towards xd,
           ///< as far as possible; scale is the share of that way
  given_up,  ///< nothing of it: the motion is that of the tasks before, or braking. Basic: no scale found
  invalid,   ///< not finite, or of another size than the box: all joints brake, and tasks after it are not looked at
};

struct TaskResult {
  TaskOutcome outcome = TaskOutcome::invalid;
  double scale = 0;     ///< s
  double left_out = 0;  ///< norm of the part of the request that the singular value floor leaves out
};

struct SaturationResult {
  JointVector velocity_rad_s;  ///< always within the box
  std::array<TaskResult, kMaxTasks> tasks{};
};

/// Solves with scratch memory of its own; not for two threads at once.
class Saturation {
 public:
  /// Throws Error when the settings are invalid.
  explicit Saturation(const SaturationSettings& settings);

  /// At most kMaxTasks tasks and kMaxInequalities limits are looked at. `preferred`: empty for the shortest velocity.
  /// A limit that even braking() does not keep is widened to what braking gives. Without tasks the joints brake. A box
  /// that is not proper gives rest and invalid tasks. Does not allocate, lock or throw.
  [[nodiscard]] SaturationResult solve(std::span<const Task> tasks, const JointBox& box,
                                       const JointVector& preferred_rad_s = {},
                                       std::span<const ApproachLimit> limits = {}) noexcept;

 private:
  SaturationSettings settings_;
  Projection projection_;
};

}  // namespace depthgrid::control
