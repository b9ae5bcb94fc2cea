// How many evaluations of nine control points a second the grid evaluators reach on one core, and how that grows with
// the number of cameras, on workload W. Writes docs/benchmark.md and its plot.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "lab/commands.hpp"
#include "lab/letter/letter_rate_page.hpp"
#include "lab/letter/letter_rate_rows.hpp"

namespace depthgrid::lab {
namespace {

struct RateOptions {
  int sets = kWorkloadFrameSets;
  int repetitions = 20;
  std::vector<int> cameras{1, 2, 4, 8};
  std::string page;
  std::string plot;
  bool check = false;
};

void measure_rates(const RateOptions& options) {
  const Workload workload(*std::max_element(options.cameras.begin(), options.cameras.end()), options.sets);
  std::vector<RateRow> rows;
  std::cout << rate_table_head();
  for (const RateMethod& method : rate_methods()) {
    for (const int cameras : options.cameras) {
      rows.push_back(measure_rate(workload, cameras, method, options.repetitions));
      std::cout << rate_table_row(rows.back()) << std::flush;
    }
  }
  if (!options.plot.empty()) {
    draw_rate_plot(options.plot, rows);
  }
  if (!options.page.empty()) {
    write_rate_page(options.page, rows, options.sets);
  }
  const std::string broken = options.check ? broken_ratio(rows) : std::string();
  if (!broken.empty()) {
    fail(broken);
  }
}

}  // namespace

void add_letter_rate_command(CLI::App& letter) {
  const auto options = std::make_shared<RateOptions>();
  CLI::App* const command = letter.add_subcommand(
      "rate",
      "evaluations a second of the grid evaluators with nine control points on workload W, one core: some minutes");
  command->add_option("--frame-sets", options->sets, "frame sets rendered")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--repetitions", options->repetitions,
                   "evaluations a frame set, control points drawn anew each time")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--cameras", options->cameras, "numbers of cameras")
      ->delimiter(',')
      ->check(CLI::Range(1, kWorkloadCameras))
      ->capture_default_str();
  command->add_option("--page", options->page, "also write the page (Markdown), docs/benchmark.md");
  command->add_option("--plot", options->plot, "also draw the plot (PNG), docs/images/letter-rate.png");
  command->add_flag("--check", options->check,
                    "fail unless the minimum saves cells and cells grow no faster than cameras (never times)");
  command->callback([options] { measure_rates(*options); });
}

}  // namespace depthgrid::lab
