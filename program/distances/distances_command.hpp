// depthgrid distances: distances from control points to obstacles, frame by frame of a recording.
#pragma once

#include <CLI/App.hpp>

namespace depthgrid::program {

/// Adds the subcommand; it runs when the command line is parsed. Throws UsageError or Error from there.
void add_distances_command(CLI::App& app);

}  // namespace depthgrid::program
