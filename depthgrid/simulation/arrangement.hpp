// Where the cameras stand around the workcell, and the room with what always stands in it.
#pragma once

#include <Eigen/Core>
#include <string_view>

#include "depthgrid/core/rig.hpp"
#include "depthgrid/simulation/workcell.hpp"

namespace depthgrid::simulation {

/// World frame: the origin at the robot's base, z up, the floor at z = -0.5 m. The principal camera first.
struct Arrangement {
  Rig rig;
  Eigen::Vector3d workspace_low_world{-1.5, -1.5, -0.5};
  Eigen::Vector3d workspace_high_world{1.5, 1.5, 1.5};
  double d_min_m = 0.2882;  ///< depth in the principal camera at which the workspace begins
  double cell_m = 0.01;     ///< depth of a cell of the letter's grid
  int cells = 343;          ///< along each ray; d_min + 343 cm is where the workspace ends
};

/// The letter's arrangement: two Kinects of 640 x 480 pixels about 4 m apart, the principal one meeting the workspace
/// at 0.2882 m, 343 cells deep. The letter does not say where they stand; this is the point-symmetric solution of what
/// it says with level cameras: at (-2, -0.18, 0.5) and (2, 0.18, 0.5), 4.02 m apart, looking past the robot's axis at 9
/// degrees from x. Their view does not cover the corners of the workspace, and a Kinect measures from 0.5 m on.
///
/// `sensor` names the sensor model (depthgrid::sensor_model) whose margins and measurement rule the cameras get;
/// "ideal" is one of them.
[[nodiscard]] Arrangement letter_arrangement(std::string_view sensor = "kinect_v1");

/// The letter's principal camera alone, the letter's two, or from three on cameras evenly spaced on a circle of 2.4 m
/// around the robot, every other one higher, looking at a point 0.4 m above its base; the principal one is the
/// letter's. Throws Error unless 1 <= cameras <= 16.
[[nodiscard]] Arrangement arrangement(int cameras, std::string_view sensor = "kinect_v1");

/// Floor, four walls 3.2 m from the origin, the robot's pedestal, a table and a box on it. No robot and no person.
[[nodiscard]] Workcell empty_workcell();

}  // namespace depthgrid::simulation
