#include "depthgrid/app/evaluation_options.hpp"

#include <CLI/CLI.hpp>

#include "depthgrid/app/sensor_preset.hpp"
#include "depthgrid/app/usage_error.hpp"

namespace depthgrid::app {

namespace {

constexpr int kLargestCellCount = 65535;

void add_method_options(CLI::App& command, EvaluationOptions& options) {
  command.add_option("--variant", options.variant, "letter: as printed, errors included; corrected: a lower bound")
      ->check(CLI::IsMember({"letter", "corrected"}))
      ->capture_default_str()
      ->group("Method");
  command.add_option("--window", options.window, "pixels evaluated: rho = region of surveillance, image = all")
      ->check(CLI::IsMember({"rho", "image"}))
      ->capture_default_str()
      ->group("Method");
  command.add_option("--collect", options.collect, "minimum: nearest only; hybrid: direction from all within rho")
      ->check(CLI::IsMember({"minimum", "hybrid"}))
      ->capture_default_str()
      ->group("Method");
  command.add_option("--outside", options.outside, "space outside the grid: ignored, or counted as obstacle")
      ->check(CLI::IsMember({"ignored", "obstacle"}))
      ->capture_default_str()
      ->group("Method");
  command.add_option("--rho", options.rho_m, "surveillance radius in metres")->capture_default_str()->group("Method");
}

void add_sensor_options(CLI::App& command, EvaluationOptions& options) {
  std::string sensors;
  std::vector<std::string> names;
  for (const auto& preset : sensor_presets()) {
    sensors += "; " + preset.name + ": " + preset.description;
    names.push_back(preset.name);
  }
  command.add_option("--sensor", options.sensor, "margins to start from" + sensors)
      ->check(CLI::IsMember(names))
      ->capture_default_str()
      ->group("Sensor");
  command.add_option("--margin-constant", options.margin_constant_m, "constant part of the depth margin m(D), metres")
      ->group("Sensor");
  command.add_option("--margin-linear", options.margin_linear, "part of m(D) that grows with D")->group("Sensor");
  command.add_option("--margin-quadratic", options.margin_quadratic_per_m, "part of m(D) that grows with D^2, 1/metre")
      ->group("Sensor");
  command.add_option("--margin-lateral", options.margin_lateral_px, "reach w beside a pixel, pixels")->group("Sensor");
  command.add_option("--margin-translation", options.margin_translation_m, "calibration error of position, metres")
      ->group("Sensor");
  command.add_option("--margin-rotation", options.margin_rotation_rad, "calibration error of rotation, radians")
      ->group("Sensor");
  command
      .add_option("--margin-time", options.margin_time_m, "largest way of an obstacle between the exposures, metres")
      ->group("Sensor");
  command.add_option("--near", options.near_m, "nearest measurable depth, metres")->group("Sensor");
  command.add_option("--far", options.far_m, "farthest measurable depth, metres")->group("Sensor");
  command.add_option("--beyond-far", options.beyond_far, "readings beyond --far: invalid, or clamp = free up to --far")
      ->check(CLI::IsMember({"invalid", "clamp"}))
      ->group("Sensor");
}

void add_grid_options(CLI::App& command, EvaluationOptions& options) {
  command.add_option("--d-min", options.d_min_m, "depth at which the grid begins, metres (default 0.2882)")
      ->group("Depth grid");
  command.add_option("--step", options.step_m, "depth of a cell, metres (default 0.01)")->group("Depth grid");
  command.add_option("--growth", options.growth, "growth of a cell's depth with depth (default 0)")
      ->group("Depth grid");
  command
      .add_option("--count", options.count,
                  "number of cells in depth (default: to --far, or to the deepest reading of the principal camera)")
      ->group("Depth grid");
}

}  // namespace

void add_evaluation_options(CLI::App& command, EvaluationOptions& options) {
  add_method_options(command, options);
  add_sensor_options(command, options);
  add_grid_options(command, options);
}

grid::EvaluationSettings evaluation_settings(const EvaluationOptions& options) {
  grid::EvaluationSettings settings;
  settings.variant = options.variant == "letter" ? grid::Variant::letter : grid::Variant::corrected;
  settings.window = options.window == "image" ? grid::Window::whole_image : grid::Window::region_of_surveillance;
  settings.collect = options.collect == "hybrid" ? grid::Collect::hybrid : grid::Collect::minimum;
  settings.outside = options.outside == "obstacle" ? grid::OutsideSpace::obstacle : grid::OutsideSpace::ignored;
  settings.rho_m = options.rho_m;

  const bool any_margin = options.margin_constant_m || options.margin_linear || options.margin_quadratic_per_m ||
                          options.margin_lateral_px || options.margin_translation_m || options.margin_rotation_rad ||
                          options.margin_time_m;
  if (any_margin && settings.variant == grid::Variant::letter) {
    fail_usage("--margin-... has no effect with --variant letter, which knows no margins; use --variant corrected");
  }
  const SensorMargin& preset = sensor_preset(options.sensor).margin;
  settings.sensor.constant_m = options.margin_constant_m.value_or(preset.constant_m);
  settings.sensor.linear = options.margin_linear.value_or(preset.linear);
  settings.sensor.quadratic_per_m = options.margin_quadratic_per_m.value_or(preset.quadratic_per_m);
  settings.sensor.lateral_px = options.margin_lateral_px.value_or(preset.lateral_px);
  settings.pose.translation_m = options.margin_translation_m.value_or(0.0);
  settings.pose.rotation_rad = options.margin_rotation_rad.value_or(0.0);
  settings.pose.time_m = options.margin_time_m.value_or(0.0);
  grid::validate(settings);
  return settings;
}

std::optional<double> near_limit_m(const EvaluationOptions& options) {
  return options.near_m ? options.near_m : sensor_preset(options.sensor).near_m;
}

std::optional<double> far_limit_m(const EvaluationOptions& options) {
  return options.far_m ? options.far_m : sensor_preset(options.sensor).far_m;
}

std::optional<bool> clamp_beyond_far(const EvaluationOptions& options) {
  if (options.beyond_far) {
    return *options.beyond_far == "clamp";
  }
  // A preset's far end is a declared property of the sensor; the user's own is not unless it is said.
  return !options.far_m && sensor_preset(options.sensor).far_m ? std::optional<bool>(true) : std::nullopt;
}

grid::DepthQuantisation depth_quantisation(const EvaluationOptions& options, const grid::DepthQuantisation& base,
                                           std::optional<double> reach_m) {
  grid::DepthQuantisation cells = base;
  cells.d_min_m = options.d_min_m.value_or(base.d_min_m);
  cells.step_m = options.step_m.value_or(base.step_m);
  cells.growth = options.growth.value_or(base.growth);
  cells.count = options.count.value_or(base.count);
  grid::validate(cells);
  if (!options.count && reach_m) {
    cells.count = 1;
    for (double end_m = cells.d_min_m + cells.step_m; end_m < *reach_m; ++cells.count) {
      if (cells.count == kLargestCellCount) {
        fail("depth cells: ", kLargestCellCount, " cells of ", cells.step_m, " m (growth ", cells.growth, ") reach to ",
             end_m, " m, must reach the far end ", *reach_m, " m; give a larger --step or --growth, or --count");
      }
      end_m += cells.step_m + cells.growth * (end_m - cells.d_min_m);
    }
    grid::validate(cells);
  }
  return cells;
}

}  // namespace depthgrid::app
