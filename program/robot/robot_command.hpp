// depthgrid robot: whether a URDF loads, what it holds and what it lacks.
#pragma once

#include <CLI/App.hpp>

namespace depthgrid::program {

/// Adds the subcommand; it runs when the command line is parsed. Throws UsageError or Error from there.
void add_robot_command(CLI::App& app);

}  // namespace depthgrid::program
