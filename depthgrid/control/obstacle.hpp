// An answer about one point of the robot, as the control laws take it.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "depthgrid/core/answer.hpp"

namespace depthgrid::control {

/// How near the nearest obstacle is and where it stands. Made from an answer, so that grid and search both serve.
struct Obstacle {
  /// Metres, >= 0; a lower bound. Nothing where it is unknown: laws then do as at distance 0.
  std::optional<double> distance_m;
  /// Unit vector from the robot's point to the nearest obstacle. Nothing where there is none to name: nothing within
  /// rho, contact, or an evaluation that stopped early.
  std::optional<Eigen::Vector3d> direction_world;
  /// Equation (11), as the evaluator gave it: a unit vector in the corrected form, shorter in the letter's; zero where
  /// it was not asked for.
  Eigen::Vector3d hybrid_direction_world = Eigen::Vector3d::Zero();
};

/// At the time that the evaluator was asked for.
[[nodiscard]] Obstacle obstacle_of(const Answer& answer) noexcept;

/// The obstacle of an answer that is `elapsed_s` old while obstacles move at most at `v_max_m_s`: the distance is
/// lower_bound_after() of the answer. With elapsed_s = 0 and v_max_m_s = 0 it is the answer's own, as in the letter.
[[nodiscard]] Obstacle obstacle_of(const Proximity& answer,
                                   const Eigen::Vector3d& hybrid_direction_world = Eigen::Vector3d::Zero(),
                                   double elapsed_s = 0, double v_max_m_s = 0) noexcept;

/// `direction` scaled to length 1; nothing when it is zero or not finite.
[[nodiscard]] std::optional<Eigen::Vector3d> unit_vector(const Eigen::Vector3d& direction) noexcept;

}  // namespace depthgrid::control
