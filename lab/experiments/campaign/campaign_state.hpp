// What the campaign has found so far, in a file: one entry a motion, each with all methods.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lab/experiments/loop/avoidance_method.hpp"
#include "lab/experiments/loop/run_summary.hpp"

namespace depthgrid::experiments {

struct MotionOutcome {
  std::string name;
  double v_max_m_s = 0;
  std::map<Method, RunSummary> runs;
};

struct CampaignState {
  /// What must be the same for runs to belong together.
  nlohmann::ordered_json settings;
  std::map<int, MotionOutcome> motions;  ///< by number
};

/// Those that every motion has with these settings.
[[nodiscard]] std::vector<Method> methods_of(const nlohmann::ordered_json& settings);

/// The file is written whole or not at all. Throws Error that names it.
void write_campaign_state(const std::filesystem::path& file, const CampaignState& state);

/// What the file holds; an empty state when there is none. Throws Error that names the file when it is no state, or one
/// of other settings than these.
[[nodiscard]] CampaignState read_campaign_state(const std::filesystem::path& file,
                                                const nlohmann::ordered_json& settings);

}  // namespace depthgrid::experiments
