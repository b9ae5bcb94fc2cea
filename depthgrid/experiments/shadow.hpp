// Figs. 8 and 12 of the letter: a person between the camera and the robot, far from the robot.
#pragma once

#include "depthgrid/experiments/experiment.hpp"

namespace depthgrid::experiments {

void run_shadow(const Options& options, ExperimentReport& report);

}  // namespace depthgrid::experiments
