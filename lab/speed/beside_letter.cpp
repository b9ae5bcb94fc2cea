#include "depthgrid/grid/grid_evaluator.hpp"
#include "lab/speed/calls.hpp"
#include "lab/speed/our_figures.hpp"

namespace depthgrid::lab {

void measure_beside_letter(Stage& stage, const std::string& workload, const OurPlan& plan, Report& report) {
  PeerSetting setting = stage.setting();
  grid::EvaluationSettings settings;
  settings.variant = grid::Variant::letter;
  settings.rho_m = kRho;
  const grid::DepthQuantisation quantisation{0.2882, 0.01, 0.0, 343};
  settings.collect = grid::Collect::hybrid;
  grid::GridEvaluator hybrid(stage.rig(), 0, quantisation, settings);
  settings.collect = grid::Collect::minimum;
  grid::GridEvaluator minimum(stage.rig(), 0, quantisation, settings);
  setting.sensor.lateral_px = 1;
  SearchPeer ours(setting, kResolution);

  Calls our_distances;
  Calls our_hybrid;
  Samples hybrid_s;
  Samples minimum_s;
  std::vector<Answer> answers(kWorkloadControlPoints);
  const Stopwatch watch;
  for (int set = 0; set < stage.frame_sets(); ++set) {
    ours.prepare(stage.frames(set), stage.arm_region());
    (void)update_all(hybrid, stage.frames(set));
    (void)update_all(minimum, stage.frames(set));
    const double until_s = 2 * plan.limit_s * (set + 1) / stage.frame_sets();
    for (int i = 0; i == 0 || (i < plan.letter_repetitions && watch.elapsed_s() < until_s); ++i) {
      const Questions points =
          as_points(random_workload_points(time_between_s(set, i), kWorkloadControlPoints, seed_of(set, i)));
      our_distances.ask(ours, points, false, i == 0);
      hybrid_s.add(timed_s([&] { hybrid.evaluate(points, Workload::time_s(set), answers); }));
      our_hybrid.ask(ours, points, true, false);
      minimum_s.add(timed_s([&] { minimum.evaluate(points, Workload::time_s(set), answers); }));
    }
  }
  const auto add = [&](const char* name, const Samples& times_s) {
    Record record{"beside the letter, " + workload, name, {{"cameras", stage.cameras()}}, {}};
    times_s.describe("call", "s", record.numbers);
    report.records.push_back(std::move(record));
  };
  add("search", our_distances.times_s());
  add("search, hybrid", our_hybrid.times_s());
  add("letter, hybrid", hybrid_s);
  add("letter, minimum", minimum_s);
}

}  // namespace depthgrid::lab
