// Random worlds with a truth, played through the sound search. Resumes; ranges of seeds add up.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "lab/commands.hpp"
#include "lab/measure/clocks.hpp"
#include "lab/worlds/worlds_page.hpp"
#include "report/number_text.hpp"
#include "report/progress_line.hpp"

namespace depthgrid::lab {
namespace {

constexpr double kSaveS = 10;

struct WorldsOptions {
  std::uint64_t first_seed = 1;
  std::uint64_t count = 0;
  std::uint64_t one = 0;
  world::WorldOptions world;
  std::string broken = "none";
  std::string file;
  std::string page;
  std::string code;
  std::vector<std::string> merged;
};

std::string counts_text(const world::Counts& counts) {
  return report::grouped(counts.worlds, 3) + " worlds, " + report::grouped(counts.answers, 3) +
         " answers, above the truth " + std::to_string(counts.above + counts.above_now) + " in " +
         std::to_string(counts.worlds_above) + " worlds (largest excess " + std::to_string(counts.largest_excess_m) +
         " m), noticed in " + std::to_string(counts.worlds_noticed);
}

/// Worlds that the state holds already are left out.
void play_all(const WorldsOptions& options, WorldsState& state) {
  WorldsOfAKind& kind = state.of(options.world);
  const std::uint64_t end = options.first_seed + options.count;
  report::ProgressLine line("", options.count - kind.seeds.count(options.first_seed, end));
  Stopwatch since_saved;
  std::uint64_t done = 0;
  std::size_t told = kind.tally.lines.size();
  world::WorldOptions next = options.world;
  for (next.seed = kind.seeds.next_missing(options.first_seed); next.seed < end;
       next.seed = kind.seeds.next_missing(next.seed)) {
    play_into(state, next, options.code);
    line.update(++done, "above the truth " + std::to_string(kind.tally.rows["all"].worlds_above) + "; world");
    for (; told < kind.tally.lines.size(); ++told) {
      std::cerr << kind.tally.lines[told] << '\n';
    }
    if (!options.file.empty() && since_saved.elapsed_s() >= kSaveS) {
      write_worlds(options.file, state);
      since_saved = Stopwatch();
    }
  }
  if (!options.file.empty()) {
    write_worlds(options.file, state);
  }
  std::cout << world::name_of(options.world) << ": " << counts_text(kind.tally.rows["all"]) << '\n';
}

void play_one(world::WorldOptions options, std::uint64_t seed) {
  options.seed = seed;
  world::Tally tally;
  world::play(world::make_world(options), tally);
  for (const std::string& line : tally.lines) {
    std::cout << line << '\n';
  }
  std::cout << counts_text(tally.rows.at("all")) << '\n';
}

/// Whether an answer was above the truth in a world that keeps what is assumed.
bool unsound(const WorldsState& state) {
  for (const auto& [name, kind] : state.kinds) {
    const auto all = kind.tally.rows.find("all");
    if (kind.options.broken == world::Broken::none && all != kind.tally.rows.end() && all->second.worlds_above > 0) {
      return true;
    }
  }
  return false;
}

void run(WorldsOptions options) {
  options.world.broken = world::broken_of(options.broken);
  if (options.one > 0) {
    play_one(options.world, options.one);
    return;
  }
  WorldsState state =
      !options.file.empty() && std::filesystem::exists(options.file) ? read_worlds(options.file) : WorldsState();
  for (const std::string& other : options.merged) {
    state.add(read_worlds(other));
  }
  if (!options.merged.empty() && !options.file.empty()) {
    write_worlds(options.file, state);
  }
  if (options.count > 0) {
    play_all(options, state);
  }
  if (!options.page.empty()) {
    write_worlds_tables(options.page, worlds_tables(state));
  }
  if (unsound(state)) {
    fail("there were answers above the truth");
  }
}

}  // namespace

void add_worlds_command(CLI::App& app) {
  const auto options = std::make_shared<WorldsOptions>();
  CLI::App* const command = app.add_subcommand(
      "worlds",
      "random worlds with a truth, played through the sound search: 5 a second of one core, some 600 answers "
      "each; fails when an answer was above the truth");
  command->add_option("--first-seed", options->first_seed, "first world")->capture_default_str();
  auto* const count = command->add_option("--count", options->count, "number of worlds")
                          ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 40));
  command->add_option("--world", options->one, "this world alone, without a state: says each answer above the truth")
      ->excludes(count)
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 62));
  command
      ->add_option("--width", options->world.width_px, "width of all images, pixels (default: 40 to 96, by the seed)")
      ->check(CLI::Range(40, 2048));
  command->add_option("--broken", options->broken, "the assumption that every world breaks")
      ->check(CLI::IsMember(world::broken_names()))
      ->capture_default_str();
  command->add_flag("--smallest", options->world.smallest, "the smallest obstacle is declared");
  command->add_flag("--memory", options->world.memory, "the search remembers what was seen free");
  command->add_option("--state", options->file,
                      "JSON file: read where it exists, written every ten seconds and at the end");
  command->add_option("--merge", options->merged, "add the states in these files; no seed may be in two of them")
      ->check(CLI::ExistingFile);
  command->add_option("--page", options->page, "put the tables into this page (Markdown), docs/soundness.md");
  command->add_option("--code", options->code, "what is being asked, for instance the commit; kept in the state");
  command->callback([options] { run(*options); });
}

}  // namespace depthgrid::lab
