// An answer about one point of the robot, as the control laws take it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
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
  /// False: it limits motion and does not push, now or by memory; it then has no direction. For space that is unknown
  /// because a camera is lost: nobody says that something comes from there.
  bool pushes = true;
};

/// What becomes of the layer around the robot in which nothing is seen (Answer::blind_m).
enum class BlindLayer : std::uint8_t {
  kept_clear,  ///< distances count from its surface, so that it is never moved over what has been seen; unknown where
               ///< its thickness is
  ignored,     ///< distances count from the robot, as if everything up to it were seen: the letter's loop
};

/// At the time that the evaluator was asked for.
[[nodiscard]] Obstacle obstacle_of(const Answer& answer, BlindLayer layer) noexcept;

/// The obstacle of an answer that is `elapsed_s` old while obstacles move at most at `v_max_m_s`: the distance is
/// lower_bound_after() of the answer. With elapsed_s = 0 and v_max_m_s = 0 it is the answer's own, as in the letter.
/// A Proximity says nothing of the blind layer, so that one is ignored.
[[nodiscard]] Obstacle obstacle_of(const Proximity& answer,
                                   const Eigen::Vector3d& hybrid_direction_world = Eigen::Vector3d::Zero(),
                                   double elapsed_s = 0, double v_max_m_s = 0) noexcept;

/// `direction` scaled to length 1; nothing when it is zero or not finite.
[[nodiscard]] std::optional<Eigen::Vector3d> unit_vector(const Eigen::Vector3d& direction) noexcept;

}  // namespace depthgrid::control
