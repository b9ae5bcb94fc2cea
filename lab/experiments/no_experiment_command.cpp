// Instead of experiment_command.cpp where the simulated workcell is not built.
#include <CLI/CLI.hpp>

#include "depthgrid/core/error.hpp"
#include "lab/experiments/experiment_command.hpp"

namespace depthgrid::program {

void add_experiment_command(CLI::App& app) {
  CLI::App* const command =
      app.add_subcommand("experiment", "experiments in the simulated workcell, which this build leaves out");
  command->allow_extras();
  command->callback([] {
    fail(
        "experiment needs the simulated workcell, which this build leaves out; ./scripts/test builds it, or configure "
        "with -DDEPTHGRID_BUILD_WORKCELL=ON (needs libembree-dev and libfcl-dev)");
  });
}

}  // namespace depthgrid::program
