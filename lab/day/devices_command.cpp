// depthgrid-lab devices: the simulated cell's cameras and joints as devices on the network, with faults, for a running
// cell that knows nothing of this.
#include <CLI/CLI.hpp>
#include <atomic>
#include <exception>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "depthgrid/cell/cell_file.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/sensors/clock.hpp"
#include "lab/commands.hpp"
#include "lab/day/device.hpp"
#include "lab/day/running_truth.hpp"
#include "lab/measure/json_file.hpp"

namespace depthgrid::lab {
namespace {

struct DevicesOptions {
  std::string cell;
  std::string plan;
  std::vector<std::string> devices;
  DeviceSettings settings;
  std::string truth;
  double truth_rate_hz = 50;
};

/// The distance of each asked link to everything there is, a line an instant.
void write_truth(const DevicesOptions& options, const cell::Cell& cell, const cell::CellSetup& setup,
                 const std::shared_ptr<const sensors::SimulatedCell>& simulated) {
  std::ofstream out(options.truth);
  RunningTruth truth(cell, setup, simulated);
  for (std::int64_t n = 0;; ++n) {
    const double cell_s = static_cast<double>(n) / options.truth_rate_hz;
    if (cell_s > options.settings.plan.seconds || !out) {
      break;
    }
    Json line;
    line["time_s"] = simulated->begin_s() + cell_s;
    for (std::size_t i = 0; i < setup.parts.size(); ++i) {
      line["distance_m"][setup.parts[i].name] = finite(truth.distance_m(i, cell_s));
    }
    out << line.dump() + "\n";
  }
  if (!out.flush()) {
    fail(options.truth, ": cannot be written");
  }
}

void run_devices(DevicesOptions options) {
  const cell::Cell cell = cell::load_cell(options.cell);
  const cell::CellSetup setup = cell::setup(cell);
  if (options.plan.empty()) {
    options.settings.plan.begin_s = sensors::clock_now_s();
  } else {
    const DayPlan plan = read_plan(options.plan);
    options.settings.plan = plan;
  }
  if (options.devices.empty()) {
    for (const cell::CameraEntry& camera : cell.cameras) {
      options.devices.push_back(camera.name);
    }
    options.devices.emplace_back(kJointsDevice);
  }
  sensors::SimulatedCellSettings scene;
  scene.robot = setup.robot;
  scene.begin_s = options.settings.plan.begin_s;
  const auto simulated = std::make_shared<const sensors::SimulatedCell>(scene);
  std::atomic<bool> is_over{false};
  std::vector<std::exception_ptr> errors(options.devices.size() + 1);
  std::vector<std::jthread> threads;
  const auto start = [&](std::size_t i, auto&& run) {
    threads.emplace_back([&errors, &is_over, i, run] {
      try {
        run();
      } catch (...) {
        errors[i] = std::current_exception();
        is_over = true;
      }
    });
  };
  for (std::size_t i = 0; i < options.devices.size(); ++i) {
    start(i, [&, i] { run_device(options.devices[i], cell, setup, simulated, options.settings, is_over); });
  }
  if (!options.truth.empty()) {
    start(options.devices.size(), [&] { write_truth(options, cell, setup, simulated); });
  }
  threads.clear();
  for (const std::exception_ptr& error : errors) {
    if (error) {
      std::rethrow_exception(error);
    }
  }
}

}  // namespace

void add_devices_command(CLI::App& app) {
  const auto options = std::make_shared<DevicesOptions>();
  options->settings.plan.seconds = 60;
  CLI::App* const command = app.add_subcommand(
      "devices", "the simulated cell's cameras and joints as topics of ROS 2, with faults as planned");
  command->add_option("CELL", options->cell, "the cell file whose topics are sent")->required();
  command->add_option("--device", options->devices, "only these: a camera's name, or joints (all)");
  command->add_option("--plan", options->plan, "times and faults, as depthgrid-lab day plan writes them (none fails)");
  DayPlan& plan = options->settings.plan;
  command->add_option("--seconds", plan.seconds, "without a plan")->check(CLI::Range(0.1, 1e6))->capture_default_str();
  command->add_option("--rate", plan.image_rate_hz, "images a second, without a plan")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  command->add_option("--joint-rate", plan.joint_rate_hz, "joint states a second, without a plan")
      ->check(CLI::Range(0.1, 10000.0))
      ->capture_default_str();
  command
      ->add_option("--clock-ahead", options->settings.clock_ahead_s,
                   "seconds by which the devices' clock is ahead of this computer's")
      ->check(CLI::Range(-1e6, 1e6))
      ->capture_default_str();
  command
      ->add_option("--rendered-ahead", options->settings.rendered_ahead,
                   "so many images are rendered before and sent in turn: for measuring the other side")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  command->add_option("--log", options->settings.log, "JSON lines: which fault began and ended with which message");
  command->add_option("--truth", options->truth, "JSON lines: how far each asked link is from everything there is");
  command->add_option("--truth-rate", options->truth_rate_hz, "lines a second of the cell's time")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  command->callback([options] { run_devices(*options); });
}

}  // namespace depthgrid::lab
