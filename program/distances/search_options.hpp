// The options of the command line that only --method search knows.
#pragma once

#include <CLI/App.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "depthgrid/core/rig.hpp"
#include "depthgrid/memory/settings.hpp"
#include "depthgrid/search/search.hpp"
#include "program/distances/evaluation_options.hpp"

namespace depthgrid::program {

/// As given. What decides about obstacles has no default.
struct SearchOptions {
  std::optional<std::string> unobserved;
  std::optional<std::string> robot_pockets;
  std::optional<double> ignored_pocket_m;
  std::optional<double> v_max_m_s;
  std::optional<double> smallest_obstacle_m;
  std::optional<double> resolution_m;
  std::optional<std::string> box;
  std::optional<double> d_max_m;
  std::optional<std::int64_t> budget_nodes;
  std::optional<std::string> memory;  ///< how it begins
  std::optional<double> memory_voxel_m;
};

void add_search_options(CLI::App& command, SearchOptions& options);

/// Throws UsageError when one of these options was given with another method.
void refuse_search_options(const SearchOptions& options, const std::string& method);

/// `principal`: the camera whose view is the space of interest where no --box is given. Throws UsageError that names
/// every option which is missing.
views::Settings search_settings(const SearchOptions& options, const EvaluationOptions& evaluation,
                                std::size_t principal, const std::vector<CameraMargins>& margins);

/// Of what was seen free in the frames before, in the space of interest; nothing: no memory. Throws UsageError where
/// that is no box, or a voxel is out of range.
std::optional<memory::MemorySettings> search_memory(const SearchOptions& options);

/// What one call may cost. Throws UsageError unless positive.
search::Budget search_budget(const SearchOptions& options);

}  // namespace depthgrid::program
