// Control points and link capsules of the body as limits of joint velocities, through J^T n.
//
// n: unit vector from the body's point to the obstacle, J: Jacobian of that point. s_i = (J^T n)_i is exactly the speed
// of approach that each rad/s of joint i causes. Three laws, with f the risk, V_i the velocity limit of joint i, and
// v_allowed(D) = gain max(0, D - stop):
//
// clang-format off
//   risk            s_i > 0: upper_i = V_i (1 - f(D)),  s_i < 0: lower_i = -V_i (1 - f(D));  after Flacco et al., 2012
//   approach_speed  the same with a factor k instead of 1 - f, so that sum_i |s_i| V_i k <= v_allowed(D): whatever
//                   motion within the limits follows, the point approaches by no more than v_allowed(D)
//   approach_row    n . J qd <= v_allowed(D) itself, for the optimal saturation: joints may trade approach against
//                   retreat
// clang-format on
//
// The most restrictive limit of all points holds. Where the direction is unknown the limits hold for both signs of
// every joint that moves the point (approach_row: those of approach_speed).
#pragma once

#include <cstdint>
#include <optional>

#include "depthgrid/control/approach_limit.hpp"
#include "depthgrid/control/joint_box.hpp"
#include "depthgrid/control/obstacle.hpp"
#include "depthgrid/core/repulsion_law.hpp"

namespace depthgrid::control {

enum class BodyLaw : std::uint8_t { risk, approach_speed, approach_row };

struct BodySettings {
  BodyLaw law = BodyLaw::risk;
  double rho_m = kDefaultRho;    ///< where limits begin
  double alpha = kDefaultAlpha;  ///< steepness of the risk
  double gain_per_s = 2.0;       ///< approach laws: allowed speed for each metre of distance beyond `stop_m`
  double stop_m = 0.05;          ///< approach laws: nearer than this no approach is allowed
};

/// Throws Error with value and rule.
void validate(const BodySettings& settings);

/// -V_i <= velocity <= V_i: what the limits begin with.
[[nodiscard]] JointBox velocity_limits(const JointLimits& limits) noexcept;

/// Tightens `box` by one point of the body: `jacobian` of the point that the obstacle is nearest to. Always leaves rest
/// in the box if it was. A Jacobian that is not finite or does not have the box' size closes all joints at 0.
void limit_by_obstacle(JointBox& box, const JointVector& velocity_rad_s, const PointJacobian& jacobian,
                       const Obstacle& obstacle, const BodySettings& settings) noexcept;

/// The law approach_row for one point: nothing beyond rho, and where the direction is unknown or the Jacobian is not
/// finite; limit_by_obstacle() has a limit for these.
[[nodiscard]] std::optional<ApproachLimit> approach_limit(const PointJacobian& jacobian, const Obstacle& obstacle,
                                                          const BodySettings& settings) noexcept;

/// The fastest approach of a point towards n that a box allows, m/s; negative when the box enforces retreat.
[[nodiscard]] double fastest_approach(const JointBox& box, const PointJacobian& jacobian,
                                      const Eigen::Vector3d& n) noexcept;

}  // namespace depthgrid::control
