#include "lab/experiments/real_task/real_task.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "depthgrid/robot/kuka_lwr4.hpp"
#include "lab/experiments/experiment_report.hpp"
#include "lab/experiments/loop/avoidance_run.hpp"
#include "lab/experiments/stage/declared_rig.hpp"
#include "report/markdown_table.hpp"
#include "report/number_text.hpp"
#include "report/statistics.hpp"

namespace depthgrid::experiments {

using nlohmann::ordered_json;

namespace {

constexpr int kEvaluateEvery = 4;  ///< periods: 8 ms
constexpr double kMoved = 0.01;    ///< sides; with less done there is no ratio

struct Task {
  std::string name;
  RunResult run;
};

std::size_t caused(const RunSummary& run) {
  return static_cast<std::size_t>(std::count_if(run.contacts.begin(), run.contacts.end(), [](const Contact& contact) {
    return caused_by_the_robot(contact.cause);
  }));
}

void add_task(const Task& task, std::uint64_t seed, report::MarkdownTable& table, ordered_json& figures) {
  const RunSummary& run = task.run.summary;
  table.row({task.name, std::to_string(seed), report::fixed(run.task_share, 2), std::to_string(task.run.vertices),
             report::fixed(run.stopped_s, 2), std::to_string(run.contacts.size()), std::to_string(caused(run)),
             report::fixed(run.smallest_person_m, 3),
             std::to_string(run.over_estimates) + " of " + std::to_string(run.compared)});
  figures.push_back({{"seed", seed},
                     {"duration_s", task.run.duration_s},
                     {"vertices", task.run.vertices},
                     {"task_share", run.task_share},
                     {"stopped_s", run.stopped_s},
                     {"contacts", run.contacts.size()},
                     {"contacts_caused_by_the_robot", caused(run)},
                     {"smallest_person_m", std::isfinite(run.smallest_person_m) ? ordered_json(run.smallest_person_m)
                                                                                : ordered_json(nullptr)},
                     {"over_estimates", run.over_estimates},
                     {"periods_compared", run.compared}});
}

std::string median_and_worst(const std::vector<double>& values, double worst_q) {
  return report::fixed(report::quantile(values, 0.5), 3) + " (median), " +
         report::fixed(report::quantile(values, worst_q), 3) + " (worst)";
}

}  // namespace

void run_real_task(const Options& options, ExperimentReport& report) {
  const robot::RobotModel model = robot::kuka_lwr4();
  const int seeds = frames_or(options, 3, 1);
  const double alone_s = options.quick ? 8 : 60;
  const double person_s = options.quick ? 6 : 12;
  const std::string_view sensor = sensor_or(options, "kinect_v1");
  const int width_px = width_or(options, 640, 640);
  report.paragraph("The hexagon of the avoidance experiment (radius 0.2 m, 0.40 m/s), two cameras of " +
                   std::to_string(width_px) + " x " + std::to_string(3 * width_px / 4) +
                   " pixels, 30 Hz, distances every 8 ms; the search with what is declared for " + std::string(sensor) +
                   " and a memory, beside no avoidance and the same loop with ideal sensors and a layer as thick. A "
                   "vertex's time counts "
                   "parts of a side, too.");
  report::MarkdownTable table({"run", "seed", "sides done", "vertices", "stopped, s", "contacts", "caused by the robot",
                               "smallest distance to the person, m", "held for more than 1 cm too far, periods"});
  RunSettings run;
  const auto with = [&](std::string_view name, double duration_s, std::uint64_t seed) {
    run.common = sensor_settings(name, width_px);
    run.common.evaluate_every = kEvaluateEvery;
    run.common.memory_padding_m = thin_padding_m(sensor);  // so that nothing but the images differs
    run.duration_s = duration_s;
    run.seed = seed;
    return run;
  };
  const std::size_t total = 1 + 3 * static_cast<std::size_t>(seeds);
  std::size_t done = 0;
  const auto step = [&] { options.progress(++done, total); };
  const Task free{"nobody, no avoidance",
                  run_avoidance(Method::none, model, nobody(alone_s), with("ideal", alone_s, options.seed))};
  add_task(free, options.seed, table, report.figures()["nobody_no_avoidance"]);
  step();
  std::vector<double> alone;
  std::vector<double> beside_ideal;
  std::size_t contacts_caused = 0;
  for (int i = 0; i < seeds; ++i) {
    const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(i);
    const Task real{"nobody, " + std::string(sensor),
                    run_avoidance(Method::search_memory, model, nobody(alone_s), with(sensor, alone_s, seed))};
    alone.push_back(real.run.summary.task_share > kMoved ? free.run.summary.task_share / real.run.summary.task_share
                                                         : std::numeric_limits<double>::infinity());
    add_task(real, seed, table, report.figures()["nobody"]);
    step();
    const AvoidanceMotion motion = carrying_person(avoidance_rig(2, width_px, "ideal"), person_s, seed + 1);
    const Task ideal{"person with a box, ideal",
                     run_avoidance(Method::search_memory, model, motion, with("ideal", person_s, seed))};
    add_task(ideal, seed, table, report.figures()["person_ideal"]);
    step();
    const Task beside{"person with a box, " + std::string(sensor),
                      run_avoidance(Method::search_memory, model, motion, with(sensor, person_s, seed))};
    add_task(beside, seed, table, report.figures()["person"]);
    step();
    if (ideal.run.summary.task_share > kMoved) {
      beside_ideal.push_back(beside.run.summary.task_share / ideal.run.summary.task_share);
    }
    contacts_caused += caused(beside.run.summary);
  }
  report.figures()["time_a_vertex_beside_no_avoidance"] = alone;
  report.figures()["sides_beside_ideal"] = beside_ideal;
  report.headline("Nobody, " + report::fixed(alone_s) + " s: time a vertex in times of no avoidance " +
                  median_and_worst(alone, 1) + " of " + std::to_string(seeds) + " seeds.");
  report.headline("A person with a box, " + report::fixed(person_s) +
                  " s: sides done in times of the same loop with "
                  "ideal sensors " +
                  median_and_worst(beside_ideal, 0) +
                  "; contacts that the robot caused: " + std::to_string(contacts_caused) + ".");
  report.paragraph(table.text());
}

}  // namespace depthgrid::experiments
