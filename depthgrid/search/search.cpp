#include "depthgrid/search/search.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>

#include "depthgrid/core/repulsion_law.hpp"
#include "depthgrid/search/best_first.hpp"
#include "depthgrid/search/classification.hpp"
#include "depthgrid/search/depth_first.hpp"
#include "depthgrid/search/mean_direction.hpp"
#include "depthgrid/search/space.hpp"

namespace depthgrid::search {
namespace {

/// Open cubes that a search with a budget may hold.
constexpr std::size_t kFrontierCapacity = std::size_t{1} << 15;

bool is_valid(const Capsule& capsule) noexcept {
  return capsule.a.allFinite() && capsule.b.allFinite() && std::isfinite(capsule.radius_m) && capsule.radius_m >= 0;
}

}  // namespace

/// What is known of a capsule before the search, and how far it has to reach.
struct Search::Plan {
  Capsule capsule;
  Border border;                ///< of W, from the end of the axis that is nearer to it
  Eigen::Vector3d border_axis;  ///< that end
  double limit_m = 0;           ///< from the axis
  bool border_bounds = false;   ///< the border counts as obstacle and is nearer than rho
};

struct Search::State {
  explicit State(std::size_t remembered_cells) : memory(remembered_cells), frontier(kFrontierCapacity) {}

  void call(const views::Snapshot& snapshot, const memory::MemorySnapshot* space, std::span<const Capsule> capsules,
            std::span<Answer> answers, const Budget& budget, Count* count, bool with_direction) noexcept;
  void answer(const views::Snapshot& snapshot, const Capsule& capsule, Answer& result, bool budgeted,
              RemainingBudget& remaining, bool with_direction, Count& count) noexcept;

  Memory memory;
  Frontier frontier;
  RepulsionTable repulsion;
};

/// Fills in what needs no search. False when that is all there is to say.
bool Search::plan(const views::Snapshot& snapshot, const Capsule& capsule, Answer& result, Plan& plan) noexcept {
  result = Answer{};
  if (!is_valid(capsule)) {
    return false;
  }
  result.blind_m = snapshot.blind_m();
  Proximity& nearest = result.nearest;
  nearest.stale = snapshot.stale();
  const views::Settings& s = snapshot.settings();
  // W is convex: of a segment's distances to its border the least is at an end.
  const Border at_a = border_of_space(snapshot, capsule.a);
  const Border at_b = border_of_space(snapshot, capsule.b);
  const bool a_first = at_a.distance_m <= at_b.distance_m;
  plan.capsule = capsule;
  plan.border = a_first ? at_a : at_b;
  plan.border_axis = a_first ? capsule.a : capsule.b;
  const bool outside_counts = s.policies.outside == views::Policy::obstacle;
  if (!(plan.border.distance_m >= 0)) {
    nearest.state = ProximityState::outside;
    if (outside_counts) {
      nearest.distance_m = 0;
      nearest.nearest_world = plan.border_axis;
      nearest.direction_world.setZero();
      result.on_axis_world = plan.border_axis;
    }
    return false;
  }
  if (!outside_counts) {
    nearest.known_to_m = std::max(0.0, plan.border.distance_m - capsule.radius_m);
  }
  plan.limit_m = s.rho_m + capsule.radius_m;
  plan.border_bounds = outside_counts && plan.border.distance_m < plan.limit_m;
  plan.limit_m = plan.border_bounds ? plan.border.distance_m : plan.limit_m;
  return true;
}

/// Turns what the search found into the answer.
void Search::finish(const views::Snapshot& snapshot, const Plan& plan, const Nearest& found,
                    const Eigen::Vector3d& origin_world, Answer& result) noexcept {
  Proximity& nearest = result.nearest;
  nearest.budget = found.stopped;
  nearest.distance_m = std::max(0.0, found.distance_m - plan.capsule.radius_m - kRounding);
  if (found.found && !found.stopped) {
    nearest.nearest_world = found.in_obstacle + origin_world;
    const bool is_point = plan.capsule.a == plan.capsule.b;
    result.on_axis_world = is_point ? plan.capsule.a : Eigen::Vector3d(found.on_axis + origin_world);
    const Classification what = classify(snapshot, nearest.nearest_world);
    nearest.state = what.state;
    nearest.camera = what.camera;
    nearest.unmeasured = what.unmeasured;
  } else if (plan.border_bounds && !found.stopped) {
    nearest.nearest_world = plan.border.point_world;
    result.on_axis_world = plan.border_axis;
    nearest.state = ProximityState::outside;
  } else {
    nearest.state = ProximityState::beyond_rho;
    if (!found.stopped) {
      nearest.distance_m = snapshot.settings().rho_m;
    }
    return;
  }
  const Eigen::Vector3d towards = nearest.nearest_world - result.on_axis_world;
  const double length_m = towards.norm();
  nearest.direction_world.setZero();
  if (nearest.distance_m > 0 && length_m > 0) {
    nearest.direction_world = towards / length_m;
  }
}

void Search::State::answer(const views::Snapshot& snapshot, const Capsule& capsule, Answer& result, bool budgeted,
                           RemainingBudget& remaining, bool with_direction, Count& count) noexcept {
  Plan p;
  if (!plan(snapshot, capsule, result, p)) {
    return;
  }
  const CubeQuery& query = memory.tree.query();
  const Question question(query, capsule, p.limit_m);
  const Nearest found = budgeted ? find_nearest(memory.tree, frontier, question, remaining, count)
                                 : find_nearest(memory, question, count);
  finish(snapshot, p, found, query.lattice.origin_world, result);
  const Eigen::Vector3d& n = result.nearest.direction_world;
  if (with_direction && n.allFinite() && !n.isZero()) {
    const views::Settings& settings = snapshot.settings();
    const Question around(query, capsule, settings.rho_m + capsule.radius_m);
    result.hybrid_direction_world =
        led_direction(n, mean_direction(memory.tree, around, capsule.radius_m, settings, repulsion, remaining, count),
                      settings.direction_blend);
  }
}

void Search::State::call(const views::Snapshot& snapshot, const memory::MemorySnapshot* space,
                         std::span<const Capsule> capsules, std::span<Answer> answers, const Budget& budget,
                         Count* count, bool with_direction) noexcept {
  Count own;
  Count& counted = count != nullptr ? *count : own;
  RemainingBudget remaining;
  if (budget.time_s) {
    const double time_s = *budget.time_s > 0 ? std::min(*budget.time_s, 1e6) : 0.0;
    remaining.end_at(std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                                            std::chrono::duration<double>(time_s)));
  }
  remaining.give(std::numeric_limits<std::int64_t>::max());
  memory.aim(snapshot, space);
  if (with_direction) {
    repulsion.aim(snapshot.settings());
  }
  const std::size_t both = std::min(capsules.size(), answers.size());
  std::int64_t nodes_left = std::clamp(budget.nodes.value_or(0), std::int64_t{0}, RemainingBudget::kMost);
  for (std::size_t i = 0; i < both; ++i) {
    // What those before have left is shared evenly by the rest.
    const std::int64_t share = nodes_left / static_cast<std::int64_t>(both - i);
    if (budget.nodes) {
      remaining.give(share);
    }
    answer(snapshot, capsules[i], answers[i], budget.nodes || budget.time_s, remaining, with_direction, counted);
    nodes_left -= budget.nodes ? share - remaining.nodes() : 0;
  }
  for (std::size_t i = both; i < answers.size(); ++i) {
    answers[i] = Answer{};
  }
}

Search::Search(std::size_t remembered_cells) : state_(std::make_unique<State>(remembered_cells)) {}
Search::~Search() = default;
Search::Search(Search&&) noexcept = default;
Search& Search::operator=(Search&&) noexcept = default;

void Search::distances(const views::Snapshot& snapshot, std::span<const Capsule> capsules, std::span<Answer> answers,
                       const Budget& budget, Count* count) noexcept {
  state_->call(snapshot, nullptr, capsules, answers, budget, count, false);
}

void Search::distances(const views::Snapshot& snapshot, const memory::MemorySnapshot& memory,
                       std::span<const Capsule> capsules, std::span<Answer> answers, const Budget& budget,
                       Count* count) noexcept {
  state_->call(snapshot, &memory, capsules, answers, budget, count, false);
}

void Search::hybrid(const views::Snapshot& snapshot, std::span<const Capsule> capsules, std::span<Answer> answers,
                    const Budget& budget, Count* count) noexcept {
  state_->call(snapshot, nullptr, capsules, answers, budget, count, true);
}

void Search::hybrid(const views::Snapshot& snapshot, const memory::MemorySnapshot& memory,
                    std::span<const Capsule> capsules, std::span<Answer> answers, const Budget& budget,
                    Count* count) noexcept {
  state_->call(snapshot, &memory, capsules, answers, budget, count, true);
}

}  // namespace depthgrid::search
