// The whole loop on the real clock: how long a cycle takes, and how many are in time while frames arrive.
#pragma once

#include "lab/experiments/experiment.hpp"

namespace depthgrid::experiments {

class ExperimentReport;

/// --frames is the number of frames of the recording that is played there and back; the paced run lasts a minute
/// (quick: ten seconds).
void run_timing(const Options& options, ExperimentReport& report);

}  // namespace depthgrid::experiments
