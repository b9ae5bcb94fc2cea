// Fig. 15 of the letter: the end effector goes round a hexagon, a person comes in and carries a box.
#pragma once

#include "lab/experiments/experiment.hpp"

namespace depthgrid::experiments {

class ExperimentReport;

/// --frames: of each run, at 30 Hz.
void run_avoidance_experiment(const Options& options, ExperimentReport& report);

}  // namespace depthgrid::experiments
