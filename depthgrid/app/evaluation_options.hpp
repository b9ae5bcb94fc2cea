// The options of the command line that say how distances are computed.
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

#include "depthgrid/core/rig.hpp"
#include "depthgrid/grid/depth_grid.hpp"
#include "depthgrid/grid/evaluation.hpp"

namespace depthgrid::app {

/// Texts and numbers as given; what is absent takes the default of the library or of the sensor preset.
struct EvaluationOptions {
  std::string variant = "corrected";
  std::string window = "rho";
  std::string collect = "minimum";
  std::string outside = "ignored";
  double rho_m = grid::EvaluationSettings{}.rho_m;

  std::string sensor = "ideal";
  std::optional<double> margin_constant_m;
  std::optional<double> margin_linear;
  std::optional<double> margin_quadratic_per_m;
  std::optional<int> margin_lateral_px;
  std::optional<double> margin_translation_m;
  std::optional<double> margin_rotation_rad;
  std::optional<double> margin_time_m;

  std::optional<double> near_m;
  std::optional<double> far_m;
  std::optional<std::string> beyond_far;  ///< invalid or clamp

  std::optional<double> d_min_m;
  std::optional<double> step_m;
  std::optional<double> growth;
  std::optional<int> count;
};

void add_evaluation_options(CLI::App& command, EvaluationOptions& options);

/// Throws UsageError where options exclude each other and Error where a value breaks a rule.
grid::EvaluationSettings evaluation_settings(const EvaluationOptions& options);

/// Nearest and farthest measurable depth: the user's, else the sensor preset's, else nothing (the rig file's own).
std::optional<double> near_limit_m(const EvaluationOptions& options);
std::optional<double> far_limit_m(const EvaluationOptions& options);

/// Whether readings beyond the far limit count as that limit: as the user says, else yes where the limit is the sensor
/// preset's, else nothing (the rig file's own).
std::optional<bool> clamp_beyond_far(const EvaluationOptions& options);

/// The depth cells: the user's values over `base`; without --count as many cells as reach `reach_m`. Throws Error where
/// that is more cells than a grid can have.
grid::DepthQuantisation depth_quantisation(const EvaluationOptions& options, const grid::DepthQuantisation& base,
                                           std::optional<double> reach_m);

}  // namespace depthgrid::app
