#include "lab/experiments/experiment.hpp"

#include <algorithm>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/sensor_models.hpp"
#include "lab/experiments/experiment_report.hpp"

namespace depthgrid::experiments {

void validate(const Options& options) {
  if (options.frames && !(*options.frames >= 1 && *options.frames <= 100000)) {
    fail("frames is ", *options.frames, ", must be 1 ... 100000");
  }
  if (options.width_px && !(*options.width_px >= 32 && *options.width_px <= 1280 && *options.width_px % 4 == 0)) {
    fail("width is ", *options.width_px, " px, must be 32 ... 1280 and a multiple of 4");
  }
  (void)sensor_or(options, "ideal");
}

int frames_or(const Options& options, int full, int quick) {
  return options.frames.value_or(options.quick ? quick : full);
}

int width_or(const Options& options, int full, int quick) {
  return options.width_px.value_or(options.quick ? quick : full);
}

std::string_view sensor_or(const Options& options, std::string_view own) {
  return sensor_model(options.sensor ? std::string_view(*options.sensor) : own).name;
}

const Experiment& experiment(std::string_view name) {
  const auto all = experiments();
  const auto found = std::find_if(all.begin(), all.end(), [name](const Experiment& e) { return e.name == name; });
  if (found == all.end()) {
    std::string names;
    for (const Experiment& e : all) {
      names.append(names.empty() ? "" : ", ").append(e.name);
    }
    fail("there is no experiment '", name, "', known are ", names);
  }
  return *found;
}

std::string run_experiment(const Experiment& experiment, const Options& options) {
  validate(options);
  ExperimentReport report(experiment, options);
  experiment.run(options, report);
  report.write();
  return report.text();
}

}  // namespace depthgrid::experiments
