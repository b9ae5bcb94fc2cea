#include "depthgrid/control/body_limits.hpp"

#include <algorithm>
#include <cmath>

#include "depthgrid/control/repulsion.hpp"
#include "depthgrid/core/error.hpp"

namespace depthgrid::control {
namespace {

/// Below this (metres of motion for each radian) a joint does not move the point: rounding in the Jacobian.
constexpr double kNoLever = 1e-9;

/// Fastest approach of the point within +-V: towards n, or in any direction without n.
double full_approach(const JointVector& velocity, const PointJacobian& jacobian, const Obstacle& obstacle) noexcept {
  double speed = 0;
  for (int i = 0; i < velocity.size(); ++i) {
    const double lever =
        obstacle.direction_world ? std::abs(jacobian.col(i).dot(*obstacle.direction_world)) : jacobian.col(i).norm();
    speed += lever * velocity[i];
  }
  return speed;
}

double allowed_speed(double distance, const BodySettings& settings) noexcept {
  return settings.gain_per_s * std::max(0.0, distance - settings.stop_m);
}

/// The share of V_i that is left to joints that approach.
double share_left(const JointVector& velocity, const PointJacobian& jacobian, const Obstacle& obstacle,
                  const BodySettings& settings) noexcept {
  if (settings.law == BodyLaw::risk) {
    return 1.0 - risk(obstacle, settings.rho_m, settings.alpha);
  }
  const double distance = obstacle.distance_m.value_or(0.0);
  if (distance >= settings.rho_m) {
    return 1.0;
  }
  const double allowed = allowed_speed(distance, settings);
  const double full = full_approach(velocity, jacobian, obstacle);
  return full > allowed ? allowed / full : 1.0;
}

}  // namespace

void validate(const BodySettings& settings) {
  validate(RepulsionSettings{.rho_m = settings.rho_m, .alpha = settings.alpha});
  if (!(std::isfinite(settings.gain_per_s) && settings.gain_per_s > 0)) {
    fail("body limits: gain is ", settings.gain_per_s, " 1/s, must be greater than 0 and finite");
  }
  if (!(settings.stop_m >= 0 && settings.stop_m < settings.rho_m)) {
    fail("body limits: stop is ", settings.stop_m, " m, must not be negative and less than rho (", settings.rho_m,
         " m)");
  }
}

JointBox velocity_limits(const JointLimits& limits) noexcept { return {-limits.velocity_rad_s, limits.velocity_rad_s}; }

void limit_by_obstacle(JointBox& box, const JointVector& velocity_rad_s, const PointJacobian& jacobian,
                       const Obstacle& obstacle, const BodySettings& settings) noexcept {
  const int joints = box.joints();
  if (jacobian.cols() != joints || velocity_rad_s.size() != joints || !jacobian.allFinite()) {
    box.lower_rad_s.setZero();
    box.upper_rad_s.setZero();
    return;
  }
  const double share = share_left(velocity_rad_s, jacobian, obstacle, settings);
  if (share >= 1.0) {
    return;
  }
  for (int i = 0; i < joints; ++i) {
    const double limit = velocity_rad_s[i] * share;
    const double lever = obstacle.direction_world ? jacobian.col(i).dot(*obstacle.direction_world) : 0.0;
    const bool either = !obstacle.direction_world && jacobian.col(i).norm() > kNoLever;
    if (either || lever > kNoLever) {
      box.upper_rad_s[i] = std::min(box.upper_rad_s[i], limit);
    }
    if (either || lever < -kNoLever) {
      box.lower_rad_s[i] = std::max(box.lower_rad_s[i], -limit);
    }
  }
}

std::optional<ApproachLimit> approach_limit(const PointJacobian& jacobian, const Obstacle& obstacle,
                                            const BodySettings& settings) noexcept {
  const double distance = obstacle.distance_m.value_or(0.0);
  if (!obstacle.direction_world || distance >= settings.rho_m || !jacobian.allFinite()) {
    return std::nullopt;
  }
  return ApproachLimit{jacobian.transpose() * *obstacle.direction_world, allowed_speed(distance, settings)};
}

double fastest_approach(const JointBox& box, const PointJacobian& jacobian, const Eigen::Vector3d& n) noexcept {
  double speed = 0;
  for (int i = 0; i < box.joints(); ++i) {
    const double lever = jacobian.col(i).dot(n);
    speed += lever * (lever > 0 ? box.upper_rad_s[i] : box.lower_rad_s[i]);
  }
  return speed;
}

}  // namespace depthgrid::control
