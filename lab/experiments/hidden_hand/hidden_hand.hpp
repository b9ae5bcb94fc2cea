// Figs. 9 and 13 of the letter: a hand right behind the robot, where the camera cannot see it.
#pragma once

#include "lab/experiments/experiment.hpp"
#include "lab/experiments/stage/instant_groups.hpp"

namespace depthgrid::experiments {

inline constexpr double kHandNear = 0.25;  ///< metres, from the person's surface to the arm's

/// The simulated measurement; chosen are the instants with the person nearer than kHandNear to the arm. One row a
/// method, number of cameras and handling of the robot's pixels, by the names in the report: "letter, 1 camera, robot =
/// background" is the letter's Fig. 9, "letter, 2 cameras" its Fig. 13. Ideal sensors. Throws Error. `pictures` may be
/// null.
[[nodiscard]] GroupedDeviations measure_hidden_hand(const Options& options, ExperimentReport* pictures);

void run_hidden_hand(const Options& options, ExperimentReport& report);

}  // namespace depthgrid::experiments
