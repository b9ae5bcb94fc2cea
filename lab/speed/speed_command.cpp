// The benchmark: the sound search's figures, and what would be used instead beside it, in one run. Writes all numbers
// as JSON, and from them the page and its plots.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "lab/commands.hpp"
#include "lab/measure/clocks.hpp"
#include "lab/speed/goals.hpp"
#include "lab/speed/number_text.hpp"
#include "lab/speed/our_figures.hpp"
#include "lab/speed/page.hpp"
#include "lab/speed/plots.hpp"
#include "lab/speed/side_by_side.hpp"
#include "lab/speed/sweeps.hpp"
#include "report/machine.hpp"
#include "report/progress_line.hpp"

namespace depthgrid::lab {
namespace {

struct SpeedOptions {
  bool quick = false;
  bool check = false;
  std::vector<int> cameras;
  std::string from;
  std::string json;
  std::string page;
  std::string images;
};

constexpr double kLateS = 20 * 60.0;  ///< from then on rows are cut short, so that a run ends within half an hour

/// How much is measured.
struct Plan {
  int frame_sets = kWorkloadFrameSets;
  std::vector<int> cameras{1, 2, 4, 8};
  OurPlan ours;
  SideBySidePlan side_by_side;
  SweepPlan sweeps;
  std::vector<std::string> skipped;  ///< peers
  int most_foreign_cameras = 8;
};

/// About a minute. The slowest peers, and most numbers of cameras, are left out.
Plan quick_plan() {
  Plan plan;
  plan.frame_sets = 2;
  plan.cameras = {2, 8};
  plan.ours = {20, 2, 2, 0.3};
  plan.side_by_side = {2, 0.5};
  plan.sweeps = {1, 3, 0.1};
  plan.most_foreign_cameras = 2;
  plan.skipped = {"corrected, hybrid", "OctoMap 2 cm + EDT", "OctoMap 2 cm + EDT, unknown occupied",
                  "OctoMap 2 cm + FCL sphere"};
  return plan;
}

std::vector<PeerKind> all_peers(const Plan& plan) {
  std::vector<PeerKind> kinds = own_peers();
  for (PeerKind& kind : foreign_peers()) {
    kind.most_cameras = std::min(kind.most_cameras, plan.most_foreign_cameras);
    kinds.push_back(std::move(kind));
  }
  kinds.erase(std::remove_if(kinds.begin(), kinds.end(),
                             [&plan](const PeerKind& kind) {
                               return std::find(plan.skipped.begin(), plan.skipped.end(), kind.name) !=
                                      plan.skipped.end();
                             }),
              kinds.end());
  return kinds;
}

Report measure(const Plan& plan) {
  const std::vector<PeerKind> kinds = all_peers(plan);
  const std::vector<PeerKind> swept =
      select(kinds, {"search", "letter, minimum", "lattice 20 mm", "maximum of the cameras' scans",
                     "scan of the arm box's cloud", "nanoflann, cell", "OctoMap 5 cm + EDT"});
  // Weights of the progress line only; a run of another length keeps its proportions.
  const double per_stage_s = 4 + 4 * plan.ours.limit_s;
  const double per_row_s = plan.side_by_side.limit_s * 0.4;
  const auto stages = static_cast<double>(plan.cameras.size());
  const double total_s = 0.1 * plan.frame_sets * 24 + 3 * stages * per_stage_s +
                         (stages + 2) * static_cast<double>(kinds.size()) * per_row_s + 8 * per_row_s;
  report::ProgressLine line("speed", 100);
  const Stopwatch watch;
  double done_s = 0;
  double current_s = 0;
  const auto step = [&](const std::string& what, double expected_s) {
    done_s += std::exchange(current_s, expected_s);
    line.update(static_cast<std::size_t>(std::min(100.0, 100 * done_s / total_s)), what);
  };
  Report report;
  report.about["machine"] = report::machine_line();

  step("rendering", 0.1 * plan.frame_sets * 24);
  const int rendered = std::max(2, *std::max_element(plan.cameras.begin(), plan.cameras.end()));  // 2: for the sweeps
  const Rig rig = workload_rig(rendered);
  const Workload workload(rendered, plan.frame_sets);
  const Workload without_robot(rig, plan.frame_sets, 0, {}, RobotInView::removed);
  const Workload padded(rig, plan.frame_sets, kNoisyRobotPadding);
  const NoisyWorkload noise(padded);
  const OurMargins ideal{{0, 0, 0, 1}, {}};
  const OurMargins covering{noise_margin(), {0.005, 0.001, 0}};
  for (const int cameras : plan.cameras) {
    const std::string with = ", " + std::to_string(cameras) + " cameras";
    Stage clean(workload, nullptr, cameras);
    Stage removed(without_robot, nullptr, cameras);
    Stage noisy(padded, &noise, cameras);
    const auto measure_one = [&](Stage& stage, const WorkloadName& name, const OurMargins& margins) {
      step(std::string("ours, ") + name.key + with, per_stage_s);
      measure_ours(stage, name.key, margins, plan.ours, report);
      if (cameras == 2) {
        measure_budget_bounds(stage, name.key, margins, report);
        measure_remembered(stage, name.key, margins, plan.ours, report);
      }
      if (&stage != &noisy) {
        measure_beside_letter(stage, name.key, plan.ours, report);
      }
    };
    measure_one(clean, kWorkloadNames[0], ideal);
    measure_one(removed, kWorkloadNames[1], ideal);
    measure_one(noisy, kWorkloadNames[2], covering);
    measure_adversarial(clean, plan.ours, report);
    for (const PeerKind& kind : kinds) {
      const auto beside = [&](Stage& stage, const WorkloadName& name) {
        step(kind.name + with + ", " + name.key, per_row_s);
        SideBySidePlan row_plan = plan.side_by_side;
        row_plan.limit_s = watch.elapsed_s() > kLateS ? std::min(row_plan.limit_s, 1.0) : row_plan.limit_s;
        measure_side_by_side(stage, kind, name.key, row_plan, report);
      };
      if (cameras > kind.most_cameras) {
        continue;
      }
      beside(clean, kWorkloadNames[0]);
      if (cameras == 2) {
        beside(removed, kWorkloadNames[1]);
        beside(noisy, kWorkloadNames[2]);
      }
    }
  }
  Stage two(workload, nullptr, 2);
  step("number of points", 2 * per_row_s);
  sweep_points(two, swept, plan.sweeps, report);
  step("rho", 2 * per_row_s);
  sweep_rho(two, swept, plan.sweeps, report);
  step("resolution", 2 * per_row_s);
  sweep_resolution(two, plan.sweeps, report);
  step("size of the images", 2 * per_row_s);
  sweep_image(swept, plan.sweeps, report);
  report.about["run"] = std::to_string(plan.frame_sets) + " frame sets, " +
                        report::three_digits(watch.elapsed_s() / 60) + " minutes" +
                        (plan.skipped.empty() ? "." : "; a quick run: its figures are no measurement.");
  return report;
}

void run(const SpeedOptions& options) {
  Plan plan = options.quick ? quick_plan() : Plan();
  if (!options.cameras.empty()) {
    plan.cameras = options.cameras;
  }
  const Report report = !options.from.empty() ? read_json(options.from) : measure(plan);
  if (!options.json.empty()) {
    write_json(options.json, report);
  }
  if (!options.images.empty()) {
    draw_plots(options.images, report);
  }
  if (!options.page.empty()) {
    write_page(options.page, options.images, report);
  }
  const std::string broken = options.check ? broken_claim(report) : std::string();
  if (!broken.empty()) {
    fail(broken);
  }
}

}  // namespace

void add_speed_command(CLI::App& app) {
  const auto options = std::make_shared<SpeedOptions>();
  CLI::App* const command = app.add_subcommand(
      "speed", "the sound search beside what would be used instead, one core: at most 30 minutes, --quick about one");
  command->add_flag("--quick", options->quick, "for looking at the page, not at its figures");
  command
      ->add_option("--cameras", options->cameras,
                   "numbers of cameras (default 1,2,4,8; quick 2,8); goals and most tables want 2")
      ->delimiter(',')
      ->check(CLI::Range(1, kWorkloadCameras));
  command->add_flag("--check", options->check, "fail unless generous ratios hold (never absolute times)");
  command->add_option("--from", options->from, "measure nothing, take the numbers from this JSON file");
  command->add_option("--json", options->json,
                      "write all numbers; those of BENCHMARK.md are lab/results/benchmark.json");
  CLI::Option* const page = command->add_option("--page", options->page, "write the page (Markdown); needs --images");
  page->needs(command->add_option("--images", options->images,
                                  "draw the plots into this folder, named in the page as given here"));
  command->callback([options] { run(*options); });
}

}  // namespace depthgrid::lab
