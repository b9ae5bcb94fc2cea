// Many random person motions, each with every method: contacts, distances, task time.
#pragma once

#include <optional>
#include <vector>

#include "lab/experiments/campaign/campaign_state.hpp"
#include "lab/experiments/experiment.hpp"

namespace depthgrid::experiments {

struct CampaignPlan {
  int motions = 200;
  double duration_s = 10;  ///< of each
  AvoidanceSettings common;
  /// Of Method::search_memory; none: it is not run, and all methods have the sensor of `common`. With them that method
  /// is run beside no avoidance and the letter's with two cameras, which keeps the sensor of `common`.
  std::optional<AvoidanceSettings> with_memory{};
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: one a core
};

/// Of one method.
[[nodiscard]] const AvoidanceSettings& settings_of(const CampaignPlan& plan, Method method);

/// What must agree for runs to belong together.
[[nodiscard]] nlohmann::ordered_json settings_of(const CampaignPlan& plan, bool with_recordings);

/// Runs what is missing in `state`, and saves it to `file` (empty: nowhere) after every motion. Throws Error.
void run_motions(const CampaignPlan& plan, const std::filesystem::path& file, CampaignState& state,
                 const Progress& progress);

/// The experiment. --frames is the number of motions. OUT/state.json holds what was done, so that a run that was cut
/// off goes on where it stopped.
void run_campaign(const Options& options, ExperimentReport& report);

}  // namespace depthgrid::experiments
