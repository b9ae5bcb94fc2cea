// `depthgrid rig from`: a rig file from calibration files of other programs.
#pragma once

#include <CLI/App.hpp>

namespace depthgrid::program {

/// Adds the subcommand to `app`.
void add_rig_command(CLI::App& app);

}  // namespace depthgrid::program
