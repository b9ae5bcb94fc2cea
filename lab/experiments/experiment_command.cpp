#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <system_error>

#include "lab/commands.hpp"
#include "lab/experiments/experiment.hpp"
#include "program/output_file.hpp"
#include "program/usage_error.hpp"
#include "report/progress_line.hpp"

namespace depthgrid::lab {

namespace {

struct ExperimentOptions {
  bool list = false;
  std::string name;
  std::optional<std::string> out;
  experiments::Options experiment;
};

void say(const std::string& text) {
  program::OutputFile output("-");
  output.write(text);
  output.commit();
}

std::string list() {
  std::string text;
  for (const experiments::Experiment& experiment : experiments::experiments()) {
    std::string name(experiment.name);
    name.resize(std::max<std::size_t>(name.size(), 14), ' ');
    text += name + " " + std::string(experiment.summary) + "\n";
  }
  return text;
}

/// What would repeat the run.
std::string command_line(const ExperimentOptions& options) {
  std::string line = "depthgrid-lab experiment " + options.name + " --seed " + std::to_string(options.experiment.seed);
  if (options.experiment.quick) {
    line += " --quick";
  }
  if (options.experiment.frames) {
    line += " --frames " + std::to_string(*options.experiment.frames);
  }
  if (options.experiment.width_px) {
    line += " --width " + std::to_string(*options.experiment.width_px);
  }
  if (options.experiment.sensor) {
    line += " --sensor " + *options.experiment.sensor;
  }
  return line;
}

/// What is wrong with name and numbers is wrong with the command line.
const experiments::Experiment& chosen(const ExperimentOptions& options) {
  try {
    experiments::validate(options.experiment);
    return experiments::experiment(options.name);
  } catch (const Error& error) {
    throw program::UsageError(error.what());
  }
}

void run(ExperimentOptions options) {
  if (options.list) {
    say(list());
    return;
  }
  if (options.name.empty()) {
    program::fail_usage("experiment needs a NAME; depthgrid-lab experiment --list shows them");
  }
  const experiments::Experiment& experiment = chosen(options);
  options.experiment.out = options.out.value_or("experiment-" + options.name);
  options.experiment.command_line = command_line(options);
  std::optional<report::ProgressLine> line;
  std::size_t of = 0;
  options.experiment.progress = [&](std::size_t done, std::size_t total) {
    if (!line || total != of) {
      line.emplace(options.name + ", step", total);
      of = total;
    }
    line->update(done);
  };
  const std::string text = experiments::run_experiment(experiment, options.experiment);
  line.reset();
  say(text);
}

}  // namespace

void add_experiment_command(CLI::App& app) {
  const auto options = std::make_shared<ExperimentOptions>();
  CLI::App* const command = app.add_subcommand(
      "experiment",
      "the letter's experiments and further ones in the simulated workcell: minutes to hours, --quick "
      "seconds to minutes");
  command->add_option("NAME", options->name, "which one");
  command->add_flag("--list", options->list, "name the experiments and stop");
  command->add_option("--out", options->out,
                      "folder for report.md, figures.json and pictures; created if its parent exists (default: "
                      "experiment-NAME)");
  command->add_flag("--quick", options->experiment.quick, "smaller images and fewer frames");
  command->add_option("--seed", options->experiment.seed, "of everything random")
      ->check([](const std::string& text) {  // "-1" and numbers that are too large are read without complaint
        std::uint64_t seed = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
        return error == std::errc() && end == text.data() + text.size()
                   ? ""
                   : "'" + text + "' must be a whole number from 0 to 18446744073709551615";
      })
      ->capture_default_str();
  command->add_option("--frames", options->experiment.frames, "instants of time (default: the experiment's own)");
  command->add_option("--width", options->experiment.width_px,
                      "width of the depth images in pixels, which are 4:3 (default: the experiment's own)");
  command->add_option("--sensor", options->experiment.sensor,
                      "sensor model of the cameras, such as ideal, kinect_v1, realsense_d435 (default: the "
                      "experiment's own); with it the search with what is declared for it and a memory is shown, too");
  command->footer("Example:\n  depthgrid-lab experiment shadow --quick --out shadow");
  command->callback([options] { run(*options); });
}

}  // namespace depthgrid::lab
