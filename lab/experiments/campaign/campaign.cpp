#include "lab/experiments/campaign/campaign.hpp"

#include <algorithm>
#include <mutex>
#include <utility>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/grid/map/parallel_for.hpp"
#include "depthgrid/robot/kuka_lwr4.hpp"
#include "lab/experiments/campaign/campaign_motions.hpp"
#include "lab/experiments/campaign/campaign_report.hpp"
#include "lab/experiments/experiment_report.hpp"
#include "lab/experiments/loop/avoidance_cell.hpp"
#include "lab/experiments/loop/avoidance_run.hpp"

namespace depthgrid::experiments {

namespace fs = std::filesystem;

namespace {

constexpr double kFullDuration = 10;
constexpr double kQuickDuration = 8;
constexpr int kFullWidth = 160;
constexpr int kQuickWidth = 128;
constexpr int kMemoryWidth = 640;  ///< of a real sensor
constexpr int kMemoryEvery = 4;    ///< periods between two evaluations: large images take long to simulate

/// All methods on one motion.
MotionOutcome outcome_of(const CampaignPlan& plan, const robot::RobotModel& model, const AvoidanceMotion& motion,
                         int number) {
  MotionOutcome outcome{motion.name, motion.v_max_m_s, {}};
  RunSettings settings;
  settings.duration_s = plan.duration_s;
  settings.seed = plan.seed + static_cast<std::uint64_t>(number);
  for (const Method method : methods_of(settings_of(plan, false))) {
    settings.common = settings_of(plan, method);
    outcome.runs[method] = run_avoidance(method, model, motion, settings).summary;
  }
  return outcome;
}

}  // namespace

const AvoidanceSettings& settings_of(const CampaignPlan& plan, Method method) {
  return method == Method::search_memory && plan.with_memory ? *plan.with_memory : plan.common;
}

nlohmann::ordered_json settings_of(const CampaignPlan& plan, bool with_recordings) {
  nlohmann::ordered_json settings{{"seed", plan.seed},
                                  {"duration_s", plan.duration_s},
                                  {"width_px", plan.common.width_px},
                                  {"sensor", plan.common.sensor},
                                  {"frame_latency_s", plan.common.frame_latency_s},
                                  {"period_s", plan.common.period_s},
                                  {"rho_m", plan.common.rho_m},
                                  {"repulsion_m_s", plan.common.repulsion_m_s},
                                  {"v_max_m_s", plan.common.v_max_m_s},
                                  {"ignored_pocket_m", plan.common.ignored_pocket_m},
                                  {"resolution_m", plan.common.resolution_m},
                                  {"approach_gain_per_s", plan.common.approach_gain_per_s},
                                  {"approach_stop_m", plan.common.approach_stop_m},
                                  {"removal_padding_m", plan.common.removal_padding_m},
                                  {"evaluate_every", plan.common.evaluate_every},
                                  {"program", "depthgrid " DEPTHGRID_VERSION},
                                  {"recordings", with_recordings}};
  if (plan.with_memory) {
    settings["with_memory"] = {{"sensor", plan.with_memory->sensor},
                               {"width_px", plan.with_memory->width_px},
                               {"evaluate_every", plan.with_memory->evaluate_every},
                               {"memory_padding_m", plan.with_memory->memory_padding_m}};
  }
  return settings;
}

void run_motions(const CampaignPlan& plan, const fs::path& file, CampaignState& state, const Progress& progress) {
  const robot::RobotModel model = robot::kuka_lwr4();
  const CampaignMotions motions(avoidance_rig(2, plan.common.width_px, plan.common.sensor), plan.seed, plan.duration_s,
                                mocap_folder());
  std::vector<int> left;
  for (int number = 0; number < plan.motions; ++number) {
    if (!state.motions.contains(number)) {
      left.push_back(number);
    }
  }
  std::mutex mutex;
  const auto work = [&](std::size_t i) {
    MotionOutcome outcome = outcome_of(plan, model, motions.motion(left[i]), left[i]);
    const std::lock_guard lock(mutex);
    state.motions[left[i]] = std::move(outcome);
    if (!file.empty()) {
      write_campaign_state(file, state);
    }
  };
  (void)grid::parallel_for(left.size(), plan.threads, work, [&](std::size_t done) {
    progress(done, std::max<std::size_t>(1, left.size()));
    return true;
  });
}

void run_campaign(const Options& options, ExperimentReport& report) {
  CampaignPlan plan;
  plan.motions = frames_or(options, 200, 20);
  plan.duration_s = options.quick ? kQuickDuration : kFullDuration;
  plan.common.width_px = width_or(options, kFullWidth, kQuickWidth);
  plan.seed = options.seed;
  if (options.sensor) {
    // Smaller images of a real sensor say next to nothing (docs/experiments.md): the width given is theirs, too.
    plan.common.width_px = options.quick ? kQuickWidth : kFullWidth;
    plan.with_memory = sensor_settings(sensor_or(options, "ideal"), width_or(options, kMemoryWidth, kMemoryWidth));
    plan.with_memory->evaluate_every = kMemoryEvery;
  }
  const Rig rig = avoidance_rig(2, plan.common.width_px, plan.common.sensor);
  const bool recordings = CampaignMotions(rig, plan.seed, plan.duration_s, mocap_folder()).has_recordings();

  std::error_code error;
  if (!fs::is_directory(options.out, error) && !fs::create_directory(options.out, error)) {
    fail("cannot create the folder ", options.out.string(), ": ", error.message());
  }
  const fs::path file = options.out / "state.json";
  CampaignState state = read_campaign_state(file, settings_of(plan, recordings));
  run_motions(plan, file, state, options.progress);
  state.motions.erase(state.motions.lower_bound(plan.motions), state.motions.end());
  report_campaign(plan, state, report);
}

}  // namespace depthgrid::experiments
