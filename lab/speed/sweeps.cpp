#include "lab/speed/sweeps.hpp"

#include <algorithm>
#include <array>

#include "lab/measure/clocks.hpp"
#include "lab/measure/samples.hpp"
#include "lab/peers/lattice_peer.hpp"
#include "lab/peers/search_peer.hpp"

namespace depthgrid::lab {
namespace {

constexpr double kNotRepeated = 0.1;  ///< seconds for one frame set or query: not repeated

/// What one value of x asks.
struct Question {
  std::size_t points = kWorkloadControlPoints;
  double rho_m = kRho;
  bool with_errors = false;
};

/// One peer at one value of x.
void measure(Stage& stage, Peer& peer, const Question& question, const SweepPlan& plan, Record& record) {
  const std::size_t count = question.points;
  Region region = stage.arm_region();  // grown by kRho
  region.low_world.array() -= question.rho_m - kRho;
  region.high_world.array() += question.rho_m - kRho;
  Samples prepare_s;
  Samples query_s;
  Samples over_m;
  Samples under_m;
  std::vector<double> distances_m(std::max(count, kWorkloadControlPoints));
  const std::span<double> answers(distances_m);
  const Stopwatch watch;
  for (int set = 0; set < std::min(plan.frame_sets, stage.frame_sets()); ++set) {
    prepare_s.add(timed_s([&] { peer.prepare(stage.frames(set), region); }));
    for (int i = 0; i < plan.repetitions; ++i) {
      const auto points =
          random_workload_points(Workload::time_s(set), count, static_cast<std::uint64_t>(set * 1000 + i + 1));
      query_s.add(timed_s([&] { peer.query(points, answers.first(count)); }));
      if (query_s.median() > kNotRepeated || watch.elapsed_s() > plan.limit_s) {
        break;
      }
    }
    for (const int sub_step : {0, kSubSteps / 2}) {
      if (!question.with_errors) {
        break;
      }
      peer.query(stage.points(set, sub_step), answers.first(kWorkloadControlPoints));
      const auto& truths = stage.truths(set, sub_step);
      for (std::size_t i = 0; i < truths.size(); ++i) {
        over_m.add(std::max(0.0, answers[i] - truths[i].hi_m));
        under_m.add(std::max(0.0, truths[i].lo_m - answers[i]));
      }
    }
    if (prepare_s.median() > kNotRepeated || watch.elapsed_s() > plan.limit_s) {
      break;
    }
  }
  prepare_s.describe("prepare", "s", record.numbers);
  query_s.describe("query", "s", record.numbers);
  if (question.with_errors) {
    over_m.describe("over", "m", record.numbers);
    under_m.describe("under", "m", record.numbers);
  }
}

Record row(const char* group, const std::string& name, double x) {
  return {std::string("sweep: ") + group, name, {{"x", x}}, {}};
}

/// The workload's cameras with images of another size and the same horizontal view.
Rig resized(int width_px, int height_px) {
  Rig rig = workload_rig(2);
  for (RigCamera& camera : rig.cameras) {
    const double focal_px = camera.intrinsics.fx_px * width_px / camera.intrinsics.width_px;
    camera.intrinsics =
        from_opencv(width_px, height_px, focal_px, focal_px, 0.5 * (width_px - 1), 0.5 * (height_px - 1));
  }
  return rig;
}

}  // namespace

std::vector<PeerKind> select(const std::vector<PeerKind>& kinds, const std::vector<std::string>& names) {
  std::vector<PeerKind> selected;
  for (const std::string& name : names) {
    const auto found =
        std::find_if(kinds.begin(), kinds.end(), [&name](const PeerKind& kind) { return kind.name == name; });
    if (found != kinds.end()) {
      selected.push_back(*found);
    }
  }
  return selected;
}

void sweep_points(Stage& stage, const std::vector<PeerKind>& kinds, const SweepPlan& plan, Report& report) {
  for (const PeerKind& kind : kinds) {
    const std::unique_ptr<Peer> peer = kind.make(stage.setting());
    for (const std::size_t count : {1U, 3U, 9U, 30U, 100U, 300U}) {
      Record record = row("points", kind.name, static_cast<double>(count));
      measure(stage, *peer, {count, kRho, false}, plan, record);
      report.records.push_back(std::move(record));
    }
  }
}

void sweep_rho(Stage& stage, const std::vector<PeerKind>& kinds, const SweepPlan& plan, Report& report) {
  for (const PeerKind& kind : kinds) {
    for (const double rho_m : {0.1, 0.2, 0.4, 0.6, 0.8}) {
      PeerSetting setting = stage.setting();
      setting.rho_m = rho_m;
      Record record = row("rho", kind.name, rho_m);
      measure(stage, *kind.make(setting), {kWorkloadControlPoints, rho_m, false}, plan, record);
      report.records.push_back(std::move(record));
    }
  }
}

void sweep_resolution(Stage& stage, const SweepPlan& plan, Report& report) {
  for (const int lateral_px : {1, 0}) {
    for (const double resolution_m : {0.002, 0.003, 0.005, 0.01, 0.02, 0.04}) {
      PeerSetting setting = stage.setting();
      setting.sensor.lateral_px = lateral_px;
      SearchPeer ours(setting, resolution_m);
      Record record = row("resolution", lateral_px == 1 ? "search" : "search, w = 0", resolution_m);
      measure(stage, ours, {kWorkloadControlPoints, kRho, true}, plan, record);
      report.records.push_back(std::move(record));
    }
  }
  for (const double pitch_m : {0.01, 0.015, 0.02, 0.03, 0.04}) {
    LatticePeer lattice(stage.setting(), pitch_m);
    Record record = row("resolution", "lattice", pitch_m);
    measure(stage, lattice, {kWorkloadControlPoints, kRho, true}, plan, record);
    report.records.push_back(std::move(record));
  }
}

void sweep_image(const std::vector<PeerKind>& kinds, const SweepPlan& plan, Report& report) {
  constexpr std::array<std::array<int, 2>, 5> kSizes{{{160, 120}, {320, 240}, {640, 480}, {848, 480}, {1280, 720}}};
  for (const auto& [width_px, height_px] : kSizes) {
    const Workload workload(resized(width_px, height_px), std::min(3, plan.frame_sets), kWorkloadRobotPadding);
    Stage stage(workload, nullptr, 2);
    for (const PeerKind& kind : kinds) {
      Record record = row("image", kind.name, static_cast<double>(width_px) * height_px);
      record.texts["size"] = std::to_string(width_px) + " x " + std::to_string(height_px);
      measure(stage, *kind.make(stage.setting()), {}, plan, record);
      report.records.push_back(std::move(record));
    }
  }
}

}  // namespace depthgrid::lab
