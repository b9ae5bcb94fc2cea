#include "depthgrid/simulation/figures.hpp"

#include <algorithm>
#include <cmath>

#include "depthgrid/simulation/rotation_about.hpp"

namespace depthgrid::simulation {

namespace {

constexpr double kUpperArm = 0.30;
constexpr double kForearm = 0.26;
constexpr double kHand = 0.15;

struct Reach {
  Eigen::Vector3d elbow;
  Eigen::Vector3d wrist;
  Eigen::Vector3d fingertips;
};

/// A two-link arm and a hand in line with shoulder and target; the elbow hangs downwards.
Reach reach(const Eigen::Vector3d& shoulder, const Eigen::Vector3d& target) {
  const Eigen::Vector3d to_target = target - shoulder;
  const double wanted_m = to_target.norm();
  const Eigen::Vector3d along =
      wanted_m > 1e-9 ? Eigen::Vector3d(to_target / wanted_m) : Eigen::Vector3d(-Eigen::Vector3d::UnitZ());
  const double to_wrist_m = std::clamp(wanted_m - kHand, 0.1, kUpperArm + kForearm - 1e-6);
  // Height of the elbow over the line from shoulder to wrist, by the law of cosines.
  const double foot_m = (to_wrist_m * to_wrist_m + kUpperArm * kUpperArm - kForearm * kForearm) / (2 * to_wrist_m);
  const double height_m = std::sqrt(std::max(0.0, kUpperArm * kUpperArm - foot_m * foot_m));
  Eigen::Vector3d down = -Eigen::Vector3d::UnitZ() + along.z() * along;
  down = down.norm() > 1e-6 ? Eigen::Vector3d(down.normalized()) : along.unitOrthogonal();
  Reach result;
  result.elbow = shoulder + foot_m * along + height_m * down;
  result.wrist = shoulder + to_wrist_m * along;
  result.fingertips = result.wrist + kHand * along;
  return result;
}

}  // namespace

std::array<Capsule, 17> person(const PersonPose& pose) noexcept {
  const Eigen::Matrix3d heading = about(pose.heading_rad, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d hips(0, 0, 0.92);
  const Eigen::Matrix3d lean = about(pose.lean_rad, Eigen::Vector3d::UnitY());
  // Body frame: x forward, y to the left, z up, origin between the feet.
  const auto lower = [&](double x, double y, double z) {
    return Eigen::Vector3d(pose.feet_world + heading * Eigen::Vector3d(x, y, z));
  };
  const auto upper = [&](double x, double y, double z) {
    return Eigen::Vector3d(pose.feet_world + heading * (hips + lean * (Eigen::Vector3d(x, y, z) - hips)));
  };
  const Eigen::Vector3d left_shoulder = upper(0, 0.19, 1.42);
  const Eigen::Vector3d right_shoulder = upper(0, -0.19, 1.42);
  const Reach left = reach(left_shoulder, pose.left_fingertips_world);
  const Reach right = reach(right_shoulder, pose.right_fingertips_world);
  return {{
      {lower(0, 0.08, 0.92), lower(0, -0.08, 0.92), 0.12},
      {upper(0, 0, 0.98), upper(0, 0, 1.15), 0.13},
      {upper(0, 0.09, 1.31), upper(0, -0.09, 1.31), 0.14},
      {upper(0, 0, 1.42), upper(0.01, 0, 1.52), 0.055},
      {upper(0.02, 0, 1.60), upper(0.02, 0, 1.65), 0.10},
      {left_shoulder, left.elbow, 0.05},
      {left.elbow, left.wrist, 0.042},
      {left.wrist, left.fingertips, 0.035},
      {right_shoulder, right.elbow, 0.05},
      {right.elbow, right.wrist, 0.042},
      {right.wrist, right.fingertips, 0.035},
      {lower(0, 0.10, 0.90), lower(0, 0.11, 0.49), 0.075},
      {lower(0, 0.11, 0.49), lower(-0.01, 0.12, 0.08), 0.055},
      {lower(-0.03, 0.12, 0.045), lower(0.16, 0.13, 0.045), 0.045},
      {lower(0, -0.10, 0.90), lower(0, -0.11, 0.49), 0.075},
      {lower(0, -0.11, 0.49), lower(-0.01, -0.12, 0.08), 0.055},
      {lower(-0.03, -0.12, 0.045), lower(0.16, -0.13, 0.045), 0.045},
  }};
}

Arm arm(const Pose& T_world_base, const ArmAngles& angles) noexcept {
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  // The last joint turns about the hand's own axis and moves nothing here.
  const Eigen::Matrix3d upper_arm = T_world_base.linear() * about(angles[0], z) * about(-angles[1], y);
  const Eigen::Matrix3d forearm = upper_arm * about(angles[2], z) * about(angles[3], y);
  const Eigen::Matrix3d hand = forearm * about(angles[4], z) * about(-angles[5], y);
  Arm result;
  auto& p = result.axis_world;
  p[0] = T_world_base.translation();
  p[1] = p[0] + T_world_base.linear() * (0.3105 * z);
  p[2] = p[1] + upper_arm * (0.4 * z);
  p[3] = p[2] + forearm * (0.39 * z);
  p[4] = p[3] + hand * (0.138 * z);
  const auto between = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b, double share) {
    return Eigen::Vector3d(a + share * (b - a));
  };
  result.links = {{
      {p[0], between(p[0], p[1], 0.5), 0.09},
      {between(p[0], p[1], 0.5), p[1], 0.08},
      {p[1], between(p[1], p[2], 0.5), 0.075},
      {between(p[1], p[2], 0.5), p[2], 0.07},
      {p[2], between(p[2], p[3], 0.5), 0.066},
      {between(p[2], p[3], 0.5), p[3], 0.063},
      {p[3], between(p[3], p[4], 0.078 / 0.138), 0.04},
  }};
  return result;
}

Eigen::Vector3d point_on_axis(const Arm& arm, double length_m) noexcept {
  for (std::size_t i = 0; i + 1 < arm.axis_world.size(); ++i) {
    const Eigen::Vector3d link = arm.axis_world[i + 1] - arm.axis_world[i];
    const double link_m = link.norm();
    if (length_m <= link_m) {
      return arm.axis_world[i] + std::max(0.0, length_m) / link_m * link;
    }
    length_m -= link_m;
  }
  return arm.axis_world.back();
}

}  // namespace depthgrid::simulation
