#include "lab/speed/our_figures.hpp"

#include <algorithm>
#include <functional>

#include "lab/speed/calls.hpp"

namespace depthgrid::lab {
namespace {

/// Questions of repetition i after a frame set; none: the kind is left out of this set.
using Ask = std::function<Questions(int set, int repetition)>;

void measure_kind(Stage& stage, SearchPeer& ours, const std::string& group, const std::string& name, int repetitions,
                  bool hybrid, double limit_s, const Ask& ask, Report& report) {
  Calls calls;
  for (int set = 0; set < stage.frame_sets(); ++set) {
    ours.prepare(stage.frames(set), stage.arm_region());
    // Every frame set has its share of the time, and at least one call.
    const double until_s = limit_s * (set + 1) / stage.frame_sets();
    for (int i = 0; i == 0 || (i < repetitions && calls.total_s() < until_s); ++i) {
      const Questions questions = ask(set, i);
      if (!questions.empty()) {
        calls.ask(ours, questions, hybrid, i == 0);
      }
    }
  }
  report.records.push_back(calls.record(group, name, stage.cameras()));
}

void measure_images(Stage& stage, SearchPeer& ours, const std::string& group, Report& report) {
  Samples image_s;
  Samples cycle_s;
  Calls nine;
  for (int set = 0; set < stage.frame_sets(); ++set) {
    const std::span<const Frame> frames = stage.frames(set);
    const double start_s = processor_time_s();
    ours.prepare(frames, stage.arm_region());
    nine.ask(ours, as_points(stage.points(set, 0)), false, true);
    cycle_s.add(processor_time_s() - start_s);
    for (std::size_t k = 0; k < frames.size(); ++k) {
      image_s.add(timed_s([&] { (void)ours.store().update(k, frames[k]); }));
    }
  }
  Record image{group, "image in", {{"cameras", stage.cameras()}}, {}};
  image_s.describe("call", "s", image.numbers);
  report.records.push_back(std::move(image));
  Record cycle{group, "cycle", {{"cameras", stage.cameras()}}, {}};
  cycle_s.describe("call", "s", cycle.numbers);
  report.records.push_back(std::move(cycle));
}

/// Unsynchronised cameras: their images come in turns, and each call has a snapshot of its own.
void measure_new_snapshots(Stage& stage, SearchPeer& ours, const std::string& group, Report& report) {
  ours.prepare(stage.frames(0), stage.arm_region());
  Calls calls;
  for (int set = 1; set < stage.frame_sets(); ++set) {
    for (int camera = 0; camera < stage.cameras(); ++camera) {
      const auto k = static_cast<std::size_t>(camera);
      ours.renew(k, stage.frames(set)[k]);
      const double time_s = time_between_s(set, camera * kSubSteps / stage.cameras());
      calls.ask(ours, as_points(random_workload_points(time_s, kWorkloadControlPoints, seed_of(set, camera))), false,
                true);
    }
  }
  report.records.push_back(calls.record(group, "nine points, a new snapshot for every call", stage.cameras()));
}

void measure_errors(Stage& stage, SearchPeer& ours, const std::string& group, const OurMargins& margins, int sets,
                    Report& report) {
  Samples over_m;
  Samples under_m;
  double measured = 0;
  Calls calls;
  for (int set = 0; set < std::min(sets, stage.frame_sets()); ++set) {
    const auto oracle = stage.oracle(set, margins.sensor, margins.pose, false);
    ours.prepare(stage.frames(set), stage.arm_region());
    for (const int sub_step : {0, kSubSteps / 2}) {
      const auto points = stage.points(set, sub_step);
      calls.ask(ours, as_points(points), false, false);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const reference::Interval interval = oracle->distance(points[i]);
        const Proximity& answer = calls.last()[i].nearest;
        over_m.add(std::max(0.0, answer.distance_m - interval.hi_m.value_or(kRho)));
        under_m.add(std::max(0.0, interval.lo_m - answer.distance_m));
        measured += answer.state == ProximityState::measured ? 1 : 0;
      }
    }
  }
  Record record{group, "errors", {{"cameras", stage.cameras()}}, {}};
  record.numbers["measured_share"] = measured / static_cast<double>(over_m.count());
  over_m.describe("over", "m", record.numbers);
  under_m.describe("under", "m", record.numbers);
  report.records.push_back(std::move(record));
}

}  // namespace

void measure_ours(Stage& stage, const std::string& workload, const OurMargins& margins, const OurPlan& plan,
                  Report& report) {
  const std::string group = "ours, " + workload;
  PeerSetting setting = stage.setting();
  setting.sensor = margins.sensor;
  setting.pose = margins.pose;
  SearchPeer ours(setting, kResolution);
  const auto measure = [&](const char* name, int repetitions, bool hybrid, const Ask& ask) {
    measure_kind(stage, ours, group, name, repetitions, hybrid, plan.limit_s, ask, report);
  };
  const auto random_points = [](std::size_t count) {
    return [count](int set, int i) {
      return as_points(random_workload_points(time_between_s(set, i), count, seed_of(set, i)));
    };
  };
  measure_images(stage, ours, group, report);
  measure("nine points", plan.repetitions, false, random_points(kWorkloadControlPoints));
  measure_new_snapshots(stage, ours, group, report);
  measure("nine points, hybrid", plan.repetitions / 4, true, random_points(kWorkloadControlPoints));
  measure("100 points", plan.repetitions / 10, false, random_points(100));
  measure("seven link capsules", plan.repetitions / 2, false,
          [](int set, int i) { return as_links(time_between_s(set, i)); });
  // Those of the frame set itself: a special point is special in its own images only.
  const int special_sets = std::min(3, stage.frame_sets());
  measure("nine points, nothing within rho", plan.repetitions, false,
          [&](int set, int) { return set < special_sets ? as_points(stage.far_points(set)) : Questions{}; });
  measure("nine points, deep in occluded space", plan.repetitions, false,
          [&](int set, int) { return set < special_sets ? as_points(stage.deep_points(set)) : Questions{}; });
  measure_errors(stage, ours, group, margins, plan.accuracy_sets, report);
}

}  // namespace depthgrid::lab
