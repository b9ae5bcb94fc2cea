// The velocities that the joints may have in the next period: a box.
//
// A command of velocity v moves a joint from q to q + T v. The box keeps |v| <= V, |v - v_before| <= A T, and every q
// from which braking with A T per period would pass a position limit out of reach: with v_k = v - k A T as long as that
// is positive, T sum_k v_k <= q_max - q. So a stop before the limit is possible after every command, not only now. As
// long as all commands come from such boxes the box is never empty (docs/control.md has the argument).
#pragma once

#include "depthgrid/control/joint_limits.hpp"

namespace depthgrid::control {

/// lower <= velocity <= upper for every joint, rad/s.
struct JointBox {
  JointVector lower_rad_s;
  JointVector upper_rad_s;

  [[nodiscard]] int joints() const noexcept { return static_cast<int>(lower_rad_s.size()); }
};

/// The largest velocity >= 0 from which a joint that has `gap_rad` left still stops in time: this period's motion and
/// braking by acceleration * period each period after it. 0 for a gap <= 0 or NaN.
[[nodiscard]] double largest_stoppable(double gap_rad, double acceleration_rad_s2, double period_s) noexcept;

/// How far a joint goes that has this velocity for one period and brakes in those after it; >= 0.
[[nodiscard]] double stopping_distance(double velocity_rad_s, double acceleration_rad_s2, double period_s) noexcept;

/// The box after a command of velocity `before_rad_s` has brought the joints to `position_rad`. Where the limits
/// exclude each other, because a joint is outside or too fast already, acceleration comes before velocity and velocity
/// before position: the joint brakes with all it has, and outside its range it may only move back. A value that is not
/// finite closes that joint's interval at 0.
[[nodiscard]] JointBox admissible_velocities(const JointLimits& limits, const JointVector& position_rad,
                                             const JointVector& before_rad_s, double period_s) noexcept;

/// The same without the acceleration from a velocity before: every velocity from which a stop within the position
/// limits is possible. Rest is always among them.
[[nodiscard]] JointBox stoppable_velocities(const JointLimits& limits, const JointVector& position_rad,
                                            double period_s) noexcept;

/// The part of the box within `limits`; for a joint where nothing is left, the point of the box nearest to them. A
/// limit that is NaN counts as 0.
[[nodiscard]] JointBox tightened(const JointBox& box, const JointBox& limits) noexcept;

/// The box' velocities nearest to `wanted`, joint by joint; what is not finite counts as 0.
[[nodiscard]] JointVector clamped(const JointVector& wanted_rad_s, const JointBox& box) noexcept;

/// The box' slowest velocities: what brakes most.
[[nodiscard]] JointVector braking(const JointBox& box) noexcept;

/// True when every bound is finite and lower <= upper.
[[nodiscard]] bool is_proper(const JointBox& box) noexcept;

/// True when standing still lies in the box.
[[nodiscard]] bool allows_rest(const JointBox& box) noexcept;

}  // namespace depthgrid::control
