// The subcommands of depthgrid-lab. Each is added with its options and runs when the command line is parsed.
#pragma once

#include <CLI/App.hpp>

namespace depthgrid::lab {

void add_experiment_command(CLI::App& app);
void add_recordings_command(CLI::App& app);
void add_letter_rate_command(CLI::App& letter);
void add_map_storages_command(CLI::App& app);
void add_image_in_command(CLI::App& app);
void add_memory_in_command(CLI::App& app);
void add_robot_removal_command(CLI::App& app);
void add_control_cycle_command(CLI::App& app);
void add_worst_cases_command(CLI::App& app);
void add_growth_command(CLI::App& app);
void add_pictures_command(CLI::App& app);
void add_devices_command(CLI::App& app);
void add_day_command(CLI::App& app);
void add_latency_command(CLI::App& app);
void add_workcell_rate_command(CLI::App& workcell);
void add_workcell_pictures_command(CLI::App& workcell);

// These ask the oracle of the tests; in a build without tests they say so.
void add_speed_command(CLI::App& app);
void add_campaign_command(CLI::App& app);
void add_worlds_command(CLI::App& app);
void add_letter_errors_command(CLI::App& letter);

}  // namespace depthgrid::lab
