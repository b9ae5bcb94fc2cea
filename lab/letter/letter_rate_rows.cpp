#include "lab/letter/letter_rate_rows.hpp"

#include <algorithm>
#include <numeric>

#include "depthgrid/grid/grid_evaluator.hpp"
#include "lab/measure/clocks.hpp"

namespace depthgrid::lab {

std::vector<RateMethod> rate_methods() {
  std::vector<RateMethod> methods;
  for (const auto variant : {grid::Variant::letter, grid::Variant::corrected}) {
    for (const auto collect : {grid::Collect::hybrid, grid::Collect::minimum}) {
      RateMethod method;
      method.name = variant == grid::Variant::letter ? "letter" : "corrected";
      method.name += collect == grid::Collect::hybrid ? ", hybrid" : ", minimum";
      method.settings.variant = variant;
      method.settings.collect = collect;
      method.settings.sensor.lateral_px = 0;
      method.repetition_divisor = variant == grid::Variant::letter ? 1 : 10;
      methods.push_back(method);
    }
  }
  return methods;
}

double RateRow::rate() const {
  const double total_s = std::accumulate(evaluation_s.begin(), evaluation_s.end(), 0.0);
  return total_s > 0 ? static_cast<double>(evaluation_s.size()) / total_s : 0;
}

RateRow measure_rate(const Workload& workload, int cameras, const RateMethod& method, int repetitions) {
  RateRow row;
  row.name = method.name;
  row.cameras = cameras;
  Rig rig = workload.rig();
  rig.cameras.resize(static_cast<std::size_t>(cameras));
  grid::GridEvaluator evaluator(rig, 0, {0.2882, 0.01, 0.0, 343}, method.settings);
  std::vector<Answer> answers(kWorkloadControlPoints);
  std::uint64_t seed = 1;
  for (int set = 0; set < workload.frame_sets(); ++set) {
    const auto frames = workload.frames(set).first(static_cast<std::size_t>(cameras));
    const double update_start_s = processor_time_s();
    (void)update_all(evaluator, frames);
    row.update_s.push_back(processor_time_s() - update_start_s);
    for (int i = 0; i < std::max(1, repetitions / method.repetition_divisor); ++i) {
      const auto points = random_workload_points(Workload::time_s(set), kWorkloadControlPoints, seed++);
      const double start_s = processor_time_s();
      for (std::size_t p = 0; p < points.size(); ++p) {
        answers[p] = evaluator.distance(Capsule::point(points[p]), &row.count);
      }
      row.evaluation_s.push_back(processor_time_s() - start_s);
      for (const Answer& answer : answers) {
        if (has_distance(answer.nearest)) {
          row.distances_m.push_back(answer.nearest.distance_m);
        }
      }
    }
  }
  return row;
}

}  // namespace depthgrid::lab
