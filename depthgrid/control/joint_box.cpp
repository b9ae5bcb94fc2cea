#include "depthgrid/control/joint_box.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid::control {
namespace {

struct Bounds {
  double lower, upper;
};

Bounds clamp_to(const Bounds& wanted, const Bounds& limits) noexcept {
  return {std::clamp(wanted.lower, limits.lower, limits.upper), std::clamp(wanted.upper, limits.lower, limits.upper)};
}

/// Beyond a limit the joint may still move back: towards the other one, which is far.
Bounds stoppable(const JointLimits& limits, int i, double position, double period) noexcept {
  const double acceleration = limits.acceleration_rad_s2[i];
  const Bounds by_position{-largest_stoppable(position - limits.lowest_rad[i], acceleration, period),
                           largest_stoppable(limits.highest_rad[i] - position, acceleration, period)};
  return clamp_to(by_position, {-limits.velocity_rad_s[i], limits.velocity_rad_s[i]});
}

}  // namespace

double largest_stoppable(double gap_rad, double acceleration_rad_s2, double period_s) noexcept {
  if (!(gap_rad > 0)) {
    return 0;
  }
  // In units of a velocity step A T and the way A T^2: n full steps of braking after the first period take
  // (n + 1) v - n (n + 1) / 2, which is n (n + 1) / 2 for v = n.
  const double step = acceleration_rad_s2 * period_s;
  const double gap = gap_rad / (step * period_s);
  const double n = std::floor(0.5 * (std::sqrt(1 + 8 * gap) - 1));
  return step * (gap / (n + 1) + 0.5 * n);
}

double stopping_distance(double velocity_rad_s, double acceleration_rad_s2, double period_s) noexcept {
  const double step = acceleration_rad_s2 * period_s;
  const double v = std::abs(velocity_rad_s) / step;
  const double n = std::floor(v);
  return step * period_s * ((n + 1) * v - 0.5 * n * (n + 1));
}

JointBox admissible_velocities(const JointLimits& limits, const JointVector& position_rad,
                               const JointVector& before_rad_s, double period_s) noexcept {
  JointBox box = stoppable_velocities(limits, position_rad, period_s);
  if (position_rad.size() != limits.joints() || before_rad_s.size() != limits.joints()) {
    return {JointVector::Zero(limits.joints()), JointVector::Zero(limits.joints())};
  }
  for (int i = 0; i < limits.joints(); ++i) {
    if (!std::isfinite(position_rad[i]) || !std::isfinite(before_rad_s[i])) {
      box.lower_rad_s[i] = 0;
      box.upper_rad_s[i] = 0;
      continue;
    }
    const double step = limits.acceleration_rad_s2[i] * period_s;
    const Bounds bounds =
        clamp_to({box.lower_rad_s[i], box.upper_rad_s[i]}, {before_rad_s[i] - step, before_rad_s[i] + step});
    box.lower_rad_s[i] = bounds.lower;
    box.upper_rad_s[i] = bounds.upper;
  }
  return box;
}

JointBox stoppable_velocities(const JointLimits& limits, const JointVector& position_rad, double period_s) noexcept {
  const int joints = limits.joints();
  JointBox box{JointVector::Zero(joints), JointVector::Zero(joints)};
  for (int i = 0; i < std::min<Eigen::Index>(joints, position_rad.size()); ++i) {
    if (std::isfinite(position_rad[i])) {
      const Bounds bounds = stoppable(limits, i, position_rad[i], period_s);
      box.lower_rad_s[i] = bounds.lower;
      box.upper_rad_s[i] = bounds.upper;
    }
  }
  return box;
}

JointBox tightened(const JointBox& box, const JointBox& limits) noexcept {
  JointBox result = box;
  const auto number_or_rest = [](double bound) { return std::isnan(bound) ? 0.0 : bound; };
  for (int i = 0; i < std::min(box.joints(), limits.joints()); ++i) {
    const Bounds bounds = clamp_to({number_or_rest(limits.lower_rad_s[i]), number_or_rest(limits.upper_rad_s[i])},
                                   {box.lower_rad_s[i], box.upper_rad_s[i]});
    result.lower_rad_s[i] = bounds.lower;
    result.upper_rad_s[i] = bounds.upper;
  }
  return result;
}

JointVector clamped(const JointVector& wanted_rad_s, const JointBox& box) noexcept {
  JointVector result = JointVector::Zero(box.joints());
  for (int i = 0; i < box.joints(); ++i) {
    const double wanted = i < wanted_rad_s.size() && std::isfinite(wanted_rad_s[i]) ? wanted_rad_s[i] : 0.0;
    result[i] = std::min(std::max(wanted, box.lower_rad_s[i]), box.upper_rad_s[i]);
  }
  return result;
}

JointVector braking(const JointBox& box) noexcept { return clamped(JointVector::Zero(box.joints()), box); }

bool is_proper(const JointBox& box) noexcept {
  if (box.lower_rad_s.size() != box.upper_rad_s.size()) {
    return false;
  }
  for (int i = 0; i < box.joints(); ++i) {
    if (!(std::isfinite(box.lower_rad_s[i]) && std::isfinite(box.upper_rad_s[i]) &&
          box.lower_rad_s[i] <= box.upper_rad_s[i])) {
      return false;
    }
  }
  return true;
}

bool allows_rest(const JointBox& box) noexcept {
  return (box.lower_rad_s.array() <= 0).all() && (box.upper_rad_s.array() >= 0).all();
}

}  // namespace depthgrid::control
