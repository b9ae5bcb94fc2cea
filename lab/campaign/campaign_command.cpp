// Random queries to the sound search, each held against the oracle of the tests. Resumes; ranges of seeds add up.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "lab/campaign/examination.hpp"
#include "lab/campaign/soundness_page.hpp"
#include "lab/campaign/state_file.hpp"
#include "lab/commands.hpp"
#include "lab/measure/clocks.hpp"
#include "report/number_text.hpp"
#include "report/progress_line.hpp"

namespace depthgrid::lab {
namespace {

using reference::Fault;

constexpr double kSaveS = 10;

struct CampaignOptions {
  std::uint64_t first_seed = 1;
  std::uint64_t seeds = 0;
  std::uint64_t queries = 0;
  int width_px = 0;
  std::string file;
  std::string page;
  std::string code;
  std::vector<std::string> merged;
};

std::string faults_text(const Tally& tally) {
  return "over-estimates " + std::to_string(tally.faults(Fault::over_estimate)) + ", not proven " +
         std::to_string(tally.faults(Fault::undecided)) + ", not tight " +
         std::to_string(tally.faults(Fault::not_tight)) + ", implausible " +
         std::to_string(tally.faults(Fault::implausible));
}

/// Seeds that the state holds already are left out.
void examine_all(const CampaignOptions& options, CampaignState& state) {
  Tally& tally = state.of_width(options.width_px);
  const std::uint64_t first = options.first_seed;
  const std::uint64_t end = first + options.seeds;
  std::uint64_t left = options.seeds - tally.seeds.count(first, end);
  report::ProgressLine line("", left);
  Stopwatch since_saved;
  std::uint64_t done = 0;
  std::size_t told = tally.lines.size();
  for (std::uint64_t seed = tally.seeds.next_missing(first); seed < end; seed = tally.seeds.next_missing(seed)) {
    examine(seed, options.code, tally);
    line.update(++done, faults_text(tally) + "; problem");
    for (; told < tally.lines.size(); ++told) {
      std::cerr << tally.lines[told] << '\n';
    }
    if (!options.file.empty() && since_saved.elapsed_s() >= kSaveS) {
      write_state(options.file, state);
      since_saved = Stopwatch();
    }
  }
  if (!options.file.empty()) {
    write_state(options.file, state);
  }
  std::cout << report::grouped(static_cast<std::int64_t>(kQueriesPerProblem * tally.seeds.count(first, end)))
            << " queries: " << faults_text(tally) << '\n';
}

void run(CampaignOptions options) {
  CampaignState state =
      !options.file.empty() && std::filesystem::exists(options.file) ? read_state(options.file) : CampaignState();
  for (const std::string& other : options.merged) {
    state.add(read_state(other));
  }
  if (!options.merged.empty() && !options.file.empty()) {
    write_state(options.file, state);
  }
  if (options.queries > 0) {
    options.seeds = (options.queries + kQueriesPerProblem - 1) / kQueriesPerProblem;
  }
  if (options.seeds > 0) {
    examine_all(options, state);
  }
  if (!options.page.empty()) {
    write_tables(options.page, soundness_tables(state));
  }
  if (state.is_unsound()) {
    fail("there were over-estimates, or answers that depend on what was asked before");
  }
}

}  // namespace

void add_campaign_command(CLI::App& app) {
  const auto options = std::make_shared<CampaignOptions>();
  CLI::App* const command = app.add_subcommand("campaign",
                                               "random queries to the sound search, held against the oracle: 3,000 a "
                                               "second of one core; fails when an answer was an over-estimate");
  command->add_option("--first-seed", options->first_seed, "first problem")->capture_default_str();
  auto* const seeds = command->add_option("--seeds", options->seeds, "number of problems, 64 queries each")
                          ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 40));
  command->add_option("--queries", options->queries, "instead of --seeds: at least so many queries")
      ->excludes(seeds)
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 46));
  command->add_option("--width", options->width_px, "width of all images, pixels (default: up to 96, by the seed)")
      ->check(CLI::Range(8, 2048));
  command->add_option("--state", options->file,
                      "JSON file: read where it exists, written every ten seconds and at the end");
  command->add_option("--merge", options->merged, "add the states in these files; no seed may be in two of them")
      ->check(CLI::ExistingFile);
  command->add_option("--page", options->page, "put the tables into this page (Markdown), docs/soundness.md");
  command->add_option("--code", options->code, "what is being asked, for instance the commit; kept in the state");
  command->callback([options] { run(*options); });
}

}  // namespace depthgrid::lab
