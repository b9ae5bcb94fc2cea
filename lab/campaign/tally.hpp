// What a campaign of random queries has found so far. Tallies of different seeds add up.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "lab/campaign/log_histogram.hpp"
#include "lab/campaign/seed_ranges.hpp"
#include "reference/fault.hpp"

namespace depthgrid::lab {

/// Answers of one kind of question.
struct Row {
  std::int64_t problems = 0;
  std::int64_t queries = 0;
  std::array<std::int64_t, reference::kFaults> faults{};  ///< by reference::Fault
};

/// All of one kind of images.
struct Tally {
  static constexpr std::size_t kMaxLines = 20;

  int width_px = 0;  ///< of all images; 0: up to 96, by the seed
  SeedRanges seeds;
  std::map<std::string, Row> rows;                  ///< "all", and by kind of W, primitive, ...; a query counts in many
  std::map<std::string, std::int64_t> counts;       ///< of calls with a budget or with a direction
  std::map<std::string, LogHistogram> shortfall_m;  ///< hi - answer at a resolution of 5 mm
  std::map<std::string, LogHistogram> shortfall_resolutions;  ///< the same over the resolution, all resolutions
  std::map<std::string, std::int64_t> queries_by_code;        ///< which state of the source has answered
  std::vector<std::string> lines;                             ///< the first faults of each kind, to be asked again
  double seconds = 0;

  /// Keeps the line unless there are kMaxLines of this kind already.
  void note(const std::string& kind, const std::string& line);
  /// Throws Error when the width differs or a seed is in both.
  void add(const Tally& other);
  [[nodiscard]] std::int64_t faults(reference::Fault fault) const;
  /// Any answer was above the distance, or depends on what was asked before.
  [[nodiscard]] bool is_unsound() const;
};

}  // namespace depthgrid::lab
