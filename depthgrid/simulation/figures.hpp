// Things that move in a robot cell, built of capsules: a person and a seven-joint arm. Metres, radians, world frame.
#pragma once

#include <Eigen/Core>
#include <array>

#include "depthgrid/core/pose.hpp"
#include "depthgrid/simulation/shapes.hpp"

namespace depthgrid::simulation {

/// A standing adult, 1.75 m tall, z up, feet at the height of `feet_world`.
struct PersonPose {
  Eigen::Vector3d feet_world = Eigen::Vector3d::Zero();  ///< midway between the feet
  double heading_rad = 0;                                ///< direction of view in the x-y plane; 0 looks along +x
  double lean_rad = 0;                                   ///< forward bend at the hips
  Eigen::Vector3d left_fingertips_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d right_fingertips_world = Eigen::Vector3d::Zero();
};

/// Pelvis, abdomen, chest, neck, head; then left and right: upper arm, forearm, hand; then left and right: thigh,
/// shank, foot. Each hand's tip lies at its target where the arm is long enough, else the arm points straight at it.
/// The tip is the end of the hand's axis; the hand reaches one capsule radius farther.
[[nodiscard]] std::array<Capsule, 17> person(const PersonPose& pose) noexcept;

/// Joint angles of a seven-joint arm whose axes are, from the base, +z -y +z +y +z -y +z at zero angles.
using ArmAngles = std::array<double, 7>;

/// The axis of an arm with the proportions of a light-weight arm (shoulder at 0.3105 m, upper arm 0.4 m, forearm 0.39
/// m, hand 0.138 m up to the tool's tip) and the capsules around it.
struct Arm {
  /// Base, shoulder, elbow, wrist, tool tip.
  std::array<Eigen::Vector3d, 5> axis_world;
  /// From the base: two each for column, upper arm and forearm, one for the hand. The tool tip is left bare: it lies
  /// 0.02 m beyond the hand's capsule.
  std::array<Capsule, 7> links;
};
[[nodiscard]] Arm arm(const Pose& T_world_base, const ArmAngles& angles) noexcept;

/// The point of the arm's axis at `length_m` from the base, measured along the axis and clamped to its ends.
[[nodiscard]] Eigen::Vector3d point_on_axis(const Arm& arm, double length_m) noexcept;

/// Length of the axis from base to tool tip, metres.
inline constexpr double kArmLength = 0.3105 + 0.4 + 0.39 + 0.138;

}  // namespace depthgrid::simulation
