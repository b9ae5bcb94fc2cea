// depthgrid info: what a recording holds, how well its cameras agree, and which margins that suggests.
#pragma once

#include <CLI/App.hpp>

namespace depthgrid::program {

/// Adds the subcommand; it runs when the command line is parsed. Throws UsageError or Error from there.
void add_info_command(CLI::App& app);

}  // namespace depthgrid::program
