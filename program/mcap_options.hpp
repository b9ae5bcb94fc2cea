// What an MCAP file leaves open, as the command line says it.
#pragma once

#include <CLI/App.hpp>

#include "depthgrid/files/recording.hpp"

namespace depthgrid::program {

/// Adds --depth-topics, --world, --rig and --tolerance.
void add_mcap_options(CLI::App& command, files::McapChoice& choice);

}  // namespace depthgrid::program
