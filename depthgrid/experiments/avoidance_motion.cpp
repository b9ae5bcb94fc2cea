#include "depthgrid/experiments/avoidance_motion.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "depthgrid/robot/capsule.hpp"

namespace depthgrid::experiments {

using simulation::Box;
using simulation::Capsule;

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

AvoidanceMotion hand_above_plate(const Eigen::Vector3d& end_effector_world) {
  AvoidanceMotion result;
  result.name = "hand above a plate";
  result.duration_s = 6;
  result.v_max_m_s = 0.5;
  Box plate;
  plate.T_world_box.translation() = end_effector_world - Eigen::Vector3d(0, 0, 0.33);
  plate.half_size_m = {0.6, 0.45, 0.01};
  result.plates.push_back(plate);
  const Eigen::Vector3d start = end_effector_world + Eigen::Vector3d(0, -0.05, 0.75);
  result.at = [start](double time_s) {
    // Down at 0.25 m/s from 1 s on, to 0.12 m above where the end effector began, and stays there.
    const double down_m = std::clamp(0.25 * (time_s - 1.0), 0.0, 0.58);
    const Eigen::Vector3d tip = start - Eigen::Vector3d(0, 0, down_m);
    const Eigen::Vector3d wrist = tip + Eigen::Vector3d(0, -0.08, 0.12);
    const Eigen::Vector3d elbow = wrist + Eigen::Vector3d(0, -0.17, 0.20);
    MovingSolids solids;
    solids.capsules = {{tip, wrist, 0.045}, {wrist, elbow, 0.045}};
    return solids;
  };
  return result;
}

bool meets_a_camera(const AvoidanceMotion& motion, const Rig& rig) {
  constexpr double kStep = 0.05;
  constexpr double kNear = 0.35;
  for (double t = 0; motion.at && t <= motion.duration_s; t += kStep) {
    for (const Capsule& capsule : motion.at(t).capsules) {
      for (const RigCamera& camera : rig.cameras) {
        const robot::Capsule axis{capsule.a_world, capsule.b_world, capsule.radius_m};
        if (robot::distance_to_axis(axis, camera.T_world_camera.translation()) < kNear + capsule.radius_m) {
          return true;
        }
      }
    }
  }
  return false;
}

}  // namespace depthgrid::experiments
