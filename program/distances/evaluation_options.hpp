// The options of the command line that say how distances are computed: those of all methods, and those of the grid.
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

#include "depthgrid/core/margin.hpp"
#include "depthgrid/grid/depth_grid.hpp"
#include "depthgrid/grid/evaluation.hpp"

namespace depthgrid::program {

/// Texts and numbers as given; what is absent takes the default of the library.
struct EvaluationOptions {
  std::string method = "corrected";
  std::string collect = "minimum";
  std::optional<std::string> outside;
  double rho_m = grid::EvaluationSettings{}.rho_m;
  std::optional<double> d_min_m;

  std::optional<std::string> window;
  std::optional<double> step_m;
  std::optional<double> growth;
  std::optional<int> count;
};

void add_evaluation_options(CLI::App& command, EvaluationOptions& options);

/// Throws UsageError when an option that only the grid knows was given with --method search.
void refuse_grid_options(const EvaluationOptions& options);

/// For --method letter and corrected. The grid knows one margin for all cameras: the largest of each part counts.
/// Throws Error where a value breaks a rule.
grid::EvaluationSettings evaluation_settings(const EvaluationOptions& options,
                                             const std::vector<CameraMargins>& margins);

/// The depth cells: the user's values over `base`; without --count as many cells as reach `reach_m`. Throws Error where
/// that is more cells than a grid can have.
grid::DepthQuantisation depth_quantisation(const EvaluationOptions& options, const grid::DepthQuantisation& base,
                                           std::optional<double> reach_m);

}  // namespace depthgrid::program
