#include "depthgrid/simulation/person_script.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "depthgrid/core/error.hpp"
#include "depthgrid/simulation/person_motions.hpp"

namespace depthgrid::simulation {

namespace {

constexpr double kStride = 1.2;      ///< both feet once [m]
constexpr double kLegLength = 0.82;  ///< hip to ankle [m]
constexpr double kKnee = 0.5;        ///< of the leg in the air [rad]
constexpr double kRamp = 0.3;        ///< the first and last step are short [m]

const Eigen::Vector3d kCarriedHalfSize(0.15, 0.18, 0.12);

/// From rest to rest, and smooth: the polynomial of minimum jerk.
double eased(double share) { return share * share * share * (10 + share * (-15 + 6 * share)); }

Eigen::Vector3d turned(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double share) {
  const Eigen::Quaterniond all = Eigen::Quaterniond::FromTwoVectors(from, to);
  return (Eigen::Quaterniond::Identity().slerp(share, all) * from).normalized();
}

ArmDirections turned(const ArmDirections& from, const ArmDirections& to, double share) {
  return {turned(from.upper_arm, to.upper_arm, share), turned(from.forearm, to.forearm, share),
          turned(from.hand, to.hand, share)};
}

/// Legs after `walked_m` of `way_m`: the foot on the floor hardly slips, the other one is lifted.
std::array<LegAngles, 2> gait(double walked_m, double way_m) {
  const double ramp = std::clamp(std::min(walked_m, way_m - walked_m) / kRamp, 0.0, 1.0);
  const double amplitude_rad = ramp * kStride / (2 * std::numbers::pi * kLegLength);
  std::array<LegAngles, 2> legs;
  for (std::size_t side = 0; side < 2; ++side) {
    const double phase = 2 * std::numbers::pi * walked_m / kStride + (side == 0 ? 0 : std::numbers::pi);
    legs[side].hip_rad = amplitude_rad * std::sin(phase);
    const double forward = std::max(0.0, std::cos(phase));  // this leg swings forward
    legs[side].knee_rad = ramp * kKnee * forward * forward;
  }
  return legs;
}

double heading_difference(double from_rad, double to_rad) {
  return std::remainder(to_rad - from_rad, 2 * std::numbers::pi);
}

/// How far the fastest point of the person has come.
double largest_move_m(const PersonState& before, const PersonState& after) {
  double largest_m = 0;
  for (std::size_t i = 0; i < before.parts_world.size(); ++i) {
    largest_m = std::max({largest_m, (after.parts_world[i].a - before.parts_world[i].a).norm(),
                          (after.parts_world[i].b - before.parts_world[i].b).norm()});
  }
  if (before.carried_world && after.carried_world) {
    const Eigen::Vector3d& half_m = before.carried_world->half_size_m;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d sign((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1, (corner & 4) != 0 ? 1 : -1);
      const Eigen::Vector3d p = sign.cwiseProduct(half_m);
      largest_m =
          std::max(largest_m, (after.carried_world->T_world_box * p - before.carried_world->T_world_box * p).norm());
    }
  }
  return largest_m;
}

void validate(const PersonStage& stage) {
  if (!stage.robot_world.allFinite() || !stage.camera_world.allFinite() || !std::isfinite(stage.floor_m)) {
    fail("stage of the person: robot, camera and floor must be finite");
  }
  if (!(std::isfinite(stage.v_max_m_s) && stage.v_max_m_s > 0)) {
    fail("stage of the person: v_max is ", stage.v_max_m_s, " m/s, must be a positive finite number");
  }
  if (!(std::isfinite(stage.entrance_m) && stage.entrance_m >= 1.5)) {
    fail("stage of the person: the entrance is ", stage.entrance_m, " m from the robot, must be at least 1.5");
  }
}

}  // namespace

std::span<const Motion> motions() noexcept {
  static constexpr std::array<Motion, 5> kAll{Motion::walk_in, Motion::reach, Motion::carry_box,
                                              Motion::hand_behind_robot, Motion::arm_between};
  return kAll;
}

std::string_view to_string(Motion motion) noexcept {
  switch (motion) {
    case Motion::walk_in:
      return "walk_in";
    case Motion::reach:
      return "reach";
    case Motion::carry_box:
      return "carry_box";
    case Motion::hand_behind_robot:
      return "hand_behind_robot";
    case Motion::arm_between:
      return "arm_between";
  }
  return "unknown";
}

PersonScript::PersonScript(Motion motion, const PersonStage& stage, std::uint64_t seed)
    : motion_(motion), v_max_m_s_(stage.v_max_m_s) {
  validate(stage);
  const PersonPlan plan = plan_motion(motion, stage, seed);
  duration_s_ = plan.keys.front().hold_s;
  for (std::size_t i = 0; i + 1 < plan.keys.size(); ++i) {
    Segment segment{plan.keys[i].configuration, plan.keys[i + 1].configuration, duration_s_, 0};
    segment.moving_s = least_duration_s(segment, plan.pace * v_max_m_s_);
    duration_s_ += segment.moving_s + plan.keys[i + 1].hold_s;
    segments_.push_back(segment);
  }
}

PersonConfiguration PersonScript::between(const Segment& segment, double share) noexcept {
  const PersonConfiguration& from = segment.from;
  const PersonConfiguration& to = segment.to;
  PersonConfiguration result = from;
  result.position_m += share * (to.position_m - from.position_m);
  result.heading_rad += share * heading_difference(from.heading_rad, to.heading_rad);
  result.lean_rad += share * (to.lean_rad - from.lean_rad);
  for (std::size_t side = 0; side < 2; ++side) {
    result.arms[side] = turned(from.arms[side], to.arms[side], share);
  }
  const double way_m = (to.position_m - from.position_m).norm();
  result.legs = gait(share * way_m, way_m);
  return result;
}

PersonState PersonScript::state(const PersonConfiguration& configuration) const noexcept {
  PersonState result{person(configuration), std::nullopt};
  if (motion_ == Motion::carry_box) {
    Box box;
    box.half_size_m = kCarriedHalfSize;
    box.T_world_box.linear() =
        Eigen::AngleAxisd(configuration.heading_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    box.T_world_box.translation() = between_hands(result.parts_world);
    result.carried_world = box;
  }
  return result;
}

double PersonScript::least_duration_s(const Segment& segment, double speed_m_s) const noexcept {
  constexpr int kSteps = 400;
  constexpr double kBetweenSteps = 1.03;  // the speed may be higher between two samples than their difference tells
  double largest_m = 0;
  PersonState before = state(between(segment, 0));
  for (int i = 1; i <= kSteps; ++i) {
    const PersonState after = state(between(segment, eased(static_cast<double>(i) / kSteps)));
    largest_m = std::max(largest_m, largest_move_m(before, after));
    before = after;
  }
  return kBetweenSteps * largest_m * kSteps / speed_m_s;
}

PersonState PersonScript::at(double time_s) const noexcept {
  const Segment* current = &segments_.front();
  for (const Segment& segment : segments_) {
    if (segment.start_s <= time_s) {
      current = &segment;
    }
  }
  const double share = current->moving_s > 0 ? (time_s - current->start_s) / current->moving_s : 1.0;
  return state(between(*current, eased(std::clamp(share, 0.0, 1.0))));
}

}  // namespace depthgrid::simulation
