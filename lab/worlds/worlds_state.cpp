#include "lab/worlds/worlds_state.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "lab/measure/json_file.hpp"

namespace depthgrid::lab {
namespace {

using world::Counts;

Json to_json(const Counts& counts) {
  Json json = {{"largest_excess_m", counts.largest_excess_m}, {"ratios", counts.ratios}};
  world::each_count(counts, [&json](const char* name, std::int64_t count) { json[name] = count; });
  return json;
}

Counts counts_of(const Json& json) {
  Counts counts;
  counts.largest_excess_m = quantity_of(json.at("largest_excess_m"));
  const Json& ratios = json.at("ratios");
  if (ratios.size() != counts.ratios.size()) {
    fail("a row has ", ratios.size(), " ratios, must have ", counts.ratios.size());
  }
  std::transform(ratios.begin(), ratios.end(), counts.ratios.begin(), count_of);
  world::each_count(counts, [&json](const char* name, std::int64_t& count) { count = count_of(json.at(name)); });
  return counts;
}

Json to_json(const WorldsOfAKind& kind) {
  Json rows = Json::object();
  for (const auto& [name, counts] : kind.tally.rows) {
    rows[name] = to_json(counts);
  }
  return {{"options", world::command_of(kind.options)},
          {"seconds", kind.seconds},
          {"seeds", std::vector<std::pair<std::uint64_t, std::uint64_t>>(kind.seeds.ranges().begin(),
                                                                         kind.seeds.ranges().end())},
          {"answers_by_code", kind.answers_by_code},
          {"rows", std::move(rows)},
          {"lines", kind.tally.lines}};
}

WorldsOfAKind kind_of(const Json& json) {
  WorldsOfAKind kind;
  kind.options = world::options_of(json.at("options").get<std::string>());
  kind.seconds = quantity_of(json.at("seconds"));
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
  for (const Json& range : json.at("seeds")) {
    kind.seeds.add(whole_number_of(range.at(0), kMost), whole_number_of(range.at(1), kMost));
  }
  json.at("answers_by_code").get_to(kind.answers_by_code);
  for (const auto& [name, counts] : json.at("rows").items()) {
    kind.tally.rows[name] = counts_of(counts);
  }
  json.at("lines").get_to(kind.tally.lines);
  const auto all = kind.tally.rows.find("all");
  const auto worlds = static_cast<std::uint64_t>(all != kind.tally.rows.end() ? all->second.worlds : 0);
  if (worlds != kind.seeds.count(0, kMost)) {
    fail("the row \"all\" counts ", worlds, " worlds, the seeds are ", kind.seeds.count(0, kMost));
  }
  return kind;
}

}  // namespace

WorldsOfAKind& WorldsState::of(const world::WorldOptions& options) {
  WorldsOfAKind& kind = kinds[world::name_of(options)];
  kind.options = options;
  kind.options.seed = 0;
  return kind;
}

void WorldsState::add(const WorldsState& other) {
  for (const auto& [name, theirs] : other.kinds) {
    WorldsOfAKind& ours = of(theirs.options);
    ours.seeds.add(theirs.seeds);
    ours.tally += theirs.tally;
    for (const auto& [code, answers] : theirs.answers_by_code) {
      ours.answers_by_code[code] += answers;
    }
    ours.seconds += theirs.seconds;
  }
}

void play_into(WorldsState& state, const world::WorldOptions& options, const std::string& code) {
  const auto start = std::chrono::steady_clock::now();
  WorldsOfAKind& kind = state.of(options);
  kind.seeds.add(options.seed, options.seed + 1);
  world::Tally tally;
  world::play(world::make_world(options), tally);
  kind.tally += tally;
  kind.answers_by_code[code] += tally.rows.at("all").answers;
  kind.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void write_worlds(const std::string& file, const WorldsState& state) {
  Json kinds = Json::array();
  for (const auto& [name, kind] : state.kinds) {
    kinds.push_back(to_json(kind));
  }
  write_json_file(file, {{"worlds", std::move(kinds)}});
}

WorldsState read_worlds(const std::string& file) {
  constexpr const char* kWhat = "state of random worlds; one is written by --state";
  const Json all = read_json_file(file, kWhat, {"worlds"});
  return taken_apart(file, kWhat, [&all] {
    WorldsState state;
    if (!all["worlds"].is_array()) {
      fail("\"worlds\" must be a list");
    }
    for (const Json& json : all["worlds"]) {
      WorldsOfAKind kind = kind_of(json);
      if (state.kinds.contains(world::name_of(kind.options))) {
        fail("worlds '", world::name_of(kind.options), "' have two tallies, must have one");
      }
      state.of(kind.options) = std::move(kind);
    }
    return state;
  });
}

}  // namespace depthgrid::lab
