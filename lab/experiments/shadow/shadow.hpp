// Figs. 8 and 12 of the letter: a person between the camera and the robot, far from the robot.
#pragma once

#include "lab/experiments/experiment.hpp"
#include "lab/experiments/stage/instant_groups.hpp"

namespace depthgrid::experiments {

/// The simulated measurement; chosen are the instants in which the person hides a control point from camera 1. One row
/// a method, number of cameras and handling of the robot's pixels, by the names in the report: "letter, 1 camera, robot
/// = background" is the letter's Fig. 8, the same with 2 cameras its Fig. 12. Ideal sensors. Throws Error. `pictures`
/// may be null.
[[nodiscard]] GroupedDeviations measure_shadow(const Options& options, ExperimentReport* pictures);

void run_shadow(const Options& options, ExperimentReport& report);

}  // namespace depthgrid::experiments
