#include "depthgrid/avoidance/search_distances.hpp"

#include <algorithm>

namespace depthgrid::avoidance {

SearchDistances::SearchDistances(const Rig& rig, const search::Settings& settings, std::size_t parts,
                                 const search::Budget& budget)
    : store_(rig, settings), budget_(budget), found_(parts) {}

bool SearchDistances::take(std::span<const Frame> frames) noexcept {
  bool all = true;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    all = store_.update(k, frames[k]) == search::UpdateResult::taken && all;
  }
  return all;
}

void SearchDistances::evaluate(std::span<const search::Primitive> parts_world, double now_s,
                               std::span<PartAnswer> answers) noexcept {
  const std::size_t count = std::min({parts_world.size(), answers.size(), found_.size()});
  const search::Snapshot snapshot = store_.snapshot();
  search_.hybrid(snapshot, parts_world.first(count), std::span(found_).first(count), budget_);
  const double age_s = std::max(0.0, now_s - snapshot.reference_time_s());
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (i >= count) {
      answers[i] = PartAnswer{};
      continue;
    }
    const search::Answer& found = found_[i];
    answers[i].nearest = found.nearest;
    answers[i].obstacle =
        control::obstacle_of(found.nearest, found.hybrid_direction_world, age_s, snapshot.settings().v_max_m_s);
    answers[i].at_world = found.on_axis_world.allFinite() ? found.on_axis_world : parts_world[i].a_world;
    ++answered_;
    stopped_ += found.nearest.budget ? 1 : 0;
  }
}

}  // namespace depthgrid::avoidance
