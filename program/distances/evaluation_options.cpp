#include "program/distances/evaluation_options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "program/usage_error.hpp"

namespace depthgrid::program {

namespace {

constexpr int kLargestCellCount = 65535;

void add_method_options(CLI::App& command, EvaluationOptions& options) {
  command
      .add_option("--method,--variant", options.method,
                  "letter: as printed, errors included; corrected: its grid, a lower bound; search: a tight lower "
                  "bound, from any cameras, needs the options of the group Search")
      ->check(CLI::IsMember({"letter", "corrected", "search"}))
      ->capture_default_str()
      ->group("Method");
  command.add_option("--collect", options.collect, "minimum: nearest only; hybrid: direction from all within rho")
      ->check(CLI::IsMember({"minimum", "hybrid"}))
      ->capture_default_str()
      ->group("Method");
  command
      .add_option("--outside", options.outside,
                  "space outside the space of interest: ignored, or counted as obstacle (default: ignored; search "
                  "has no default)")
      ->check(CLI::IsMember({"ignored", "obstacle"}))
      ->group("Method");
  command.add_option("--rho", options.rho_m, "surveillance radius in metres")->capture_default_str()->group("Method");
}

void add_grid_options(CLI::App& command, EvaluationOptions& options) {
  command
      .add_option("--window", options.window, "pixels evaluated: rho = region of surveillance (default), image = all")
      ->check(CLI::IsMember({"rho", "image"}))
      ->group("Depth grid");
  command
      .add_option("--d-min", options.d_min_m,
                  "depth at which the grid, or the frustum of --d-max, begins, metres (default of the grid 0.2882)")
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
  add_grid_options(command, options);
}

void refuse_grid_options(const EvaluationOptions& options) {
  const char* given = options.window   ? "--window"
                      : options.step_m ? "--step"
                      : options.growth ? "--growth"
                      : options.count  ? "--count"
                                       : nullptr;
  if (given != nullptr) {
    fail_usage(given, " has no effect with --method search, which has no depth grid");
  }
}

grid::EvaluationSettings evaluation_settings(const EvaluationOptions& options,
                                             const std::vector<CameraMargins>& margins) {
  grid::EvaluationSettings settings;
  settings.variant = options.method == "letter" ? grid::Variant::letter : grid::Variant::corrected;
  settings.window = options.window == "image" ? grid::Window::whole_image : grid::Window::region_of_surveillance;
  settings.collect = options.collect == "hybrid" ? grid::Collect::hybrid : grid::Collect::minimum;
  settings.outside = options.outside == "obstacle" ? grid::OutsideSpace::obstacle : grid::OutsideSpace::ignored;
  settings.rho_m = options.rho_m;
  settings.sensor.lateral_px = 0;
  for (const CameraMargins& camera : margins) {
    settings.sensor.constant_m = std::max(settings.sensor.constant_m, camera.sensor.constant_m);
    settings.sensor.linear = std::max(settings.sensor.linear, camera.sensor.linear);
    settings.sensor.quadratic_per_m = std::max(settings.sensor.quadratic_per_m, camera.sensor.quadratic_per_m);
    settings.sensor.lateral_px = std::max(settings.sensor.lateral_px, camera.sensor.lateral_px);
    settings.pose.translation_m = std::max(settings.pose.translation_m, camera.translation_m);
    settings.pose.rotation_rad = std::max(settings.pose.rotation_rad, camera.rotation_rad);
  }
  grid::validate(settings);
  return settings;
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

}  // namespace depthgrid::program
