// Random queries to the sound search, each held against the oracle of the tests. Resumes; ranges of seeds add up.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <limits>

#include "lab/campaign/examination.hpp"
#include "lab/campaign/soundness_page.hpp"
#include "lab/campaign/state_file.hpp"

namespace {

using namespace depthgrid;
using namespace depthgrid::lab;
using reference::Fault;

constexpr double kSaveS = 10;

struct Range {
  std::uint64_t first = 1;
  std::uint64_t end = 1;
};

/// One line on standard error: how far, how fast, how long it takes, and what was found.
void report(const Tally& tally, const Range& range, std::uint64_t done_here, double elapsed_s) {
  const double all = static_cast<double>(range.end - range.first);
  const double done = static_cast<double>(tally.seeds.count(range.first, range.end));
  const double rate = static_cast<double>(done_here) / elapsed_s;
  const double left_s = rate > 0 ? (all - done) / rate : 0;
  std::fprintf(stderr,
               "%5.1f %%, %.0f of %.0f queries, %.0f a second, about %.0f:%02.0f min left; over-estimates %lld, "
               "not proven %lld, not tight %lld, implausible %lld\n",
               100 * done / all, kQueriesPerProblem * done, kQueriesPerProblem * all, kQueriesPerProblem * rate,
               std::floor(left_s / 60), std::floor(std::fmod(left_s, 60)),
               static_cast<long long>(tally.faults(Fault::over_estimate)),
               static_cast<long long>(tally.faults(Fault::undecided)),
               static_cast<long long>(tally.faults(Fault::not_tight)),
               static_cast<long long>(tally.faults(Fault::implausible)));
}

/// Seeds that the state holds already are left out.
void run(const Range& range, int width_px, const std::string& code, const std::string& file, CampaignState& state) {
  using Clock = std::chrono::steady_clock;
  const auto since_s = [](Clock::time_point then) {
    return std::chrono::duration<double>(Clock::now() - then).count();
  };
  Tally& tally = state.of_width(width_px);
  const auto start = Clock::now();
  auto saved = start;
  std::uint64_t done = 0;
  std::size_t told = tally.lines.size();
  for (std::uint64_t seed = tally.seeds.next_missing(range.first); seed < range.end;
       seed = tally.seeds.next_missing(seed)) {
    examine(seed, code, tally);
    ++done;
    for (; told < tally.lines.size(); ++told) {
      std::cerr << tally.lines[told] << '\n';
    }
    if (since_s(saved) >= kSaveS) {
      saved = Clock::now();
      report(tally, range, done, since_s(start));
      if (!file.empty()) {
        write_state(file, state);
      }
    }
  }
  report(tally, range, done, since_s(start));
  if (!file.empty()) {
    write_state(file, state);
  }
}

/// Whether any answer was above the distance, or may have been.
bool unsound(const CampaignState& state) {
  for (const auto& [width_px, tally] : state.tallies) {
    const auto of_budget = tally.counts.find("budget: over_estimate");
    if (tally.faults(Fault::over_estimate) > 0 || (of_budget != tally.counts.end() && of_budget->second > 0)) {
      return true;
    }
  }
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Random queries to the sound search, held against the oracle. Fails when an answer was an over-estimate."};
  std::uint64_t first_seed = 1;
  std::uint64_t seeds = 0;
  std::uint64_t queries = 0;
  int width_px = 0;
  std::string file;
  std::string page;
  std::string code;
  std::vector<std::string> merged;
  app.add_option("--first-seed", first_seed, "first problem (default 1)");
  auto* seeds_option = app.add_option("--seeds", seeds, "number of problems, 64 queries each")
                           ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 40));
  app.add_option("--queries", queries, "instead of --seeds: at least so many queries")
      ->excludes(seeds_option)
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 46));
  app.add_option("--width", width_px, "width of all images, pixels (default: up to 96, by the seed)")
      ->check(CLI::Range(8, 2048));
  app.add_option("--state", file, "JSON file: read where it exists, written every ten seconds and at the end");
  app.add_option("--merge", merged, "add the states in these files; no seed may be in two of them")
      ->check(CLI::ExistingFile);
  app.add_option("--page", page, "put the tables into this page (Markdown)");
  app.add_option("--code", code, "what is being asked, for instance the commit; kept in the state");
  CLI11_PARSE(app, argc, argv);
  try {
    CampaignState state = !file.empty() && std::filesystem::exists(file) ? read_state(file) : CampaignState();
    for (const std::string& other : merged) {
      state.add(read_state(other));
    }
    if (!merged.empty() && !file.empty()) {
      write_state(file, state);
    }
    if (queries > 0) {
      seeds = (queries + kQueriesPerProblem - 1) / kQueriesPerProblem;
    }
    if (seeds > 0) {
      run({first_seed, first_seed + seeds}, width_px, code, file, state);
    }
    if (!page.empty()) {
      write_tables(page, soundness_tables(state));
    }
    if (unsound(state)) {
      std::cerr << "depthgrid_search_campaign: there were over-estimates\n";
      return 1;
    }
  } catch (const std::exception& error) {
    std::cerr << "depthgrid_search_campaign: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
