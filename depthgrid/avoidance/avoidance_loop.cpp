#include "depthgrid/avoidance/avoidance_loop.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "depthgrid/core/blind_layer.hpp"
#include "depthgrid/core/error.hpp"

namespace depthgrid::avoidance {

namespace {

PartState state_of(const Answer& answer, control::BlindLayer layer) noexcept {
  if (!control::obstacle_of(answer, layer).distance_m) {
    return PartState::unknown;
  }
  const bool kept_clear = layer == control::BlindLayer::kept_clear;
  const bool within = kept_clear && answer.blind_m > 0 && answer.distance_now_m <= answer.blind_m;
  return within ? PartState::blind_layer : PartState::known;
}

}  // namespace

std::string_view to_string(PartState state) noexcept {
  switch (state) {
    case PartState::known:
      return "known";
    case PartState::blind_layer:
      return "blind layer";
    case PartState::unknown:
      return "unknown";
  }
  return "invalid";
}

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
      states_(settings.parts.size(), PartState::unknown),
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
  if (!(settings.max_image_age_s > 0 && settings.max_image_age_s <= 3600)) {
    fail("avoidance loop: images count up to an age of ", settings.max_image_age_s,
         " s, must be above 0 and at most 3600: how old a camera's newest image becomes");
  }
  (void)pose_from_matrix(robot_.T_world_base.matrix(), "avoidance loop: T_world_base");  // throws where it is not rigid
  jacobian_.setZero(6, joints);
  const control::PointJacobian none = control::PointJacobian::Zero(3, joints);
  jacobian_tip_ = none;
  body_.assign(settings.parts.size() - (settings.end_effector_limits ? 0 : 1), {none, {}});
}

bool AvoidanceLoop::start(control::RobotPort& port) noexcept {
  cycles_ = 0;
  newest_s_ = Proximity::kNaN;
  newest_state_s_ = Proximity::kNaN;
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
  report_.impossible = evaluator_.impossible();
  look_for_lost_cameras(now_s);
  report_.blind_m = 0;
  report_.in_blind_layer = 0;
  report_.unknown = 0;
  for (std::size_t i = 0; i < answers_.size(); ++i) {
    states_[i] = state_of(answers_[i], settings_.blind_layer);
    report_.blind_m = thicker(report_.blind_m, answers_[i].blind_m);
    report_.in_blind_layer += states_[i] == PartState::blind_layer ? 1 : 0;
    report_.unknown += states_[i] == PartState::unknown ? 1 : 0;
    const Eigen::Vector3d& on_axis_world = answers_[i].on_axis_world;
    const Eigen::Vector3d& at_world = on_axis_world.allFinite() ? on_axis_world : parts_world_[i].a;
    at_link_[i] = T_world_link_[settings_.parts[i].link].inverse(Eigen::Isometry) * at_world;
  }
}

void AvoidanceLoop::look_for_lost_cameras(double now_s) noexcept {
  report_.lost_cameras = 0;
  late_camera_.reset();
  late_s_ = 0;
  for (std::size_t k = 0; k < evaluator_.camera_count(); ++k) {
    const double age_s = now_s - evaluator_.image_time_s(k);
    if (age_s <= settings_.max_image_age_s) {
      continue;
    }
    ++report_.lost_cameras;
    // A camera that has never sent anything is the longest without.
    if (!late_camera_ || std::isnan(age_s) || age_s > late_s_) {
      late_camera_ = k;
      late_s_ = age_s;
    }
  }
}

control::Obstacle AvoidanceLoop::obstacle_of_part(std::size_t part) const noexcept {
  control::Obstacle obstacle = control::obstacle_of(answers_[part], settings_.blind_layer);
  if (report_.lost_cameras > 0 && answers_[part].nearest.state != ProximityState::measured) {
    obstacle.pushes = false;
    obstacle.direction_world.reset();
    obstacle.hybrid_direction_world.setZero();
  }
  return obstacle;
}

bool AvoidanceLoop::read(control::RobotPort& port, double now_s) noexcept {
  control::JointState next = state_;
  // A state of another robot is none.
  if (!port.read(next) || next.position_rad.size() != state_.position_rad.size() || !next.position_rad.allFinite()) {
    return false;
  }
  state_ = next;
  newest_state_s_ = now_s;
  return true;
}

bool AvoidanceLoop::cycle(control::RobotPort& port, double now_s) noexcept {
  if (!started_) {
    return false;
  }
  const bool on_time = std::isfinite(now_s) && !(now_s <= newest_s_);
  newest_s_ = on_time ? now_s : newest_s_;
  const bool has_state = read(port, now_s);
  if (!on_time || !has_state) {
    report_.evaluated = false;
    cycles_ = 0;  // evaluates at once when it goes on
    (void)brake(port, now_s, on_time ? MotionLimit::no_joint_state : MotionLimit::clock);
    return false;
  }
  const std::span<const double> q(state_.position_rad.data(), static_cast<std::size_t>(state_.position_rad.size()));
  const bool working = robot_.link_poses(q, T_world_link_);
  place(settings_.parts, T_world_link_, parts_world_);
  evaluate(now_s);

  // The end effector's point is the origin of the part's link: the task is about the flange, whatever shape is asked
  // for its distance.
  const std::size_t tip_link = settings_.parts[0].link;
  report_.end_effector_world = T_world_link_[tip_link].translation();
  (void)robot_.model.jacobian(q, T_world_link_, tip_link, report_.end_effector_world, jacobian_);
  tip_ = {T_world_link_[tip_link], jacobian_, now_s};
  jacobian_tip_ = jacobian_.topRows<3>();

  const std::size_t first = settings_.end_effector_limits ? 0 : 1;
  for (std::size_t i = first; i < settings_.parts.size(); ++i) {
    const std::size_t link = settings_.parts[i].link;
    jacobian(link, T_world_link_[link] * at_link_[i], body_[i - first].jacobian);
    body_[i - first].obstacle = obstacle_of_part(i);
  }
  ++cycles_;
  const std::size_t cameras = evaluator_.camera_count();
  if (cameras > 0 && report_.lost_cameras == static_cast<int>(cameras)) {
    return brake(port, now_s, MotionLimit::no_images) && working;
  }
  report_.time_s = now_s;
  report_.reason = reason(now_s);
  report_.output = controller_.cycle(
      {.task = task_.rows(tip_), .end_effector = obstacle_of_part(0), .body = body_, .further_tasks = {}});
  return port.write(report_.output.command) && working;
}

}  // namespace depthgrid::avoidance
