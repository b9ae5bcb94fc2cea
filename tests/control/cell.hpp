// An arm, its controller and one moving sphere with exact distances: a cell without cameras.
#pragma once

#include <algorithm>
#include <vector>

#include "control/lwr.hpp"
#include "depthgrid/control/controller.hpp"
#include "depthgrid/control/polygon_task.hpp"
#include "depthgrid/control/simulated_arm.hpp"

namespace depthgrid::control::test {

struct Sphere {
  Eigen::Vector3d centre_world;
  double radius_m;
};

inline constexpr double kRho = 0.4;

/// What an evaluator would answer for a point.
inline Proximity sphere_proximity(const Eigen::Vector3d& p_world, const Sphere& sphere) {
  Proximity proximity;
  const Eigen::Vector3d way = sphere.centre_world - p_world;
  const double distance = std::max(0.0, way.norm() - sphere.radius_m);
  proximity.state = distance < kRho ? ProximityState::measured : ProximityState::beyond_rho;
  proximity.distance_m = std::min(distance, kRho);
  if (distance < kRho) {
    const Eigen::Vector3d direction = distance > 0 ? way.normalized() : Eigen::Vector3d(Eigen::Vector3d::Zero());
    proximity.direction_world = direction;
  }
  return proximity;
}

inline ControllerSettings lwr_settings() {
  ControllerSettings settings;
  settings.limits = lwr_limits();
  settings.posture_rad = lwr_bent();
  return settings;
}

/// The letter's task around the flange of the bent arm, in the plane that it faces.
inline PolygonSettings lwr_hexagon() {
  return {.vertices_world = vertical_hexagon(lwr_flange(lwr_bent()).p_world, 0.2, Eigen::Vector3d::UnitX())};
}

/// One period: state, distances, command, motion.
class Cell {
 public:
  Cell(const ControllerSettings& settings, int latency)
      : controller(settings), task(lwr_hexagon()), arm(settings.limits, settings.period_s, lwr_bent(), latency) {
    controller.start(lwr_bent());
  }

  const CycleOutput& period(const Sphere& sphere) {
    const JointVector& q = controller.last().position_rad;
    const LwrPoint tip = lwr_flange(q);
    const std::vector<LwrPoint> body = lwr_body(q);
    std::vector<BodyPoint> points;
    nearest_m = kRho;
    for (const LwrPoint& point : body) {
      const Proximity proximity = sphere_proximity(point.p_world, sphere);
      nearest_m = std::min(nearest_m, proximity.distance_m);
      points.push_back({point.jacobian, obstacle_of(proximity)});
    }
    const Proximity at_tip = sphere_proximity(tip.p_world, sphere);
    tip_m = at_tip.distance_m;
    tip_world = tip.p_world;
    desired = task.desired_velocity(tip.p_world);
    near_points = points;
    output = controller.cycle({.task = {tip.jacobian, desired},
                               .end_effector = obstacle_of(at_tip, at_tip.direction_world),
                               .body = points,
                               .further_tasks = {}});
    taken = arm.write(output.command);
    arm.advance();
    return output;
  }

  Controller controller;
  PolygonTask task;
  SimulatedArm arm;
  CycleOutput output;
  Eigen::Vector3d tip_world, desired;
  std::vector<BodyPoint> near_points;
  double nearest_m = kRho, tip_m = kRho;
  bool taken = true;
};

}  // namespace depthgrid::control::test
