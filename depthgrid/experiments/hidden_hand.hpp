// Figs. 9 and 13 of the letter: a hand right behind the robot, where the camera cannot see it.
#pragma once

#include <vector>

#include "depthgrid/experiments/deviation_table.hpp"
#include "depthgrid/experiments/experiment.hpp"

namespace depthgrid::experiments {

/// One row a method, number of cameras and handling of the robot's pixels, by the names in the report: "letter, 1
/// camera, robot = background" is the letter's Fig. 9, "letter, 2 cameras" its Fig. 13.
struct HiddenHandFigures {
  std::vector<LabelledDeviation> hand_near;  ///< instants with the person nearer than kHandNear to the arm
  std::vector<LabelledDeviation> otherwise;
  double person_to_arm_m = 0;  ///< smallest real distance of the whole motion
};

inline constexpr double kHandNear = 0.25;  ///< metres, from the person's surface to the arm's

/// The simulated measurement. Ideal sensors. Throws Error. `pictures` may be null.
[[nodiscard]] HiddenHandFigures measure_hidden_hand(const Options& options, ExperimentReport* pictures);

void run_hidden_hand(const Options& options, ExperimentReport& report);

}  // namespace depthgrid::experiments
