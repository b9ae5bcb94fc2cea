#include "depthgrid/avoidance/avoidance_loop.hpp"

#include <utility>

#include "depthgrid/core/error.hpp"

namespace depthgrid::avoidance {

AvoidanceLoop::AvoidanceLoop(robot::PlacedRobot robot, control::MotionTask& task, DistanceEvaluator& evaluator,
                             const LoopSettings& settings)
    : robot_(std::move(robot)),
      task_(task),
      evaluator_(evaluator),
      settings_(settings),
      controller_(settings.controller),
      T_world_link_(robot_.model.links().size(), Pose::Identity()),
      parts_world_(settings.parts.size()),
      answers_(settings.parts.size()),
      at_link_(settings.parts.size(), Eigen::Vector3d::Zero()) {
  const robot::RobotModel& model = robot_.model;
  const auto joints = static_cast<int>(model.joints().size());
  if (settings.controller.limits.joints() != joints) {
    fail(model.source(), ": limits for ", settings.controller.limits.joints(), " joints, the robot has ", joints);
  }
  if (settings.parts.empty()) {
    fail("avoidance loop: no part of the robot is asked about; the first one is the end effector");
  }
  for (const robot::LinkCapsule& part : settings.parts) {
    if (part.link >= model.links().size()) {
      fail("avoidance loop: a part moves with link ", part.link, ", the robot has ", model.links().size());
    }
  }
  if (settings.evaluate_every < 1) {
    fail("avoidance loop: evaluates every ", settings.evaluate_every, " periods, must be at least 1");
  }
  (void)pose_from_matrix(robot_.T_world_base.matrix(), "avoidance loop: T_world_base");  // throws where it is not rigid
  jacobian_.setZero(6, joints);
  const control::PointJacobian none = control::PointJacobian::Zero(3, joints);
  body_.assign(settings.parts.size() - (settings.end_effector_limits ? 0 : 1), {none, {}});
}

bool AvoidanceLoop::start(control::RobotPort& port) noexcept {
  cycles_ = 0;
  started_ = port.read(state_) && controller_.start(state_);
  return started_;
}

void AvoidanceLoop::jacobian(std::size_t link, const Eigen::Vector3d& p_world,
                             control::PointJacobian& result) noexcept {
  const std::span<const double> q(state_.position_rad.data(), static_cast<std::size_t>(state_.position_rad.size()));
  (void)robot_.model.jacobian(q, T_world_link_, link, p_world, jacobian_);
  result = jacobian_.topRows<3>();
}

void AvoidanceLoop::evaluate(double now_s) noexcept {
  report_.evaluated = cycles_ % settings_.evaluate_every == 0;
  if (!report_.evaluated) {
    return;
  }
  evaluator_.evaluate(parts_world_, now_s, answers_);
  for (std::size_t i = 0; i < answers_.size(); ++i) {
    const Eigen::Vector3d& on_axis_world = answers_[i].on_axis_world;
    const Eigen::Vector3d& at_world = on_axis_world.allFinite() ? on_axis_world : parts_world_[i].a;
    at_link_[i] = T_world_link_[settings_.parts[i].link].inverse(Eigen::Isometry) * at_world;
  }
}

bool AvoidanceLoop::cycle(control::RobotPort& port, double now_s) noexcept {
  if (!started_) {
    return false;
  }
  control::JointState next = state_;
  // A state of another robot is none.
  bool working = port.read(next) && next.position_rad.size() == state_.position_rad.size();
  if (working) {
    state_ = next;
  }
  working = working && state_.position_rad.allFinite();
  const std::span<const double> q(state_.position_rad.data(), static_cast<std::size_t>(state_.position_rad.size()));
  working = robot_.link_poses(q, T_world_link_) && working;
  place(settings_.parts, T_world_link_, parts_world_);
  evaluate(now_s);

  // The end effector's point is the origin of the part's link: the task is about the flange, whatever shape is asked
  // for its distance.
  const std::size_t tip_link = settings_.parts[0].link;
  report_.end_effector_world = T_world_link_[tip_link].translation();
  (void)robot_.model.jacobian(q, T_world_link_, tip_link, report_.end_effector_world, jacobian_);
  tip_ = {T_world_link_[tip_link], jacobian_, now_s};

  const std::size_t first = settings_.end_effector_limits ? 0 : 1;
  for (std::size_t i = first; i < settings_.parts.size(); ++i) {
    const std::size_t link = settings_.parts[i].link;
    jacobian(link, T_world_link_[link] * at_link_[i], body_[i - first].jacobian);
    body_[i - first].obstacle = control::obstacle_of(answers_[i]);
  }
  report_.time_s = now_s;
  report_.output = controller_.cycle({.task = task_.rows(tip_),
                                      .end_effector = control::obstacle_of(answers_[0]),
                                      .body = body_,
                                      .further_tasks = {}});
  ++cycles_;
  return port.write(report_.output.command) && working;
}

}  // namespace depthgrid::avoidance
