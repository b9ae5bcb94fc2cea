#include "depthgrid/experiments/shadow.hpp"

#include "depthgrid/experiments/experiment_report.hpp"

namespace depthgrid::experiments {

void run_shadow(const Options& options, ExperimentReport& report) {
  options.progress(1, 1);
  report.headline("Nothing is measured yet.");
}

}  // namespace depthgrid::experiments
