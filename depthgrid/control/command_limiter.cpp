#include "depthgrid/control/command_limiter.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid::control {

CommandLimiter::CommandLimiter(const JointLimits& limits, double period_s) : limits_(limits), period_s_(period_s) {
  validate(limits);
  validate_period(period_s, "command limiter");
  last_ = {0.5 * (limits.lowest_rad + limits.highest_rad), JointVector::Zero(limits.joints())};
}

bool CommandLimiter::start(const JointVector& position_rad, const JointVector& velocity_rad_s) noexcept {
  if (position_rad.size() != limits_.joints() || velocity_rad_s.size() != limits_.joints() ||
      !position_rad.allFinite() || !velocity_rad_s.allFinite()) {
    return false;
  }
  last_ = {position_rad, velocity_rad_s};
  return true;
}

JointBox CommandLimiter::box() const noexcept {
  return admissible_velocities(limits_, last_.position_rad, last_.velocity_rad_s, period_s_);
}

JointCommand CommandLimiter::step(const JointVector& requested_rad_s) noexcept {
  last_.velocity_rad_s = clamped(requested_rad_s, box());
  last_.position_rad += period_s_ * last_.velocity_rad_s;
  return last_;
}

JointCommand CommandLimiter::step_towards(const JointVector& requested_rad) noexcept {
  JointVector velocity = JointVector::Zero(limits_.joints());
  for (int i = 0; i < std::min<Eigen::Index>(requested_rad.size(), limits_.joints()); ++i) {
    const double way = requested_rad[i] - last_.position_rad[i];
    velocity[i] = std::copysign(largest_stoppable(std::abs(way), limits_.acceleration_rad_s2[i], period_s_), way);
  }
  return step(velocity);
}

}  // namespace depthgrid::control
