// The letter's loop around the distances: joint state in, position command out, every period.
//
//   q -> parts of the robot in the world -> distances, directions -> obstacles, Jacobians -> controller -> command
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "depthgrid/avoidance/motion_reason.hpp"
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
  /// kept_clear: the laws take distances from the surface of the blind layer, so an arm that keeps away from an
  /// obstacle keeps its layer away from it, however thick the padding, and sees it as long as it stands outside.
  control::BlindLayer blind_layer = control::BlindLayer::kept_clear;
  /// By the clock: a camera whose image is older is lost. Space that is unknown then limits motion but does not push,
  /// and when all are lost the arm brakes. Greater than 0, at most an hour; no more than the evaluator's own limit.
  double max_image_age_s = 0.5;
};

/// What the laws were given for a part of the robot.
enum class PartState : std::uint8_t {
  known,        ///< a distance; with the blind layer kept clear, what is left of it outside of the layer
  blind_layer,  ///< 0, as at contact: the distance is no more than the layer is thick, and so says nothing
  unknown,      ///< nothing, as at contact: no distance, or nobody says how thick the layer is
};

/// "known", "blind layer", "unknown".
[[nodiscard]] std::string_view to_string(PartState state) noexcept;

/// What a cycle did.
struct CycleReport {
  double time_s = 0;
  Eigen::Vector3d end_effector_world = Eigen::Vector3d::Zero();
  bool evaluated = false;         ///< the answers are new
  double blind_m = 0;             ///< the thickest layer of the answers, metres; NaN where one is not known
  int in_blind_layer = 0;         ///< parts whose state is blind_layer
  int unknown = 0;                ///< and unknown
  int lost_cameras = 0;           ///< at the last evaluation
  ImpossibleSurfaces impossible;  ///< so far, as of the last evaluation: more than 0 images are for a person to look at
  MotionReason reason;            ///< why motion is limited: describe() makes a sentence of it
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
  /// command, or the time is not finite or did not go on. Without a state, a time, or any image that is new enough,
  /// every joint brakes with its own acceleration, from this period on; report().reason says why. Unless the last
  /// start() succeeded it writes nothing and returns false. It feeds no joint history: a HistoryPort around `port`
  /// does.
  bool cycle(control::RobotPort& port, double now_s) noexcept;

  [[nodiscard]] const CycleReport& report() const noexcept { return report_; }
  /// Of the last evaluation, one a part, and where the parts are now.
  [[nodiscard]] std::span<const Answer> answers() const noexcept { return answers_; }
  [[nodiscard]] std::span<const PartState> states() const noexcept { return states_; }
  [[nodiscard]] std::span<const Capsule> parts_world() const noexcept { return parts_world_; }
  [[nodiscard]] std::span<const Pose> T_world_link() const noexcept { return T_world_link_; }

 private:
  [[nodiscard]] bool read(control::RobotPort& port, double now_s) noexcept;
  bool brake(control::RobotPort& port, double now_s, MotionLimit why) noexcept;
  void evaluate(double now_s) noexcept;
  void look_for_lost_cameras(double now_s) noexcept;
  [[nodiscard]] control::Obstacle obstacle_of_part(std::size_t part) const noexcept;
  [[nodiscard]] double braking_m(const control::PointJacobian& jacobian) const noexcept;
  [[nodiscard]] MotionReason reason(double now_s) const noexcept;
  void jacobian(std::size_t link, const Eigen::Vector3d& p_world, control::PointJacobian& result) noexcept;

  robot::PlacedRobot robot_;
  control::MotionTask& task_;
  DistanceEvaluator& evaluator_;
  LoopSettings settings_;
  control::Controller controller_;
  bool started_ = false;
  std::int64_t cycles_ = 0;
  double newest_s_ = Proximity::kNaN;        ///< time of the last cycle
  double newest_state_s_ = Proximity::kNaN;  ///< of the last cycle with a state
  control::JointState state_;
  std::vector<Pose> T_world_link_;
  std::vector<Capsule> parts_world_;
  std::vector<Answer> answers_;
  std::vector<PartState> states_;
  std::vector<Eigen::Vector3d> at_link_;  ///< of the answers, in the frames of their links
  std::vector<control::BodyPoint> body_;
  control::EndEffector tip_;
  robot::Jacobian jacobian_;
  control::PointJacobian jacobian_tip_;
  std::optional<std::size_t> late_camera_;
  double late_s_ = Proximity::kNaN;
  CycleReport report_;
};

}  // namespace depthgrid::avoidance
