// depthgrid experiment: measured experiments in the simulated workcell.
#pragma once

#include <CLI/App.hpp>

namespace depthgrid::program {

/// Adds the subcommand; it runs when the command line is parsed. In a build without the simulated workcell it says so.
void add_experiment_command(CLI::App& app);

}  // namespace depthgrid::program
