// What the answers of worlds came to. Tallies add up.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace depthgrid::world {

/// Of one kind of worlds.
struct Counts {
  /// Answer over truth in steps of 2 %, the last for 1 and more.
  static constexpr std::size_t kRatios = 51;

  std::int64_t worlds = 0;
  std::int64_t answers = 0;      ///< each judged at the time of the images
  std::int64_t answers_now = 0;  ///< of them, those judged at the time asked for, too
  std::int64_t above = 0;        ///< above the truth, at the time of the images
  std::int64_t above_now = 0;    ///< at the time asked for
  std::int64_t in_layer = 0;     ///< above the distance to something in the blind layer, but to nothing else: no error
  std::int64_t far_true = 0;     ///< nothing within rho, neither a thing nor the border of W
  std::int64_t far_said = 0;     ///< and the answer says so
  std::int64_t worlds_above = 0;
  std::int64_t noticed = 0;  ///< times that the product found an assumption broken
  std::int64_t worlds_noticed = 0;
  double largest_excess_m = 0;
  std::array<std::int64_t, kRatios> ratios{};  ///< where something is within rho, and not touched

  Counts& operator+=(const Counts& other);
  /// Share of the truth that half of the answers reach, from `ratios`; NaN without any.
  [[nodiscard]] double median_ratio() const;
};

/// Calls visit(name, count) for every whole number but the ratios: the same for adding, writing and reading.
template <class AnyCounts, class Visit>
void each_count(AnyCounts& counts, Visit visit) {
  visit("worlds", counts.worlds);
  visit("answers", counts.answers);
  visit("answers_now", counts.answers_now);
  visit("above", counts.above);
  visit("above_now", counts.above_now);
  visit("in_layer", counts.in_layer);
  visit("far_true", counts.far_true);
  visit("far_said", counts.far_said);
  visit("worlds_above", counts.worlds_above);
  visit("noticed", counts.noticed);
  visit("worlds_noticed", counts.worlds_noticed);
}

struct Tally {
  static constexpr std::size_t kMaxLines = 20;

  std::map<std::string, Counts> rows;  ///< "all", and by kinds of worlds; a world counts in several
  std::vector<std::string> lines;      ///< the first answers above the truth, each with what plays its world again

  void note(const std::string& line);
  Tally& operator+=(const Tally& other);
};

}  // namespace depthgrid::world
