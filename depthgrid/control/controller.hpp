// One control cycle: distances and a task in, the next position command out.
//
//   xd = xd_task + V_rep(end effector)                 in the end effector's first three rows
//   box = joint limits, tightened by every point of the body
//   qd  = saturation in the null space of (xd, further tasks) within the box, nearest to a posture
//   q   = q_before + T qd                              within position, velocity and acceleration limits
//
// The optimal saturation knows the acceleration limits and chooses within them. The basic one would find no scale while
// the arm moves, since standing still is then out of reach: it chooses without them, and the command follows as fast as
// they let it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>

#include "depthgrid/control/body_limits.hpp"
#include "depthgrid/control/command_limiter.hpp"
#include "depthgrid/control/contact_memory.hpp"
#include "depthgrid/control/pivot.hpp"
#include "depthgrid/control/repulsion.hpp"
#include "depthgrid/control/saturation.hpp"

namespace depthgrid::control {

struct ControllerSettings {
  JointLimits limits;
  double period_s = 0.002;
  RepulsionSettings repulsion;         ///< of the end effector
  std::optional<PivotSettings> pivot;  ///< evades sideways; off by default
  BodySettings body;                   ///< of the other points
  SaturationSettings saturation;
  JointVector posture_rad;          ///< where joints drift that the task leaves free; empty: nowhere
  double posture_gain_per_s = 1.0;  ///< speed of that, for each radian
  double contact_memory_s = 0.5;    ///< how long a direction is believed after contact
};

/// Throws Error with value and rule.
void validate(const ControllerSettings& settings);

/// A control point, or the point of a link capsule's axis that the obstacle is nearest to.
struct BodyPoint {
  PointJacobian jacobian;
  Obstacle obstacle;
};

struct CycleInput {
  Task task;  ///< of the end effector; its first three rows are the velocity of its point in the world frame
  Obstacle end_effector;                ///< seen from that point
  std::span<const BodyPoint> body;      ///< in the same order every cycle
  std::span<const Task> further_tasks;  ///< of lower priority, at most kMaxTasks - 1
};

struct CycleOutput {
  JointCommand command;
  Eigen::Vector3d repulsion_m_s = Eigen::Vector3d::Zero();  ///< V_rep, pivoted where that is on
  double largest_risk = 0;                                  ///< f over the points of the body
  std::array<TaskResult, kMaxTasks> tasks{};
  JointBox box;  ///< that the saturation chose from
};

/// Not for two threads at once; cycle() does not allocate, lock or throw.
class Controller {
 public:
  /// Throws Error when the settings are invalid.
  explicit Controller(const ControllerSettings& settings);

  /// Begins at rest, or at the robot's state. False when it is not finite or of another size.
  bool start(const JointVector& position_rad) noexcept;
  bool start(const JointState& state) noexcept;

  /// The next command. The command stays within the limits whatever comes in: input that is not finite, or a distance
  /// that is unknown, makes the robot brake (see Obstacle and Saturation). Without a direction the task itself slows by
  /// the risk, since nothing says where to evade to.
  [[nodiscard]] CycleOutput cycle(const CycleInput& input) noexcept;

  /// The next command of a stop: every joint brakes with its own acceleration until it stands, whatever the task. The
  /// next cycle() goes on from there.
  [[nodiscard]] CycleOutput brake() noexcept;

  [[nodiscard]] const JointCommand& last() const noexcept { return limiter_.last(); }

 private:
  [[nodiscard]] Eigen::Vector3d repulsion(const Obstacle& obstacle) noexcept;
  [[nodiscard]] JointVector posture_velocity() const noexcept;

  ControllerSettings settings_;
  CommandLimiter limiter_;
  Saturation saturation_;
  ContactMemory memory_;
  Eigen::Vector3d repulsion_before_ = Eigen::Vector3d::Zero();
  std::array<Task, kMaxTasks> tasks_;
  std::array<ApproachLimit, kMaxInequalities> approach_;
};

}  // namespace depthgrid::control
