// Measures by how much the letter's evaluation and the corrected one over- and under-estimate distances, and writes
// the page about it:  depthgrid-lab letter errors --output docs/letter-errors.md
#include <CLI/CLI.hpp>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "lab/commands.hpp"
#include "lab/letter/letter_page.hpp"
#include "program/output_file.hpp"
#include "report/machine.hpp"
#include "report/progress_line.hpp"

namespace depthgrid::lab {
namespace {

struct ErrorsOptions {
  std::uint64_t seed = 1;
  int scenes = 1000;
  int large_scenes = 100;
  std::vector<int> secondaries{1, 2, 3};
  int trials = 300;
  std::int64_t cases = 1'200'000;
  int threads = 0;
  std::string output = "-";
  std::string json;
  std::string command_line;
};

/// What would make the page again.
std::string command_line(const ErrorsOptions& options, const CLI::App& command) {
  return "depthgrid-lab letter errors --seed " + std::to_string(options.seed) + " --scenes " +
         std::to_string(options.scenes) + " --large-scenes " + std::to_string(options.large_scenes) + " --trials " +
         std::to_string(options.trials) +
         (command.count("--secondary") > 0 ? " --secondary " + CLI::detail::join(options.secondaries, ",") : "") +
         (command.count("--cases") > 0 ? " --cases " + std::to_string(options.cases) : "") +
         " --output docs/letter-errors.md";
}

void measure_errors(const ErrorsOptions& options) {
  LetterErrors errors;
  errors.command = options.command_line;
  errors.date = report::today();
  for (const int width_px : {0, 640}) {
    for (const int count : options.secondaries) {
      const CampaignSettings settings{options.seed, width_px == 0 ? options.scenes : options.large_scenes, count,
                                      width_px, options.threads};
      report::ProgressLine line(
          std::to_string(count) + " secondary cameras, " + (width_px == 0 ? "small" : "640x480") + " scenes,",
          static_cast<std::size_t>(settings.scenes));
      if (settings.scenes > 0) {
        errors.campaigns.push_back(
            {settings, run_campaign(settings, [&](std::size_t done, std::size_t) { line.update(done); })});
      }
    }
  }
  errors.window = measure_window();
  errors.clamp = measure_clamp(options.seed, options.cases);
  errors.order = measure_order(options.seed, options.cases);
  {
    report::ProgressLine line("small objects", 24);
    errors.vanishing = measure_vanishing(options.seed, options.trials, options.threads,
                                         [&](std::size_t done, std::size_t) { line.update(done); });
  }
  program::OutputFile output(options.output);
  std::ostringstream page;
  write_page(errors, page);
  output.write(page.str());
  output.commit();
  if (!options.json.empty()) {
    write_json(errors, options.json);
  }
}

}  // namespace

void add_letter_errors_command(CLI::App& letter) {
  const auto options = std::make_shared<ErrorsOptions>();
  CLI::App* const command = letter.add_subcommand(
      "errors", "errors of the letter's distances against a proven interval, as a page: some minutes");
  command->add_option("--seed", options->seed, "first seed of all random cases")->capture_default_str();
  command->add_option("--scenes", options->scenes, "small scenes for each number of secondary cameras")
      ->check(CLI::Range(1, 10'000'000))
      ->capture_default_str();
  command
      ->add_option("--large-scenes", options->large_scenes,
                   "scenes with 640x480 pixels for each number of secondary cameras")
      ->check(CLI::Range(0, 10'000'000))
      ->capture_default_str();
  command->add_option("--secondary", options->secondaries, "numbers of secondary cameras")
      ->delimiter(',')
      ->check(CLI::Range(0, 16))
      ->capture_default_str();
  command->add_option("--trials", options->trials, "trials for each kind of small object")
      ->check(CLI::Range(1, 10'000'000))
      ->capture_default_str();
  command->add_option("--cases", options->cases, "random cases for the formulas")
      ->check(CLI::Range(600, 1'000'000'000))
      ->capture_default_str();
  command->add_option("--threads", options->threads, "threads, 0: one a core; the figures do not depend on them")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_option("--output", options->output, "the page (Markdown), - for standard output")->capture_default_str();
  command->add_option("--json", options->json, "the same figures as JSON");
  command->callback([options, command] {
    options->command_line = command_line(*options, *command);
    measure_errors(*options);
  });
}

}  // namespace depthgrid::lab
