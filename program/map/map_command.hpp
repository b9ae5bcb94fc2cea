// depthgrid map: builds depth grid maps from a rig's calibration and says what a map file holds.
#pragma once

#include <CLI/App.hpp>

namespace depthgrid::program {

/// Adds the subcommand with its own subcommands build and info; they run when the command line is parsed. Throws
/// UsageError or Error from there.
void add_map_command(CLI::App& app);

}  // namespace depthgrid::program
