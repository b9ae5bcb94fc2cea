// The search with a memory of what was seen free, on frame sets in the order of their times.
#include <algorithm>

#include "depthgrid/search/search_evaluator.hpp"
#include "lab/speed/calls.hpp"
#include "lab/speed/our_figures.hpp"

namespace depthgrid::lab {
namespace {

constexpr double kSmallest_m = 0.05;       ///< obstacle; the sensor models of structured light recommend it
constexpr double kVMax_m_s = 2.0;          ///< of people
constexpr double kHalfExposure_s = 0.008;  ///< at that speed 16 mm
constexpr int kFilling = 5;  ///< frame sets before anything is asked: the memory begins with nothing known

search::SearchEvaluator remembering(const PeerSetting& setting) {
  views::Settings settings = search_settings(setting, kResolution);
  settings.v_max_m_s = kVMax_m_s;
  for (CameraMargins& margins : settings.margins) {
    margins.smallest_obstacle_m = kSmallest_m;
    margins.half_exposure_s = kHalfExposure_s;
  }
  search::EvaluatorOptions options;
  options.memory.emplace();
  options.memory->low_world = setting.cell.low_world;
  options.memory->high_world = setting.cell.high_world;
  options.memory->start = memory::StartUnknown{};
  return {setting.rig, settings, options};
}

}  // namespace

void measure_remembered(Stage& stage, const std::string& workload, const OurMargins& margins, const OurPlan& plan,
                        Report& report) {
  PeerSetting setting = stage.setting();
  setting.sensor = margins.sensor;
  setting.pose = margins.pose;
  search::SearchEvaluator evaluator = remembering(setting);
  std::vector<Answer> answers(kWorkloadControlPoints);
  Samples call_s;
  Samples first_s;
  Samples image_s;
  double nothing_near = 0;
  const int repetitions = std::max(1, plan.repetitions);
  for (int set = 0; set < stage.frame_sets(); ++set) {
    const std::span<const Frame> frames = stage.frames(set);
    for (std::size_t k = 0; k < frames.size(); ++k) {
      image_s.add(timed_s([&] { (void)evaluator.update(k, frames[k]); }));
    }
    double spent_s = 0;
    for (int i = 0; set >= std::min(kFilling, stage.frame_sets() - 1) && i < repetitions &&
                    spent_s < plan.limit_s / stage.frame_sets();
         ++i) {
      const double time_s = time_between_s(set, i);
      const Questions questions = as_points(random_workload_points(time_s, kWorkloadControlPoints, seed_of(set, i)));
      const double call = timed_s([&] { evaluator.evaluate(questions, time_s, answers); });
      call_s.add(call);
      spent_s += call;
      if (i == 0) {
        first_s.add(call);
      }
      for (const Answer& answer : answers) {
        nothing_near += answer.nearest.state == ProximityState::beyond_rho ? 1 : 0;
      }
    }
  }
  Record record{"ours, " + workload, "nine points, with a memory", {}, {}};
  record.numbers["cameras"] = stage.cameras();
  call_s.describe("call", "s", record.numbers);
  first_s.describe("first", "s", record.numbers);
  image_s.describe("image", "s", record.numbers);
  record.numbers["calls_per_s"] = 1 / call_s.mean();
  record.numbers["nothing_near_share"] = nothing_near / static_cast<double>(call_s.count() * answers.size());
  report.records.push_back(std::move(record));
}

}  // namespace depthgrid::lab
