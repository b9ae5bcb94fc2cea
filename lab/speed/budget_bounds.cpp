// How much of the whole answer a call has when its budget ends.
#include <algorithm>

#include "lab/speed/calls.hpp"
#include "lab/speed/our_figures.hpp"

namespace depthgrid::lab {
namespace {

constexpr double kLargePart = 0.7;

/// Of one budget.
struct Bounds {
  double answers = 0;
  double large = 0;  ///< at least kLargePart of the whole answer
  double zero = 0;   ///< 0, and the whole answer is not
  double calls = 0;
  double large_calls = 0;  ///< all of the call's answers are large

  void take(const std::vector<Answer>& whole, const std::vector<Answer>& bound) {
    bool all_large = true;
    for (std::size_t i = 0; i < whole.size(); ++i) {
      const double whole_m = whole[i].nearest.distance_m;
      const double bound_m = bound[i].nearest.distance_m;
      const bool is_large = bound_m >= kLargePart * whole_m;
      large += is_large ? 1 : 0;
      zero += bound_m <= 0 && whole_m > 0 ? 1 : 0;
      all_large = all_large && is_large;
    }
    answers += static_cast<double>(whole.size());
    calls += 1;
    large_calls += all_large ? 1 : 0;
  }
};

}  // namespace

void measure_budget_bounds(Stage& stage, const std::string& workload, const OurMargins& margins, Report& report) {
  PeerSetting setting = stage.setting();
  setting.sensor = margins.sensor;
  setting.pose = margins.pose;
  SearchPeer ours(setting, kResolution);
  SearchPeer unbounded(setting, kResolution);  // its own memory: ours knows no more than its budgets allow
  for (const std::int64_t nodes : {300, 1000, 3000}) {
    search::Budget budget;
    budget.nodes = nodes;
    Bounds bounds;
    Calls cut;
    for (int set = 0; set < stage.frame_sets(); ++set) {
      ours.prepare(stage.frames(set), stage.arm_region());
      unbounded.prepare(stage.frames(set), stage.arm_region());
      for (int i = 0; i < kSubSteps; ++i) {
        const Questions questions =
            as_points(random_workload_points(time_between_s(set, i), kWorkloadControlPoints, seed_of(set, i)));
        cut.ask(ours, questions, false, i == 0, budget);
        Calls whole;
        whole.ask(unbounded, questions, false, false);
        bounds.take(whole.last(), cut.last());
      }
    }
    Record record = cut.record("budget, " + workload, "nine points", stage.cameras());
    record.numbers["budget_nodes"] = static_cast<double>(nodes);
    record.numbers["large_share"] = bounds.large / bounds.answers;
    record.numbers["zero_share"] = bounds.zero / bounds.answers;
    record.numbers["large_calls_share"] = bounds.large_calls / bounds.calls;
    report.records.push_back(std::move(record));
  }
}

}  // namespace depthgrid::lab
