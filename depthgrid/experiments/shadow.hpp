// Figs. 8 and 12 of the letter: a person between the camera and the robot, far from the robot.
#pragma once

#include <vector>

#include "depthgrid/experiments/deviation_table.hpp"
#include "depthgrid/experiments/experiment.hpp"

namespace depthgrid::experiments {

/// One row a method, number of cameras and handling of the robot's pixels, by the names in the report: "letter, 1
/// camera, robot = background" is the letter's Fig. 8, the same with 2 cameras its Fig. 12.
struct ShadowFigures {
  std::vector<LabelledDeviation> in_shadow;  ///< instants in which the person hides a control point from camera 1
  std::vector<LabelledDeviation> otherwise;
  double person_to_arm_m = 0;  ///< smallest real distance of the whole motion
};

/// The simulated measurement. Ideal sensors. Throws Error. `pictures` may be null.
[[nodiscard]] ShadowFigures measure_shadow(const Options& options, ExperimentReport* pictures);

void run_shadow(const Options& options, ExperimentReport& report);

}  // namespace depthgrid::experiments
