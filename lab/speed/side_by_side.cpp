#include "lab/speed/side_by_side.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "lab/measure/clocks.hpp"
#include "lab/measure/samples.hpp"
#include "lab/peers/search_peer.hpp"
#include "lab/speed/memory.hpp"

namespace depthgrid::lab {
namespace {

constexpr double kSlow = 1.0;         ///< seconds for a frame set: at most three of them
constexpr double kSlowQuery = 0.005;  ///< seconds for nine points: only where the oracle looks
constexpr double kUnmeasured = std::numeric_limits<double>::quiet_NaN();
constexpr int kTruthSubStep = 8;  ///< beside sub-step 0

/// Sub-steps that the oracle knows come first.
constexpr std::array<int, kSubSteps> kOrder{0, kTruthSubStep, 1, 2, 3, 4, 5, 6, 7, 9, 10, 11, 12, 13, 14, 15};

struct Row {
  Samples prepare_s, nine_s, first_s, cycle_s, hundred_s;
  Samples far_s, deep_s;
  Samples our_cycle_s, our_nine_s;
  Samples over_m, under_m;
  double memory_bytes = kUnmeasured;
};

void compare(const std::vector<Stage::Truth>& truths, const std::vector<double>& distances_m, Row& row) {
  for (std::size_t i = 0; i < truths.size(); ++i) {
    row.over_m.add(std::max(0.0, distances_m[i] - truths[i].hi_m));
    row.under_m.add(std::max(0.0, truths[i].lo_m - distances_m[i]));
  }
}

void one_frame_set(Stage& stage, int set, Peer& peer, Row& row) {
  std::vector<double> distances_m(kWorkloadControlPoints);
  const double prepare_s = timed_s([&] { peer.prepare(stage.frames(set), stage.arm_region()); });
  row.prepare_s.add(prepare_s);
  for (const int sub_step : kOrder) {
    const bool known = sub_step == 0 || sub_step == kTruthSubStep;
    if (!known && row.nine_s.median() > kSlowQuery) {
      break;
    }
    const auto points = stage.points(set, sub_step);
    const double query_s = timed_s([&] { peer.query(points, distances_m); });
    row.nine_s.add(query_s);
    if (sub_step == 0) {
      row.first_s.add(query_s);
      row.cycle_s.add(prepare_s + query_s);
    }
    if (known) {
      compare(stage.truths(set, sub_step), distances_m, row);
    }
  }
  if (row.nine_s.median() < kSlowQuery || (row.hundred_s.empty() && row.nine_s.median() < 10 * kSlowQuery)) {
    const auto points = random_workload_points(Workload::time_s(set), 100, static_cast<std::uint64_t>(set) + 1);
    distances_m.resize(points.size());
    row.hundred_s.add(timed_s([&] { peer.query(points, distances_m); }));
  }
}

void our_frame_set(Stage& stage, int set, Peer& ours, Row& row) {
  std::vector<double> distances_m(kWorkloadControlPoints);
  const auto points = stage.points(set, 0);
  const double prepare_s = timed_s([&] { ours.prepare(stage.frames(set), stage.arm_region()); });
  const double query_s = timed_s([&] { ours.query(points, distances_m); });
  row.our_cycle_s.add(prepare_s + query_s);
  row.our_nine_s.add(query_s);
  for (const int sub_step : {kTruthSubStep, 1, 2}) {
    const auto more = stage.points(set, sub_step);
    row.our_nine_s.add(timed_s([&] { ours.query(more, distances_m); }));
  }
}

void special(Stage& stage, Peer& peer, int set, const std::vector<Eigen::Vector3d>& points, Samples& times_s) {
  if (points.size() < kWorkloadControlPoints) {
    return;
  }
  std::vector<double> distances_m(points.size());
  peer.prepare(stage.frames(set), region_of(points));
  double longest_s = 0;
  for (int i = 0; i < 5 && longest_s < 0.2; ++i) {
    longest_s = timed_s([&] { peer.query(points, distances_m); });
    times_s.add(longest_s);
  }
}

}  // namespace

void measure_side_by_side(Stage& stage, const PeerKind& kind, const std::string& workload, const SideBySidePlan& plan,
                          Report& report) {
  PeerSetting our_setting = stage.setting();
  our_setting.sensor.lateral_px = 1;
  SearchPeer ours(our_setting, 0.005);
  const int sets = std::min(plan.most_frame_sets, stage.frame_sets());
  Row row;
  for (int set = 0; set < sets; ++set) {  // the oracle's memory and time are not the peer's
    (void)stage.truths(set, 0);
    (void)stage.truths(set, kTruthSubStep);
  }
  const MemoryPeak peak;
  const std::unique_ptr<Peer> peer = kind.make(stage.setting());
  const Stopwatch watch;
  for (int set = 0; set < sets; ++set) {
    one_frame_set(stage, set, *peer, row);
    if (set == 0) {
      row.memory_bytes = peak.growth_bytes();
    }
    our_frame_set(stage, set, ours, row);
    const bool slow = row.prepare_s.median() > kSlow;
    if ((slow && set >= 2) || (set >= 2 && watch.elapsed_s() > plan.limit_s)) {
      break;
    }
  }
  for (int set = 0; set < std::min(sets, 3) && row.prepare_s.median() < kSlow; ++set) {
    special(stage, *peer, set, stage.far_points(set), row.far_s);
    special(stage, *peer, set, stage.deep_points(set), row.deep_s);
  }

  Record record{"side by side, " + workload, kind.name, {}, {{"family", kind.family}}};
  record.numbers["cameras"] = stage.cameras();
  record.numbers["counts_occluded"] = kind.counts_occluded ? 1 : 0;
  record.numbers["carves"] = kind.carves ? 1 : 0;
  record.numbers["memory_bytes"] = row.memory_bytes;
  row.prepare_s.describe("prepare", "s", record.numbers);
  row.nine_s.describe("nine", "s", record.numbers);
  row.first_s.describe("first", "s", record.numbers);
  row.cycle_s.describe("cycle", "s", record.numbers);
  row.hundred_s.describe("hundred", "s", record.numbers);
  row.far_s.describe("far", "s", record.numbers);
  row.deep_s.describe("deep", "s", record.numbers);
  row.our_cycle_s.describe("our_cycle", "s", record.numbers);
  row.our_nine_s.describe("our_nine", "s", record.numbers);
  row.over_m.describe("over", "m", record.numbers);
  row.under_m.describe("under", "m", record.numbers);
  report.records.push_back(std::move(record));
}

}  // namespace depthgrid::lab
