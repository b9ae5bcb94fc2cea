// The depthgrid command. Exit codes: 0 done, 1 an error while working, 2 a broken command line.
#include <CLI/CLI.hpp>
#include <string>

#include "program/cell/cell_command.hpp"
#include "program/command_line.hpp"
#include "program/demo/demo_command.hpp"
#include "program/distances/distances_command.hpp"
#include "program/info/info_command.hpp"
#include "program/map/map_command.hpp"
#include "program/rig/rig_command.hpp"
#include "program/robot/robot_command.hpp"
#include "program/run/run_command.hpp"
#include "program/version.hpp"

int main(int argc, char** argv) {
  CLI::App app(
      "Computes a lower bound of the distance from control points to space that no depth camera has seen free.",
      "depthgrid");
  app.set_version_flag("--version", std::string("depthgrid ") + depthgrid::program::kVersion);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  app.footer(
      "Examples:\n"
      "  depthgrid demo\n"
      "  depthgrid run examples/simulated_cell.yaml\n"
      "  depthgrid info ../shared/data/kinect3_ball --frames 0:80:8\n"
      "  depthgrid distances ../shared/data/kinect3_ball --point hand=0.1,2.6,1.2 --in floor --frames 0:80:8\n"
      "'depthgrid COMMAND --help' explains a command. Exit codes: 0 done, 1 error, 2 broken command line.");
  depthgrid::program::add_demo_command(app);
  depthgrid::program::add_distances_command(app);
  depthgrid::program::add_info_command(app);
  depthgrid::program::add_map_command(app);
  depthgrid::program::add_rig_command(app);
  depthgrid::program::add_robot_command(app);
  depthgrid::program::add_cell_command(app);
  depthgrid::program::add_run_command(app);
  return depthgrid::program::run_command_line(app, argc, argv);
}
