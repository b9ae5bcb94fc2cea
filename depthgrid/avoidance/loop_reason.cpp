// Why the loop limits motion, and how it ends it.
#include <algorithm>
#include <limits>

#include "depthgrid/avoidance/avoidance_loop.hpp"

namespace depthgrid::avoidance {

double AvoidanceLoop::braking_m(const control::PointJacobian& jacobian) const noexcept {
  const control::JointVector& velocity_rad_s = controller_.last().velocity_rad_s;
  double way_m = 0;
  for (Eigen::Index j = 0; j < std::min(velocity_rad_s.size(), jacobian.cols()); ++j) {
    way_m += jacobian.col(j).norm() * velocity_rad_s[j] * velocity_rad_s[j] /
             (2 * settings_.controller.limits.acceleration_rad_s2[j]);
  }
  return way_m;
}

MotionReason AvoidanceLoop::reason(double now_s) const noexcept {
  MotionReason reason;
  double least_room_m = std::numeric_limits<double>::infinity();
  const std::size_t first = settings_.end_effector_limits ? 0 : 1;
  for (std::size_t i = 0; i < answers_.size(); ++i) {
    const double rho_m = i < first ? settings_.controller.repulsion.rho_m : settings_.controller.body.rho_m;
    const double clear_m = control::obstacle_of(answers_[i], settings_.blind_layer).distance_m.value_or(0);
    const double way_m = braking_m(i < first ? jacobian_tip_ : body_[i - first].jacobian);
    if (!(clear_m < rho_m && clear_m - way_m < least_room_m)) {
      continue;
    }
    least_room_m = clear_m - way_m;
    reason.limit = states_[i] == PartState::unknown       ? MotionLimit::unknown_distance
                   : states_[i] == PartState::blind_layer ? MotionLimit::blind_layer
                   : answers_[i].nearest.budget           ? MotionLimit::budget
                                                          : MotionLimit::obstacle;
    reason.part = i;
    reason.link = robot_.model.links()[settings_.parts[i].link].name;
    reason.state = answers_[i].nearest.state;
    reason.unmeasured = answers_[i].nearest.unmeasured;
    reason.clear_m = clear_m;
    reason.braking_m = way_m;
  }
  if (reason.limit == MotionLimit::obstacle) {
    reason.past = evaluator_.past(answers_[*reason.part].nearest);
  }
  reason.time_s = now_s;
  reason.late_camera = late_camera_;
  reason.late_s = late_camera_ ? late_s_ : Proximity::kNaN;
  reason.impossible_images = report_.impossible.images;
  reason.impossible_s = now_s - report_.impossible.time_s;
  return reason;
}

bool AvoidanceLoop::brake(control::RobotPort& port, double now_s, MotionLimit why) noexcept {
  double farthest_m = braking_m(jacobian_tip_);
  for (const control::BodyPoint& point : body_) {
    farthest_m = std::max(farthest_m, braking_m(point.jacobian));
  }
  const bool state_missing = why == MotionLimit::no_joint_state;
  report_.reason = {.limit = why,
                    .part = {},
                    .link = {},
                    .state = ProximityState::not_evaluated,
                    .unmeasured = Unmeasured::not_told,
                    .past = {},
                    .time_s = now_s,
                    .clear_m = Proximity::kNaN,
                    .braking_m = farthest_m,
                    .late_camera = late_camera_,
                    .late_s = state_missing ? now_s - newest_state_s_ : late_s_,
                    .impossible_images = report_.impossible.images,
                    .impossible_s = now_s - report_.impossible.time_s};
  report_.time_s = now_s;
  report_.output = controller_.brake();
  return port.write(report_.output.command);
}

}  // namespace depthgrid::avoidance
