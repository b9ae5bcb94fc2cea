// The deviations of several candidates as a table and as figures.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lab/experiments/stage/deviation.hpp"

namespace depthgrid::experiments {

struct LabelledDeviation {
  std::string label;
  Deviation deviation;
};

/// False obstacles, shortfall (median, 95 %), over-estimates, the largest one.
[[nodiscard]] std::string deviation_table(const std::vector<LabelledDeviation>& rows);

[[nodiscard]] nlohmann::ordered_json deviation_figures(const std::vector<LabelledDeviation>& rows);

}  // namespace depthgrid::experiments
