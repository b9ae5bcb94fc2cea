#include "depthgrid/simulation/person_body.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "depthgrid/simulation/rotation_about.hpp"

namespace depthgrid::simulation {

namespace {

constexpr std::array<std::size_t, 2> kUpperArms{5, 8};  ///< of person(): upper arm, forearm and hand follow each other
constexpr std::array<std::size_t, 2> kThighs{11, 14};   ///< thigh, shank and foot follow each other
constexpr std::array<double, 3> kArmLengths{0.30, 0.26, 0.15};

Eigen::Matrix3d lower_body(const PersonConfiguration& c) { return about(c.heading_rad, Eigen::Vector3d::UnitZ()); }
Eigen::Matrix3d upper_body(const PersonConfiguration& c) {
  return lower_body(c) * about(c.lean_rad, Eigen::Vector3d::UnitY());
}

PersonPose pose_of(const PersonConfiguration& c) {
  PersonPose pose;
  pose.feet_world = {c.position_m.x(), c.position_m.y(), c.floor_m};
  pose.heading_rad = c.heading_rad;
  pose.lean_rad = c.lean_rad;
  return pose;
}

/// Turns both ends of a capsule about an axis through `joint`.
void turn(Capsule& part, const Eigen::Vector3d& joint, const Eigen::Matrix3d& rotation) {
  part.a = joint + rotation * (part.a - joint);
  part.b = joint + rotation * (part.b - joint);
}

}  // namespace

std::array<Capsule, 17> person(const PersonConfiguration& c) noexcept {
  std::array<Capsule, 17> parts = person(pose_of(c));
  const Eigen::Matrix3d upper = upper_body(c);
  const Eigen::Vector3d to_the_left = lower_body(c).col(1);
  for (std::size_t side = 0; side < 2; ++side) {
    Capsule* const arm = &parts[kUpperArms[side]];
    const ArmDirections& directions = c.arms[side];
    Eigen::Vector3d joint = arm[0].a;
    std::size_t i = 0;
    for (const Eigen::Vector3d* direction : {&directions.upper_arm, &directions.forearm, &directions.hand}) {
      arm[i].a = joint;
      joint += kArmLengths[i] * (upper * *direction);
      arm[i++].b = joint;
    }
    Capsule* const leg = &parts[kThighs[side]];
    // About the axis to the left a positive turn is backwards for what hangs down.
    const Eigen::Matrix3d hip = about(-c.legs[side].hip_rad, to_the_left);
    const Eigen::Vector3d hip_joint = leg[0].a;
    for (std::size_t bone = 0; bone < 3; ++bone) {
      turn(leg[bone], hip_joint, hip);
    }
    const Eigen::Matrix3d knee = about(c.legs[side].knee_rad, to_the_left);
    const Eigen::Vector3d knee_joint = leg[1].a;
    turn(leg[1], knee_joint, knee);
    turn(leg[2], knee_joint, knee);
  }
  double lowest_m = parts[kThighs[0] + 2].a.z();
  for (const std::size_t thigh : kThighs) {
    const Capsule& foot = parts[thigh + 2];
    lowest_m = std::min({lowest_m, foot.a.z(), foot.b.z()});
  }
  const double sunk_m = lowest_m - parts[kThighs[0] + 2].radius_m - c.floor_m;
  for (Capsule& part : parts) {
    part.a.z() -= sunk_m;
    part.b.z() -= sunk_m;
  }
  return parts;
}

ArmDirections arm_towards(const PersonConfiguration& c, std::size_t side,
                          const Eigen::Vector3d& target_world) noexcept {
  PersonPose pose = pose_of(c);
  pose.left_fingertips_world = pose.right_fingertips_world = target_world;
  const std::array<Capsule, 17> parts = person(pose);
  const Eigen::Matrix3d to_upper = upper_body(c).transpose();
  const auto direction = [&](std::size_t i) {
    const Capsule& bone = parts[kUpperArms[side] + i];
    return Eigen::Vector3d(to_upper * (bone.b - bone.a).normalized());
  };
  return {direction(0), direction(1), direction(2)};
}

Eigen::Vector3d between_hands(const std::array<Capsule, 17>& parts) noexcept {
  return 0.5 * (parts[kUpperArms[0] + 2].b + parts[kUpperArms[1] + 2].b);
}

}  // namespace depthgrid::simulation
