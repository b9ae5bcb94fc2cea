#include "lab/experiments/loop/avoidance_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <random>

#include "depthgrid/core/capsule.hpp"
#include "depthgrid/core/error.hpp"

namespace depthgrid::experiments {

using simulation::Box;

namespace {

constexpr double kLookStep = 0.05;  // seconds between the instants that are looked at

}  // namespace

simulation::PersonStage avoidance_stage(const Rig& rig) {
  simulation::PersonStage stage;
  stage.robot_world = {0, -0.40, 0.55};
  stage.camera_world = rig.cameras.front().T_world_camera.translation();
  return stage;
}

AvoidanceMotion nobody(double duration_s) { return {"nobody", {}, duration_s, 0}; }

AvoidanceMotion scripted_motion(simulation::Motion motion, const simulation::PersonStage& stage, std::uint64_t seed) {
  const auto script = std::make_shared<const simulation::PersonScript>(motion, stage, seed);
  AvoidanceMotion result;
  result.name = std::string(to_string(motion)) + " " + std::to_string(seed);
  result.at = [script](double time_s) {
    const simulation::PersonState state = script->at(time_s);
    MovingSolids solids;
    solids.capsules.assign(state.parts_world.begin(), state.parts_world.end());
    if (state.carried_world) {
      solids.boxes.push_back(*state.carried_world);
    }
    return solids;
  };
  result.duration_s = script->duration_s();
  result.v_max_m_s = stage.v_max_m_s;
  return result;
}

AvoidanceMotion recorded_motion(const simulation::MocapClip& clip, const std::string& name,
                                const simulation::PersonStage& stage, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const double turn_rad = 2 * std::numbers::pi * unit(generator);
  const double aside_rad = 2 * std::numbers::pi * unit(generator);
  const double aside_m = 0.2 + 0.6 * unit(generator);
  Pose T_world_floor = Pose::Identity();
  T_world_floor.linear() = Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Eigen::Vector3d place = stage.robot_world + aside_m * Eigen::Vector3d(std::cos(aside_rad), std::sin(aside_rad), 0);
  place.z() = stage.floor_m;
  Eigen::Vector3d middle = clip.middle_m();
  middle.z() = 0;
  T_world_floor.translation() = place - T_world_floor.linear() * middle;
  const auto kept = std::make_shared<const simulation::MocapClip>(clip);
  AvoidanceMotion result;
  result.name = name + " " + std::to_string(seed);
  result.at = [kept, T_world_floor](double time_s) { return MovingSolids{kept->at(time_s, T_world_floor), {}}; };
  result.duration_s = clip.duration_s();
  result.v_max_m_s = clip.v_max_m_s();
  return result;
}

AvoidanceMotion hand_against_plate(const Eigen::Vector3d& end_effector_world) {
  AvoidanceMotion result;
  result.name = "hand against plate";
  result.duration_s = 6;
  result.v_max_m_s = 0.5;
  result.hexagon_radius_m = 0.03;
  const Eigen::Vector3d to_plate = Eigen::Vector3d(1, 0, 1).normalized();
  Box plate;
  plate.T_world_box.linear() =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), to_plate).toRotationMatrix();
  plate.T_world_box.translation() = end_effector_world + 0.30 * to_plate;
  plate.half_size_m = {0.22, 0.40, 0.01};
  result.plates.push_back(plate);
  result.at = [end_effector_world, to_plate](double time_s) {
    // At 0.25 m/s from 1 s on, until the hand's surface is 0.1 m from where the end effector's point began.
    constexpr double kRadius = 0.045;
    const double away_m = std::max(0.1, 0.7 - 0.25 * std::max(0.0, time_s - 1.0)) + kRadius;
    const Eigen::Vector3d tip = end_effector_world - away_m * to_plate;
    const Eigen::Vector3d wrist = tip - 0.15 * Eigen::Vector3d(0.3, 0.5, 1).normalized();
    const Eigen::Vector3d elbow = wrist - 0.26 * Eigen::Vector3d(0.3, 0.5, 1).normalized();
    return MovingSolids{{{tip, wrist, kRadius}, {wrist, elbow, kRadius}}, {}};
  };
  return result;
}

AvoidanceMotion nearest_part(const AvoidanceMotion& motion, const Eigen::Vector3d& p_world, double duration_s) {
  constexpr double kShareBefore = 0.5;  // share of the part that comes before the nearest instant
  if (!motion.at || motion.duration_s <= duration_s) {
    return motion;
  }
  double nearest_m = std::numeric_limits<double>::infinity();
  double nearest_s = 0;
  for (int i = 0; i * kLookStep <= motion.duration_s; ++i) {
    const double t = i * kLookStep;
    for (const Capsule& capsule : motion.at(t).capsules) {
      const double distance_m = distance_to_axis(capsule, p_world) - capsule.radius_m;
      if (distance_m < nearest_m) {
        nearest_m = distance_m;
        nearest_s = t;
      }
    }
  }
  const double begin_s = std::clamp(nearest_s - kShareBefore * duration_s, 0.0, motion.duration_s - duration_s);
  AvoidanceMotion part = motion;
  part.at = [whole = motion.at, begin_s](double time_s) { return whole(begin_s + time_s); };
  part.duration_s = duration_s;
  return part;
}

bool meets_a_camera(const AvoidanceMotion& motion, const Rig& rig) {
  constexpr double kNear = 0.35;
  for (int i = 0; motion.at && i * kLookStep <= motion.duration_s; ++i) {
    for (const Capsule& capsule : motion.at(i * kLookStep).capsules) {
      for (const RigCamera& camera : rig.cameras) {
        if (distance_to_axis(capsule, camera.T_world_camera.translation()) < kNear + capsule.radius_m) {
          return true;
        }
      }
    }
  }
  return false;
}

AvoidanceMotion carrying_person(const Rig& rig, double duration_s, std::uint64_t first_seed) {
  constexpr std::uint64_t kTried = 100;
  const simulation::PersonStage stage = avoidance_stage(rig);
  for (std::uint64_t i = 0; i < kTried; ++i) {
    const AvoidanceMotion motion = scripted_motion(simulation::Motion::carry_box, stage, first_seed + i);
    if (!meets_a_camera(motion, rig)) {
      return nearest_part(motion, stage.robot_world, duration_s);
    }
  }
  fail("seed ", first_seed, ": each of ", kTried, " persons with a box walks through a camera; give another seed");
}

}  // namespace depthgrid::experiments
