#include "depthgrid/search/search.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>

#include "depthgrid/search/classification.hpp"
#include "depthgrid/search/octree_search.hpp"
#include "depthgrid/search/space.hpp"

namespace depthgrid::search {
namespace {

/// Capsules farther apart than this are not searched together, metres.
constexpr double kGroupExtent = 2.0;
/// Open cubes that one search may hold.
constexpr std::size_t kFrontierCapacity = std::size_t{1} << 17;

bool is_valid(const Capsule& capsule) noexcept {
  return capsule.a.allFinite() && capsule.b.allFinite() && std::isfinite(capsule.radius_m) && capsule.radius_m >= 0;
}

}  // namespace

/// What is known of a capsule before the search, and how far it has to reach.
struct Search::Plan {
  std::size_t answer = 0;  ///< index in the call
  Capsule capsule;
  Border border;                ///< of W, from the end of the axis that is nearer to it
  Eigen::Vector3d border_axis;  ///< that end
  double limit_m = 0;           ///< from the axis
  bool border_bounds = false;   ///< the border counts as obstacle and is nearer than rho
};

struct Search::State {
  State() : frontier(kFrontierCapacity) {}

  void call(const views::Snapshot& snapshot, std::span<const Capsule> capsules, std::span<Answer> answers,
            const Budget& budget, Count* count, bool with_direction) noexcept;
  void group(const views::Snapshot& snapshot, std::span<const Plan> plans, std::span<Answer> answers,
             OctreeSearch& octree, RemainingBudget& remaining, bool with_direction) noexcept;

  CubeQuery query;
  Frontier frontier;
  std::array<Plan, kGroup> plans;
  std::array<Eigen::Vector3d, kGroup> means;
};

/// Fills in what needs no search. False when that is all there is to say.
bool Search::plan(const views::Snapshot& snapshot, const Capsule& capsule, Answer& result, Plan& plan) noexcept {
  result = Answer{};
  if (!is_valid(capsule)) {
    return false;
  }
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
    result.on_axis_world = found.on_axis + origin_world;
    const Classification what = classify(snapshot, nearest.nearest_world);
    nearest.state = what.state;
    nearest.camera = what.camera;
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

void Search::State::group(const views::Snapshot& snapshot, std::span<const Plan> group_plans, std::span<Answer> answers,
                          OctreeSearch& octree, RemainingBudget& remaining, bool with_direction) noexcept {
  const double rho_m = snapshot.settings().rho_m;
  Eigen::Vector3d low = group_plans.front().capsule.a;
  Eigen::Vector3d high = low;
  double query_radius_m = 0;
  for (const Plan& p : group_plans) {
    low = low.cwiseMin(p.capsule.a).cwiseMin(p.capsule.b);
    high = high.cwiseMax(p.capsule.a).cwiseMax(p.capsule.b);
    query_radius_m = std::max(query_radius_m, rho_m + p.capsule.radius_m);
  }
  octree.aim(0.5 * (low + high), 0.5 * (high - low).maxCoeff() + query_radius_m);
  for (const Plan& p : group_plans) {
    octree.add(p.capsule, p.limit_m);
  }
  octree.find(remaining);
  std::uint32_t wanted = 0;
  for (std::size_t i = 0; i < group_plans.size(); ++i) {
    Answer& result = answers[group_plans[i].answer];
    finish(snapshot, group_plans[i], octree.nearest_of(i), octree.origin_world(), result);
    const Eigen::Vector3d& n = result.nearest.direction_world;
    wanted |= n.allFinite() && !n.isZero() ? 1U << i : 0U;
  }
  if (!with_direction || wanted == 0) {
    return;
  }
  octree.find_mean_directions(wanted, means, remaining);
  for (std::size_t i = 0; i < group_plans.size(); ++i) {
    if (((wanted >> i) & 1U) != 0) {
      Answer& result = answers[group_plans[i].answer];
      result.hybrid_direction_world =
          led_direction(result.nearest.direction_world, means[i], snapshot.settings().direction_blend);
    }
  }
}

void Search::State::call(const views::Snapshot& snapshot, std::span<const Capsule> capsules, std::span<Answer> answers,
                         const Budget& budget, Count* count, bool with_direction) noexcept {
  Count own;
  OctreeSearch octree(snapshot, query, frontier, count != nullptr ? *count : own);
  std::int64_t nodes_left = std::max(std::int64_t{0}, budget.nodes.value_or(std::numeric_limits<std::int64_t>::max()));
  RemainingBudget remaining;
  if (budget.time_s) {
    const double time_s = *budget.time_s > 0 ? std::min(*budget.time_s, 1e6) : 0.0;
    remaining.end_at(std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                                            std::chrono::duration<double>(time_s)));
  }
  const std::size_t both = std::min(capsules.size(), answers.size());
  std::size_t next = 0;
  while (next < both) {
    // A group: capsules in the order given, as long as they are near to each other.
    const std::size_t first = next;
    std::size_t size = 0;
    Eigen::Vector3d low = Eigen::Vector3d::Constant(1e30);
    Eigen::Vector3d high = -low;
    for (; next < both && size < kGroup; ++next) {
      if (!plan(snapshot, capsules[next], answers[next], plans[size])) {
        continue;
      }
      const Eigen::Vector3d to_low = low.cwiseMin(capsules[next].a).cwiseMin(capsules[next].b);
      const Eigen::Vector3d to_high = high.cwiseMax(capsules[next].a).cwiseMax(capsules[next].b);
      if (size > 0 && (to_high - to_low).maxCoeff() > kGroupExtent) {
        break;
      }
      low = to_low;
      high = to_high;
      plans[size++].answer = next;
    }
    if (size == 0) {
      continue;
    }
    // What the groups before have left is shared evenly by the rest.
    const auto share = nodes_left / static_cast<std::int64_t>(both - first) * static_cast<std::int64_t>(next - first);
    const std::int64_t given = next == both ? nodes_left : share;
    remaining.give(given);
    group(snapshot, {plans.data(), size}, answers, octree, remaining, with_direction);
    nodes_left -= given - remaining.nodes();
  }
  for (std::size_t i = both; i < answers.size(); ++i) {
    answers[i] = Answer{};
  }
}

Search::Search() : state_(std::make_unique<State>()) {}
Search::~Search() = default;
Search::Search(Search&&) noexcept = default;
Search& Search::operator=(Search&&) noexcept = default;

void Search::distances(const views::Snapshot& snapshot, std::span<const Capsule> capsules, std::span<Answer> answers,
                       const Budget& budget, Count* count) noexcept {
  state_->call(snapshot, capsules, answers, budget, count, false);
}

void Search::hybrid(const views::Snapshot& snapshot, std::span<const Capsule> capsules, std::span<Answer> answers,
                    const Budget& budget, Count* count) noexcept {
  state_->call(snapshot, capsules, answers, budget, count, true);
}

}  // namespace depthgrid::search
