// Two runs of the same arm with the same noise side by side, as the frames of a film: without and with what is
// declared.
#pragma once

#include "lab/experiments/experiment.hpp"
#include "lab/experiments/experiment_report.hpp"

namespace depthgrid::experiments {

/// Frames frame-0001.png and so on, ten a second, which scripts/film makes a film of; and what both runs reached.
void run_film(const Options& options, ExperimentReport& report);

}  // namespace depthgrid::experiments
