// One camera before a wall, and the LWR 4+ somewhere else: what the loop needs, without a simulated cell.
#pragma once

#include <numbers>
#include <vector>

#include "depthgrid/avoidance/avoidance_loop.hpp"
#include "depthgrid/control/polygon_task.hpp"
#include "depthgrid/control/simulated_arm.hpp"
#include "depthgrid/core/sensor_models.hpp"
#include "depthgrid/robot/kuka_lwr4.hpp"
#include "depthgrid/views/settings.hpp"

namespace depthgrid::avoidance::test {

/// Looks along +y at the arm's work place from y = -2.
inline Rig one_camera() {
  Rig rig{.name = "one", .cameras = std::vector<RigCamera>(1), .T_floor_world = {}};
  rig.cameras[0].id = "front";
  rig.cameras[0].intrinsics = from_opencv(64, 48, 52.5, 52.5, 31.5, 23.5);
  rig.cameras[0].T_world_camera = look_at({0, -2, 0.6}, {0, 0, 0.6});
  rig.cameras[0].margins = sensor_margins(sensor_model("ideal"), rig.cameras[0].intrinsics, 0.001);
  rig.cameras[0].margins->smallest_obstacle_m = 0;
  return rig;
}

inline views::Settings search_settings(const Rig& rig) {
  views::Settings settings;
  settings.space = views::BoxSpace{{-1.5, -1.5, -0.5}, {1.5, 1.5, 1.5}};
  settings.policies = {.unobserved = views::Policy::obstacle,
                       .outside = views::Policy::obstacle,
                       .robot_pockets = views::Policy::obstacle};
  settings.margins = camera_margins(rig);
  settings.v_max_m_s = 2;
  settings.rho_m = 0.5;
  return settings;
}

inline control::JointVector bent() {
  control::JointVector q(7);
  q << std::numbers::pi / 2, 0.1, 0.0, -1.55, 0.0, 1.2, 0.0;
  return q;
}

inline LoopSettings loop_settings(std::vector<robot::LinkCapsule> parts) {
  LoopSettings settings;
  control::JointLimits& limits = settings.controller.limits;
  limits.highest_rad = control::JointVector::Constant(7, 2.9);
  limits.lowest_rad = -limits.highest_rad;
  limits.velocity_rad_s = control::JointVector::Constant(7, 1.9);
  limits.acceleration_rad_s2 = control::JointVector::Constant(7, 5.2);
  settings.controller.posture_rad = bent();
  settings.parts = std::move(parts);
  return settings;
}

/// The flange of the bent arm.
inline Pose flange(const robot::RobotModel& model) {
  const control::JointVector q = bent();
  return robot::PlacedRobot{model}.link_poses({q.data(), 7})[model.link_index("lwr_7_link")];
}

inline control::PolygonSettings hexagon(const robot::RobotModel& model) {
  return {.vertices_world = control::vertical_hexagon(flange(model).translation(), 0.2, Eigen::Vector3d::UnitY())};
}

}  // namespace depthgrid::avoidance::test
