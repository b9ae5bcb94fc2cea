// How a program of subcommands ends: exit codes, and one line on standard error.
#pragma once

#include <CLI/App.hpp>

namespace depthgrid::program {

/// Parses the command line, which runs the subcommand. Returns the exit code: 0 done, 1 an error while working, 2 a
/// broken command line. Errors become one line after the app's name.
[[nodiscard]] int run_command_line(CLI::App& app, int argc, char** argv) noexcept;

}  // namespace depthgrid::program
