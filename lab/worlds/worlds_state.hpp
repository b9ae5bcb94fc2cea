// What a campaign of random worlds has found so far, in one JSON file: a tally for each kind of worlds.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "lab/campaign/seed_ranges.hpp"
#include "world/play.hpp"

namespace depthgrid::lab {

/// Worlds of one kind: all that their options say, but for the seed.
struct WorldsOfAKind {
  world::WorldOptions options;
  SeedRanges seeds;
  world::Tally tally;
  std::map<std::string, std::int64_t> answers_by_code;  ///< which state of the source has answered
  double seconds = 0;                                   ///< of the clock on the wall
};

struct WorldsState {
  std::map<std::string, WorldsOfAKind> kinds;  ///< by world::name_of()

  /// New where there is none.
  [[nodiscard]] WorldsOfAKind& of(const world::WorldOptions& options);
  /// Throws Error when a seed is in both.
  void add(const WorldsState& other);
};

/// Plays one world into its kind.
void play_into(WorldsState& state, const world::WorldOptions& options, const std::string& code);

/// Whole or not at all. Throws Error when it cannot be written.
void write_worlds(const std::string& file, const WorldsState& state);
/// Throws Error when the file cannot be read or is no such state.
[[nodiscard]] WorldsState read_worlds(const std::string& file);

}  // namespace depthgrid::lab
