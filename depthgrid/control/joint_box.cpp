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

Bounds admissible(double lowest, double highest, double velocity, double acceleration, double position, double before,
                  double period) noexcept {
  if (!(std::isfinite(position) && std::isfinite(before))) {
    return {0, 0};
  }
  // Beyond a limit the joint may still move back: towards the other one, which is far.
  const Bounds by_position{-largest_stoppable(position - lowest, acceleration, period),
                           largest_stoppable(highest - position, acceleration, period)};
  const double step = acceleration * period;
  return clamp_to(clamp_to(by_position, {-velocity, velocity}), {before - step, before + step});
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
  const int joints = limits.joints();
  JointBox box{JointVector::Zero(joints), JointVector::Zero(joints)};
  if (position_rad.size() != joints || before_rad_s.size() != joints) {
    return box;
  }
  for (int i = 0; i < joints; ++i) {
    const Bounds bounds = admissible(limits.lowest_rad[i], limits.highest_rad[i], limits.velocity_rad_s[i],
                                     limits.acceleration_rad_s2[i], position_rad[i], before_rad_s[i], period_s);
    box.lower_rad_s[i] = bounds.lower;
    box.upper_rad_s[i] = bounds.upper;
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
