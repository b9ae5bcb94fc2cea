// The letter's loop around the distances: joint state in, position command out, every period.
//
//   q -> parts of the robot in the world -> distances, directions -> obstacles, Jacobians -> controller -> command
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "depthgrid/control/controller.hpp"
#include "depthgrid/control/motion_task.hpp"
#include "depthgrid/control/robot_port.hpp"
#include "depthgrid/core/distance_evaluator.hpp"
#include "depthgrid/robot/placed_robot.hpp"
#include "depthgrid/robot/robot_parts.hpp"

namespace depthgrid::avoidance {

struct LoopSettings {
  control::ControllerSettings controller;
  std::vector<robot::LinkCapsule> parts;  ///< the first is the end effector: it is repelled; the others are the body
  bool end_effector_limits = false;       ///< whether the end effector's approach is limited like that of the body, too
  int evaluate_every = 1;  ///< periods between two evaluations; in between obstacles stand where they did
};

/// What a cycle did.
struct CycleReport {
  double time_s = 0;
  Eigen::Vector3d end_effector_world = Eigen::Vector3d::Zero();
  bool evaluated = false;  ///< the answers are new
  control::CycleOutput output;
};

/// - Takes: joint states from the port, rad or m; times in seconds on the cameras' clock.
/// - Gives: commands to the port; report(), answers() and parts_world() in the world frame, metres.
/// - Errors: the constructor throws Error; start() and cycle() return false.
/// - Threads: one. cycle() neither locks nor throws, nor allocates as long as the evaluator does not.
class AvoidanceLoop {
 public:
  /// Task and evaluator must outlive it. Throws Error when the controller's settings are invalid, there is no part, a
  /// part's link does not exist, or the limits are not those of the model's joints in number.
  AvoidanceLoop(robot::PlacedRobot robot, control::MotionTask& task, DistanceEvaluator& evaluator,
                const LoopSettings& settings);

  /// Takes the robot's state as the beginning. False when there is none or it is not finite: cycle() then does nothing.
  [[nodiscard]] bool start(control::RobotPort& port) noexcept;

  /// One period at time `now_s`, on the clock of the cameras. False when the robot gave no state or did not take the
  /// command. Without a state distances and Jacobians are those of the last one. Unless the last start() succeeded it
  /// writes nothing and returns false. It feeds no joint history: a HistoryPort around `port` does.
  bool cycle(control::RobotPort& port, double now_s) noexcept;

  [[nodiscard]] const CycleReport& report() const noexcept { return report_; }
  /// Of the last evaluation, one a part, and where the parts are now.
  [[nodiscard]] std::span<const Answer> answers() const noexcept { return answers_; }
  [[nodiscard]] std::span<const Capsule> parts_world() const noexcept { return parts_world_; }
  [[nodiscard]] std::span<const Pose> T_world_link() const noexcept { return T_world_link_; }

 private:
  void evaluate(double now_s) noexcept;
  void jacobian(std::size_t link, const Eigen::Vector3d& p_world, control::PointJacobian& result) noexcept;

  robot::PlacedRobot robot_;
  control::MotionTask& task_;
  DistanceEvaluator& evaluator_;
  LoopSettings settings_;
  control::Controller controller_;
  bool started_ = false;
  std::int64_t cycles_ = 0;
  control::JointState state_;
  std::vector<Pose> T_world_link_;
  std::vector<Capsule> parts_world_;
  std::vector<Answer> answers_;
  std::vector<Eigen::Vector3d> at_link_;  ///< of the answers, in the frames of their links
  std::vector<control::BodyPoint> body_;
  control::EndEffector tip_;
  robot::Jacobian jacobian_;
  CycleReport report_;
};

}  // namespace depthgrid::avoidance
