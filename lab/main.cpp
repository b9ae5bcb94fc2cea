// depthgrid-lab: everything that measures. Exit codes: 0 done, 1 an error or a check that failed, 2 a broken command
// line.
#include <CLI/CLI.hpp>

#include "lab/commands.hpp"
#include "program/command_line.hpp"

int main(int argc, char** argv) {
  using namespace depthgrid::lab;
  CLI::App app("Measures depthgrid: experiments in a simulated workcell, speed, soundness, figures on recordings.",
               "depthgrid-lab");
  app.set_version_flag("--version", "depthgrid-lab " DEPTHGRID_VERSION);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  app.footer(
      "'depthgrid-lab COMMAND --help' says what it measures and how long it takes; times are of two cores.\n"
      "Exit codes: 0 done, 1 an error or a check that failed, 2 broken command line.");
  add_experiment_command(app);
  add_speed_command(app);
  add_campaign_command(app);
  add_worlds_command(app);
  add_recordings_command(app);
  CLI::App* const letter = app.add_subcommand("letter", "the letter's evaluation on the depth grid: rate, errors");
  letter->require_subcommand(1);
  add_letter_rate_command(*letter);
  add_letter_errors_command(*letter);
  add_map_storages_command(app);
  add_image_in_command(app);
  add_memory_in_command(app);
  add_robot_removal_command(app);
  add_control_cycle_command(app);
  add_worst_cases_command(app);
  add_growth_command(app);
  CLI::App* const workcell = app.add_subcommand("workcell", "the simulated workcell: rate, pictures");
  workcell->require_subcommand(1);
  add_workcell_rate_command(*workcell);
  add_workcell_pictures_command(*workcell);
  add_pictures_command(app);
  add_devices_command(app);
  add_day_command(app);
  add_latency_command(app);
  return depthgrid::program::run_command_line(app, argc, argv);
}
