// depthgrid demo: distances in an embedded scene with one camera and with two, and a picture of it.
#pragma once

#include <CLI/App.hpp>
#include <string>

namespace depthgrid::program {

struct DemoOptions {
  std::string method = "corrected";  ///< letter, corrected or search
  std::string picture;               ///< PNG file; empty: no picture
};

/// Renders the scene, evaluates the control points, prints the table and writes the picture. Throws Error.
void run_demo(const DemoOptions& options);

/// Adds the subcommand; it runs when the command line is parsed.
void add_demo_command(CLI::App& app);

}  // namespace depthgrid::program
