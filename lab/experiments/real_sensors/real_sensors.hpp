// What simulated real sensors leave of distances, without and with what is declared of them, over several seeds.
#pragma once

#include "lab/experiments/experiment.hpp"

namespace depthgrid::experiments {

/// --frames is the number of seeds, from --seed on; --sensor one sensor's rows only. Quick: one seed, shorter scenes.
void run_real_sensors(const Options& options, ExperimentReport& report);

}  // namespace depthgrid::experiments
