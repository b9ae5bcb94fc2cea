#include "depthgrid/monitor/part_places.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "depthgrid/core/proximity.hpp"
#include "depthgrid/robot/motion_padding.hpp"

namespace depthgrid::monitor {

PartPlaces::PartPlaces(const cell::CellSetup& setup)
    : robot_(setup.robot), asked_(setup.parts), time_error_s_(setup.exposure.time_error_s) {
  for (const cell::AskedPart& part : asked_) {
    if (part.on_robot) {
      links_.push_back(*part.on_robot);
    }
  }
  if (robot_) {
    for (const robot::Joint& joint : robot_->model.joints()) {
      speeds_.push_back(joint.max_speed);
    }
    q_.resize(speeds_.size());
    window_.resize(speeds_.size());
    moved_.resize(speeds_.size());
    accelerations_ = setup.exposure.joint_accelerations;
    accelerations_.resize(speeds_.size(), std::numeric_limits<double>::infinity());
    T_world_link_.assign(robot_->model.links().size(), Pose::Identity());
  }
  links_world_.resize(links_.size());
  motion_m_.resize(links_.size());
  part_motion_m_.resize(asked_.size());
}

bool PartPlaces::find(double now_s, const robot::JointHistory* history, const robot::JointMoment& known,
                      std::span<Capsule> parts) noexcept {
  bool placed = true;
  if (robot_ && history != nullptr) {
    const robot::JointsAtTime joints = history->at(now_s, q_, known);
    placed = joints.known() && robot_->link_poses(q_, T_world_link_);
    if (placed) {
      robot::place(links_, T_world_link_, links_world_);
      bound_motion(now_s, joints.time_error_s, *history, known);
      robot::motion_padding(robot_->model, links_, T_world_link_, moved_, 1.0, motion_m_);
    }
  }
  std::size_t link = 0;
  for (std::size_t i = 0; i < asked_.size(); ++i) {
    if (!asked_[i].on_robot) {
      parts[i] = asked_[i].at_world;
      continue;
    }
    parts[i] = links_world_[link];
    // Not finite: the evaluator answers not_evaluated.
    part_motion_m_[i] = placed ? motion_m_[link] : Proximity::kNaN;
    parts[i].radius_m += placed ? motion_m_[link] : Proximity::kNaN;
    ++link;
  }
  return placed;
}

// Since their newest state the joints may have gone anywhere at their greatest speeds, and that state's own time may be
// off by what the cell declares; as RobotAtExposure has it for images.
void PartPlaces::bound_motion(double now_s, double hold_s, const robot::JointHistory& history,
                              const robot::JointMoment& known) noexcept {
  const bool measured = history.greatest_motion(now_s, time_error_s_, q_, speeds_, accelerations_, window_, known);
  for (std::size_t j = 0; j < moved_.size(); ++j) {
    const double at_most = speeds_[j] * (time_error_s_ + hold_s);
    const double by_samples = std::isfinite(accelerations_[j]) ? window_[j] : std::min(at_most, window_[j]);
    moved_[j] = measured ? by_samples : at_most;
  }
}

}  // namespace depthgrid::monitor
