// How many evaluations of nine control points a second the grid evaluators reach on one core, and how that grows with
// the number of cameras, on workload W. Writes docs/benchmark.md and its plot.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

#include "lab/letter/letter_rate_page.hpp"
#include "lab/letter/letter_rate_rows.hpp"

int main(int argc, char** argv) {
  using namespace depthgrid;
  CLI::App app{"Rate of the grid evaluators with nine control points on workload W, one core."};
  int sets = lab::kWorkloadFrameSets;
  int repetitions = 20;
  std::vector<int> camera_counts{1, 2, 4, 8};
  std::string page;
  std::string plot;
  bool check = false;
  app.add_option("--frame-sets", sets, "frame sets rendered")->check(CLI::Range(1, 1000))->capture_default_str();
  app.add_option("--repetitions", repetitions, "evaluations a frame set, control points drawn anew each time")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  app.add_option("--cameras", camera_counts, "numbers of cameras")
      ->delimiter(',')
      ->check(CLI::Range(1, lab::kWorkloadCameras))
      ->capture_default_str();
  app.add_option("--page", page, "also write the page (Markdown)");
  app.add_option("--plot", plot, "also draw the plot (PNG)");
  app.add_flag("--check", check,
               "fail unless the minimum saves cells and cells grow no faster than cameras (never times)");
  CLI11_PARSE(app, argc, argv);

  try {
    std::fprintf(stderr, "rendering %d frame sets\n", sets);
    const lab::Workload workload(*std::max_element(camera_counts.begin(), camera_counts.end()), sets);
    std::vector<lab::RateRow> rows;
    std::cout << lab::rate_table_head();
    for (const lab::RateMethod& method : lab::rate_methods()) {
      for (const int cameras : camera_counts) {
        rows.push_back(lab::measure_rate(workload, cameras, method, repetitions));
        std::cout << lab::rate_table_row(rows.back()) << std::flush;
      }
    }
    if (!plot.empty()) {
      lab::draw_rate_plot(plot, rows);
    }
    if (!page.empty()) {
      lab::write_rate_page(page, rows, sets);
    }
    if (check) {
      const std::string broken = lab::broken_ratio(rows);
      if (!broken.empty()) {
        std::cerr << "depthgrid_letter_rate: " << broken << '\n';
        return 1;
      }
    }
  } catch (const std::exception& error) {
    std::cerr << "depthgrid_letter_rate: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
