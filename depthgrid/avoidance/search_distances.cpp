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
  const std::size_t led = std::min<std::size_t>(1, count);
  const search::Budget of_first{budget_.nodes / 4, budget_.time_s / 4};
  const search::Budget of_others{budget_.nodes - of_first.nodes, budget_.time_s - of_first.time_s};
  search_.hybrid(snapshot, parts_world.first(led), std::span(found_).first(led), of_first);
  search_.distances(snapshot, parts_world.subspan(led, count - led), std::span(found_).subspan(led, count - led),
                    of_others);
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
