// The robot cell that `depthgrid demo` shows.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "depthgrid/core/rig.hpp"
#include "depthgrid/simulation/figures.hpp"
#include "depthgrid/simulation/scene.hpp"

namespace depthgrid::simulation {

/// Two cameras 4 m apart face each other across a cell in a closed room. An arm (Body::robot) on a pedestal reaches
/// over a box on a table. A person stands between the first camera and the arm, more than a metre from the arm, so that
/// for this camera alone the space beside the arm lies in the person's shadow. World frame: z up, floor at z = 0,
/// metres.
struct DemoScene {
  Scene scene;
  Rig rig;  ///< the principal camera first; 640x480
  Arm arm;
  std::vector<Eigen::Vector3d> control_points_world;  ///< nine along the arm's axis, from above the shoulder to the tip
  double robot_padding_m = 0.02;
};

[[nodiscard]] DemoScene demo_scene();

}  // namespace depthgrid::simulation
