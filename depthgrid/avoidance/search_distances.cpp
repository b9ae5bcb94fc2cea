#include "depthgrid/avoidance/search_distances.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid::avoidance {

namespace {

/// A quarter for the end effector, the rest for the others. 0 means no limit, so what has one keeps at least a node.
search::Budget share_of(const search::Budget& budget, bool end_effector) noexcept {
  if (end_effector) {
    return {budget.nodes > 0 ? std::max<std::int64_t>(1, budget.nodes / 4) : 0, budget.time_s / 4};
  }
  return {budget.nodes > 0 ? std::max<std::int64_t>(1, budget.nodes - std::max<std::int64_t>(1, budget.nodes / 4)) : 0,
          budget.time_s - budget.time_s / 4};
}

/// NaN stays NaN, and what lies further in the future than kClockTolerance_s becomes NaN: nothing is known then.
double age_of_images_s(double now_s, double reference_time_s) noexcept {
  const double age_s = now_s - reference_time_s;
  return age_s >= -kClockTolerance_s ? std::abs(age_s) : Proximity::kNaN;
}

}  // namespace

SearchDistances::SearchDistances(const Rig& rig, const views::Settings& settings, std::size_t parts,
                                 const search::Budget& budget)
    : store_(rig, settings), budget_(budget), found_(parts) {}

bool SearchDistances::take(std::span<const Frame> frames) noexcept {
  bool all = true;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    all = store_.update(k, frames[k]) == views::UpdateResult::taken && all;
  }
  return all;
}

void SearchDistances::evaluate(std::span<const Capsule> parts_world, double now_s,
                               std::span<PartAnswer> answers) noexcept {
  const std::size_t count = std::min({parts_world.size(), answers.size(), found_.size()});
  const views::Snapshot snapshot = store_.snapshot();
  const std::size_t led = std::min<std::size_t>(1, count);
  search_.hybrid(snapshot, parts_world.first(led), std::span(found_).first(led), share_of(budget_, true));
  search_.distances(snapshot, parts_world.subspan(led, count - led), std::span(found_).subspan(led, count - led),
                    share_of(budget_, false));
  const double age_s = age_of_images_s(now_s, snapshot.reference_time_s());
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (i >= count) {
      answers[i] = PartAnswer{};
      if (i < parts_world.size()) {
        answers[i].at_world = parts_world[i].a;
      }
      continue;
    }
    const search::Answer& found = found_[i];
    answers[i].nearest = found.nearest;
    answers[i].obstacle =
        control::obstacle_of(found.nearest, found.hybrid_direction_world, age_s, snapshot.settings().v_max_m_s);
    answers[i].at_world = found.on_axis_world.allFinite() ? found.on_axis_world : parts_world[i].a;
    ++answered_;
    stopped_ += found.nearest.budget ? 1 : 0;
  }
}

}  // namespace depthgrid::avoidance
