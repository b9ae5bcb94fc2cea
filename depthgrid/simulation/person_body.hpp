// A person whose limbs are turned by directions and angles: what an animation interpolates without stretching a bone.
#pragma once

#include <Eigen/Core>
#include <array>

#include "depthgrid/simulation/figures.hpp"
#include "depthgrid/simulation/shapes.hpp"

namespace depthgrid::simulation {

/// Unit vectors from joint to joint in the frame of the upper body: x forward, y to the left, z along the spine.
struct ArmDirections {
  Eigen::Vector3d upper_arm = -Eigen::Vector3d::UnitZ();
  Eigen::Vector3d forearm = -Eigen::Vector3d::UnitZ();
  Eigen::Vector3d hand = -Eigen::Vector3d::UnitZ();
};

struct LegAngles {
  double hip_rad = 0;   ///< the leg swings forward
  double knee_rad = 0;  ///< the shank bends back
};

/// The adult of figures.hpp, limb by limb. The lower foot stands on the floor.
struct PersonConfiguration {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< x, y of the middle between the feet, world frame
  double floor_m = 0;                                    ///< height of the floor, world frame
  double heading_rad = 0;                                ///< direction of view; 0 looks along +x
  double lean_rad = 0;                                   ///< forward bend at the hips
  std::array<ArmDirections, 2> arms{};                   ///< left, right
  std::array<LegAngles, 2> legs{};                       ///< left, right
};

/// The capsules in the order of person().
[[nodiscard]] std::array<Capsule, 17> person(const PersonConfiguration& configuration) noexcept;

/// The directions that bring a hand's tip to `target_world` where the arm is long enough, else point the arm at it:
/// with the elbow below, as person() for a PersonPose. `side` 0 is the left arm.
[[nodiscard]] ArmDirections arm_towards(const PersonConfiguration& configuration, std::size_t side,
                                        const Eigen::Vector3d& target_world) noexcept;

/// The middle of the hands' tips.
[[nodiscard]] Eigen::Vector3d between_hands(const std::array<Capsule, 17>& parts) noexcept;

/// From shoulder to fingertips, metres.
inline constexpr double kPersonArmLength = 0.30 + 0.26 + 0.15;

}  // namespace depthgrid::simulation
