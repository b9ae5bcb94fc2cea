// How many evaluations of nine control points a second the letter's method reaches on one core, and how it grows with
// the number of cameras, on workload W.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

#include "depthgrid/grid/evaluation.hpp"
#include "machine.hpp"
#include "workload.hpp"

namespace {

using namespace depthgrid;

struct Row {
  std::string name;
  int cameras = 0;
  std::vector<double> seconds;      ///< one evaluation of all nine points
  std::vector<double> update_s;     ///< one frame set
  std::vector<double> distances_m;  ///< rho where beyond
  grid::EvaluationCount count;
  std::int64_t evaluations = 0;
};

double quantile(std::vector<double> values, double q) {
  if (values.empty()) {
    return 0;
  }
  const auto at = static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

/// CPU time of this thread in seconds: what other programs take of the core does not count.
double cpu_time_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Row measure(const bench::Workload& workload, int cameras, const std::string& name,
            const grid::EvaluationSettings& settings, int repetitions) {
  Row row;
  row.name = name;
  row.cameras = cameras;
  Rig rig = workload.rig();
  rig.cameras.resize(static_cast<std::size_t>(cameras));
  grid::GridEvaluator evaluator(rig, 0, {0.2882, 0.01, 0.0, 343}, settings);
  std::vector<grid::Evaluation> answers(bench::kWorkloadControlPoints);
  std::uint64_t seed = 1;
  for (int set = 0; set < workload.frame_sets(); ++set) {
    const auto frames = workload.frames(set).first(static_cast<std::size_t>(cameras));
    const double update_start = cpu_time_s();
    evaluator.update(frames);
    row.update_s.push_back(cpu_time_s() - update_start);
    for (int i = 0; i < repetitions; ++i) {
      const auto points =
          bench::random_workload_points(bench::Workload::time_s(set), bench::kWorkloadControlPoints, seed++);
      const double start = cpu_time_s();
      evaluator.evaluate(points, answers, &row.count);
      row.seconds.push_back(cpu_time_s() - start);
      ++row.evaluations;
      for (const grid::Evaluation& answer : answers) {
        if (has_distance(answer.nearest)) {
          row.distances_m.push_back(answer.nearest.distance_m);
        }
      }
    }
  }
  return row;
}

void print(const Row& row) {
  const double n = static_cast<double>(row.evaluations);
  double total = 0;
  for (const double s : row.seconds) {
    total += s;
  }
  std::printf("| %s | %d | %.0f | %.2f / %.2f / %.2f | %.2f | %.0f | %.0f | %.0f %% | %.0f / %.0f / %.0f |\n",
              row.name.c_str(), row.cameras, n / total, 1e3 * quantile(row.seconds, 0.5),
              1e3 * quantile(row.seconds, 0.99), 1e3 * quantile(row.seconds, 1), 1e3 * quantile(row.update_s, 0.5),
              static_cast<double>(row.count.pixels) / n, static_cast<double>(row.count.cells) / n,
              100.0 * static_cast<double>(row.count.gray_pixels) /
                  static_cast<double>(std::max<std::int64_t>(row.count.pixels, 1)),
              1e3 * quantile(row.distances_m, 0.1), 1e3 * quantile(row.distances_m, 0.5),
              1e3 * quantile(row.distances_m, 0.9));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Rate of the letter's evaluation of nine control points on workload W, one core."};
  int sets = bench::kWorkloadFrameSets;
  int repetitions = 20;
  std::vector<int> camera_counts{1, 2, 4, 8};
  app.add_option("--frame-sets", sets, "frame sets rendered")->check(CLI::Range(1, 1000))->capture_default_str();
  app.add_option("--repetitions", repetitions, "evaluations a frame set, control points drawn anew each time")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  app.add_option("--cameras", camera_counts, "numbers of cameras")->delimiter(',')->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  const bench::Workload workload(*std::max_element(camera_counts.begin(), camera_counts.end()), sets);
  std::printf("%s\n\n", bench::machine_line().c_str());
  std::printf(
      "| method | cameras | evaluations/s | ms a nine points: median / 99 %% / max | ms a frame set | pixels | cells | "
      "gray | distance mm: 10 / 50 / 90 %% |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const bool letter : {true, false}) {
    for (const bool hybrid : {true, false}) {
      for (const int cameras : camera_counts) {
        grid::EvaluationSettings settings;
        settings.variant = letter ? grid::Variant::letter : grid::Variant::corrected;
        settings.collect = hybrid ? grid::Collect::hybrid : grid::Collect::minimum;
        settings.sensor.lateral_px = 0;
        print(measure(workload, cameras,
                      std::string(letter ? "letter" : "corrected") + (hybrid ? ", hybrid" : ", minimum"), settings,
                      letter ? repetitions : std::max(1, repetitions / 10)));
        std::fflush(stdout);
      }
    }
  }
  return 0;
}
