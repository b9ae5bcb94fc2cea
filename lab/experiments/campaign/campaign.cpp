#include "lab/experiments/campaign/campaign.hpp"

#include <algorithm>
#include <exception>
#include <mutex>
#include <stop_token>
#include <thread>

#include "depthgrid/core/error.hpp"
#include "depthgrid/robot/kuka_lwr4.hpp"
#include "lab/experiments/campaign/campaign_motions.hpp"
#include "lab/experiments/campaign/campaign_report.hpp"
#include "lab/experiments/experiment_report.hpp"

namespace depthgrid::experiments {

namespace fs = std::filesystem;

namespace {

constexpr double kFullDuration = 10;
constexpr double kQuickDuration = 8;
constexpr int kFullWidth = 160;
constexpr int kQuickWidth = 128;

/// The motions that are still to do, shared between the threads that do them.
class Work {
 public:
  Work(const CampaignPlan& plan, fs::path file, CampaignState& state, const Progress& progress)
      : plan_(plan),
        file_(std::move(file)),
        state_(state),
        progress_(progress),
        model_(robot::kuka_lwr4()),
        motions_(avoidance_rig(2, plan.common.width_px, plan.common.sensor), plan.seed, plan.duration_s,
                 mocap_folder()) {
    for (int number = 0; number < plan.motions; ++number) {
      if (!state.motions.contains(number)) {
        left_.push_back(number);
      }
    }
    std::reverse(left_.begin(), left_.end());
    total_ = left_.size();
  }

  void run() {
    const int threads = std::clamp(plan_.threads, 1, 64);
    {
      // Stopped and joined, too, when this thread leaves by an exception.
      std::vector<std::jthread> others;
      others.reserve(static_cast<std::size_t>(threads) - 1);
      for (int i = 1; i < threads; ++i) {
        others.emplace_back([this](const std::stop_token& stop) { work(stop, false); });
      }
      work({}, true);
      for (std::jthread& thread : others) {
        thread.join();
      }
    }
    if (error_) {
      std::rethrow_exception(error_);
    }
    progress_(total_, std::max<std::size_t>(1, total_));
  }

 private:
  /// Only the calling thread shows progress.
  void work(const std::stop_token& stop, bool shows_progress) {
    while (!stop.stop_requested()) {
      int number = 0;
      {
        const std::lock_guard lock(mutex_);
        if (left_.empty() || error_) {
          return;
        }
        number = left_.back();
        left_.pop_back();
      }
      try {
        done(number, outcome(number), shows_progress);
      } catch (...) {
        const std::lock_guard lock(mutex_);
        error_ = error_ ? error_ : std::current_exception();
        return;
      }
    }
  }

  [[nodiscard]] MotionOutcome outcome(int number) const {
    const AvoidanceMotion motion = motions_.motion(number);
    MotionOutcome outcome{motion.name, motion.v_max_m_s, {}};
    RunSettings settings;
    settings.common = plan_.common;
    settings.duration_s = plan_.duration_s;
    settings.seed = plan_.seed + static_cast<std::uint64_t>(number);
    for (const Method method : kMethods) {
      outcome.runs[method] = run_avoidance(method, model_, motion, settings).summary;
    }
    return outcome;
  }

  void done(int number, MotionOutcome outcome, bool shows_progress) {
    const std::lock_guard lock(mutex_);
    state_.motions[number] = std::move(outcome);
    ++done_;
    if (!file_.empty()) {
      write_campaign_state(file_, state_);
    }
    if (shows_progress) {
      progress_(done_, total_);
    }
  }

  const CampaignPlan& plan_;
  fs::path file_;
  CampaignState& state_;
  const Progress& progress_;
  robot::RobotModel model_;
  CampaignMotions motions_;
  std::mutex mutex_;
  std::vector<int> left_;
  std::size_t total_ = 0;
  std::size_t done_ = 0;
  std::exception_ptr error_;
};

}  // namespace

nlohmann::ordered_json settings_of(const CampaignPlan& plan, bool with_recordings) {
  return {{"seed", plan.seed},
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
}

void run_motions(const CampaignPlan& plan, const fs::path& file, CampaignState& state, const Progress& progress) {
  Work(plan, file, state, progress).run();
}

void run_campaign(const Options& options, ExperimentReport& report) {
  CampaignPlan plan;
  plan.motions = frames_or(options, 200, 20);
  plan.duration_s = options.quick ? kQuickDuration : kFullDuration;
  plan.common.width_px = width_or(options, kFullWidth, kQuickWidth);
  plan.seed = options.seed;
  plan.threads = static_cast<int>(std::thread::hardware_concurrency());
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
