// Distances by the sound search.
#pragma once

#include <vector>

#include "depthgrid/avoidance/distance_source.hpp"
#include "depthgrid/search/search.hpp"

namespace depthgrid::avoidance {

/// How far in the future an exposure may seem to lie, on clocks that agree not quite: it then counts as just as old.
inline constexpr double kClockTolerance_s = 0.005;

/// Distances are those from the parts' surfaces, less v_max times the age of the images: what may have come nearer
/// since. The surveillance radius should exceed that of the control laws by v_max times the greatest age, or a part
/// with nothing around is taken for one whose neighbourhood is unknown. Distances are unknown when the images have no
/// time, there are none, or they are from more than kClockTolerance_s after the time asked for.
class SearchDistances final : public DistanceSource {
 public:
  /// `parts`: the most that evaluate() is asked for at a time. `budget`: of one evaluate(), a quarter of it for the end
  /// effector; where nodes are limited, end effector and other parts get one each at least. Parts beyond `parts` are
  /// not evaluated. Throws Error as ViewStore does.
  SearchDistances(const Rig& rig, const views::Settings& settings, std::size_t parts,
                  const search::Budget& budget = {});

  [[nodiscard]] std::string_view name() const noexcept override { return "search"; }
  bool take(std::span<const Frame> frames) noexcept override;
  void evaluate(std::span<const Capsule> parts_world, double now_s, std::span<PartAnswer> answers) noexcept override;

  /// Answers so far, and those of them that the budget ended.
  [[nodiscard]] std::int64_t answered() const noexcept { return answered_; }
  [[nodiscard]] std::int64_t stopped_by_budget() const noexcept { return stopped_; }

 private:
  views::ViewStore store_;
  search::Search search_;
  search::Budget budget_;
  std::vector<search::Answer> found_;
  std::int64_t answered_ = 0;
  std::int64_t stopped_ = 0;
};

}  // namespace depthgrid::avoidance
