// Task time of the loop with simulated real sensors beside that without avoidance and with ideal ones, over several
// seeds.
#pragma once

#include "lab/experiments/experiment.hpp"

namespace depthgrid::experiments {

/// --frames is the number of seeds, from --seed on; --sensor that of the cameras, else kinect_v1. Quick: shorter.
void run_real_task(const Options& options, ExperimentReport& report);

}  // namespace depthgrid::experiments
