#include "our_figures.hpp"

#include <algorithm>
#include <functional>
#include <random>

#include "bench/peers/search_peer.hpp"
#include "depthgrid/grid/evaluation.hpp"
#include "samples.hpp"

namespace depthgrid::bench {
namespace {

constexpr double kResolution = 0.005;

using Questions = std::vector<search::Primitive>;

Questions as_points(const std::vector<Eigen::Vector3d>& points_world) {
  Questions questions(points_world.size());
  std::transform(points_world.begin(), points_world.end(), questions.begin(), search::point);
  return questions;
}

Questions as_links(double time_s) {
  Questions questions;
  for (const simulation::Capsule& link : workload_arm(time_s).links) {
    questions.push_back(search::capsule(link.a_world, link.b_world, link.radius_m));
  }
  return questions;
}

/// Calls of one kind of question over all frame sets.
struct Calls {
  Samples call_s;
  Samples first_s;  ///< those right after a frame set
  search::Count count;
  double total_s = 0;
  double answers = 0;
  double stopped = 0;  ///< answers that a budget stopped

  void ask(SearchPeer& ours, const Questions& questions, bool hybrid, bool first, const search::Budget& budget = {}) {
    std::vector<search::Answer>& scratch = answers_;
    scratch.resize(questions.size());
    const double time_s = timed_s([&] {
      if (hybrid) {
        ours.search().hybrid(ours.snapshot(), questions, scratch, budget, &count);
      } else {
        ours.search().distances(ours.snapshot(), questions, scratch, budget, &count);
      }
    });
    call_s.add(time_s);
    total_s += time_s;
    if (first) {
      first_s.add(time_s);
    }
    answers += static_cast<double>(scratch.size());
    stopped += static_cast<double>(std::count_if(scratch.begin(), scratch.end(),
                                                 [](const search::Answer& answer) { return answer.nearest.budget; }));
  }
  [[nodiscard]] const std::vector<search::Answer>& last() const { return answers_; }

  [[nodiscard]] Record record(const std::string& group, const std::string& name, int cameras) const {
    Record record{group, name, {}, {}};
    record.numbers["cameras"] = cameras;
    call_s.describe("call", "s", record.numbers);
    first_s.describe("first", "s", record.numbers);
    record.numbers["calls_per_s"] = 1 / call_s.mean();
    const auto calls = static_cast<double>(call_s.count());
    record.numbers["nodes_mean"] = static_cast<double>(count.nodes) / calls;
    record.numbers["ball_tests_mean"] = static_cast<double>(count.ball_tests) / calls;
    record.numbers["stopped_share"] = stopped / answers;
    return record;
  }

 private:
  std::vector<search::Answer> answers_;
};

/// Questions of repetition i after a frame set; none: the kind is left out of this set.
using Ask = std::function<Questions(int set, int repetition)>;

void measure_kind(Stage& stage, SearchPeer& ours, const std::string& group, const std::string& name, int repetitions,
                  bool hybrid, double limit_s, const Ask& ask, Report& report) {
  Calls calls;
  for (int set = 0; set < stage.frame_sets(); ++set) {
    ours.prepare(stage.frames(set), stage.arm_region());
    // Every frame set has its share of the time, and at least one call.
    const double until_s = limit_s * (set + 1) / stage.frame_sets();
    for (int i = 0; i == 0 || (i < repetitions && calls.total_s < until_s); ++i) {
      const Questions questions = ask(set, i);
      if (!questions.empty()) {
        calls.ask(ours, questions, hybrid, i == 0);
      }
    }
  }
  report.records.push_back(calls.record(group, name, stage.cameras()));
}

/// A time between a frame set and the next.
double time_between_s(int set, int repetition) {
  return Workload::time_s(set) + (repetition % kSubSteps) / (kSubSteps * kWorkloadRate);
}

std::uint64_t seed_of(int set, int repetition) { return static_cast<std::uint64_t>(set) * 100003 + 17 + repetition; }

void measure_images(Stage& stage, SearchPeer& ours, const std::string& group, Report& report) {
  Samples image_s;
  Samples cycle_s;
  Calls nine;
  for (int set = 0; set < stage.frame_sets(); ++set) {
    const std::span<const Frame> frames = stage.frames(set);
    const double start_s = cpu_time_s();
    ours.prepare(frames, stage.arm_region());
    nine.ask(ours, as_points(stage.points(set, 0)), false, true);
    cycle_s.add(cpu_time_s() - start_s);
    for (std::size_t k = 0; k < frames.size(); ++k) {
      image_s.add(timed_s([&] { ours.store().update(k, frames[k]); }));
    }
  }
  Record image{group, "image in", {{"cameras", stage.cameras()}}, {}};
  image_s.describe("call", "s", image.numbers);
  report.records.push_back(std::move(image));
  Record cycle{group, "cycle", {{"cameras", stage.cameras()}}, {}};
  cycle_s.describe("call", "s", cycle.numbers);
  report.records.push_back(std::move(cycle));
}

/// One image a camera without a scene: each pixel is what `pixel` says, in millimetres.
struct ImageSet {
  template <class Pixel>
  ImageSet(const Rig& rig, Pixel pixel) {
    for (const RigCamera& camera : rig.cameras) {
      const int width_px = camera.intrinsics.width_px;
      const int height_px = camera.intrinsics.height_px;
      auto& image = images.emplace_back(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px));
      std::generate(image.begin(), image.end(), [&pixel] { return static_cast<std::uint16_t>(pixel()); });
      frames.push_back({depth_view(std::span<const std::uint16_t>(image), width_px, height_px, 0.001), {}, 0.0});
    }
  }
  std::vector<std::vector<std::uint16_t>> images;
  std::vector<Frame> frames;
};

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

void measure_beside_letter(Stage& stage, const OurPlan& plan, Report& report) {
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
  std::vector<grid::Evaluation> answers(kWorkloadControlPoints);
  const Stopwatch watch;
  for (int set = 0; set < stage.frame_sets(); ++set) {
    ours.prepare(stage.frames(set), stage.arm_region());
    hybrid.update(stage.frames(set));
    minimum.update(stage.frames(set));
    const double until_s = 2 * plan.limit_s * (set + 1) / stage.frame_sets();
    for (int i = 0; i == 0 || (i < plan.letter_repetitions && watch.elapsed_s() < until_s); ++i) {
      const auto points = random_workload_points(time_between_s(set, i), kWorkloadControlPoints, seed_of(set, i));
      our_distances.ask(ours, as_points(points), false, i == 0);
      hybrid_s.add(timed_s([&] { hybrid.evaluate(points, answers); }));
      our_hybrid.ask(ours, as_points(points), true, false);
      minimum_s.add(timed_s([&] { minimum.evaluate(points, answers); }));
    }
  }
  const auto add = [&](const char* name, const Samples& times_s) {
    Record record{"beside the letter", name, {{"cameras", stage.cameras()}}, {}};
    times_s.describe("call", "s", record.numbers);
    report.records.push_back(std::move(record));
  };
  add("search", our_distances.call_s);
  add("search, hybrid", our_hybrid.call_s);
  add("letter, hybrid", hybrid_s);
  add("letter, minimum", minimum_s);
}

void measure_adversarial(Stage& stage, const OurPlan& plan, Report& report) {
  PeerSetting setting = stage.setting();
  setting.sensor.lateral_px = 1;
  SearchPeer ours(setting, kResolution);
  // Images of the same size without a scene; no robot.
  std::mt19937_64 generator(3);
  const ImageSet random(stage.rig(), [&generator] { return 500 + generator() % 3500; });
  const ImageSet holes(stage.rig(), [&generator] { return generator() % 100 == 0 ? 0 : 6000; });
  const ImageSet nothing(stage.rig(), [] { return 0; });
  std::vector<Eigen::Vector3d> at_cameras;
  for (std::size_t i = 0; i < kWorkloadControlPoints; ++i) {
    // As near to the camera as the cell allows: those of the workload stand outside of it.
    const Region cell = workload_cell();
    const Eigen::Vector3d centre = stage.rig().cameras[i % stage.rig().cameras.size()].T_world_camera.translation();
    at_cameras.push_back(centre.cwiseMax(cell.low_world).cwiseMin(cell.high_world));
  }
  struct Case {
    const char* name;
    std::span<const Frame> frames;
    std::vector<Eigen::Vector3d> points;
  };
  const std::vector<Case> cases{
      {"every pixel at random", random.frames, stage.points(0, 0)},
      {"free but for one pixel in a hundred", holes.frames, stage.points(0, 0)},
      {"nothing measured", nothing.frames, stage.points(0, 0)},
      {"points at the cameras", stage.frames(0), at_cameras},
      {"nothing within rho", stage.frames(0), stage.far_points(0)},
  };
  for (const Case& one : cases) {
    if (one.points.size() < kWorkloadControlPoints) {
      continue;
    }
    for (const double budget_s : {0.0, 0.0003}) {
      ours.prepare(one.frames, stage.arm_region());
      Calls calls;
      const Stopwatch watch;
      for (int i = 0; i < 3 || (i < plan.repetitions / 4 && watch.elapsed_s() < 0.2 * plan.limit_s); ++i) {
        calls.ask(ours, as_points(one.points), false, i == 0, {0, budget_s});
      }
      Record record = calls.record("adversarial", one.name, stage.cameras());
      record.numbers["budget_s"] = budget_s;
      report.records.push_back(std::move(record));
    }
  }
}

}  // namespace depthgrid::bench
