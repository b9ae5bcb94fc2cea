#include "depthgrid/search/search.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "depthgrid/search/classification.hpp"
#include "depthgrid/search/descent.hpp"
#include "depthgrid/search/space.hpp"

namespace depthgrid::search {
namespace {

/// Open cubes that one search may hold.
constexpr std::size_t kFrontierCapacity = std::size_t{1} << 17;

bool is_valid(const Primitive& primitive) noexcept {
  return primitive.a_world.allFinite() && primitive.b_world.allFinite() && std::isfinite(primitive.radius_m) &&
         primitive.radius_m >= 0;
}

}  // namespace

struct Search::State {
  explicit State(const Settings& given) : settings(given), frontier(kFrontierCapacity) {
    std::iota(query.order.begin(), query.order.end(), std::uint8_t{0});
  }

  static void answer(const Snapshot& snapshot, const Primitive& primitive, Descent& descent, Allowance& allowance,
                     Answer& result) noexcept;
  static void add_hybrid(const Snapshot& snapshot, const Primitive& primitive, Descent& descent, Allowance& allowance,
                         Answer& result) noexcept;
  void call(const Snapshot& snapshot, std::span<const Primitive> primitives, std::span<Answer> answers,
            const Budget& budget, Count* count, bool with_direction) noexcept;

  Settings settings;
  CubeQuery query;
  Frontier frontier;
};

void Search::State::answer(const Snapshot& snapshot, const Primitive& primitive, Descent& descent,
                           Allowance& allowance, Answer& result) noexcept {
  result = Answer{};
  if (!is_valid(primitive)) {
    return;
  }
  Proximity& nearest = result.nearest;
  nearest.stale = snapshot.stale();
  const Settings& s = snapshot.settings();
  // W is convex: of a segment's distances to its border the least is at an end.
  const Border at_a = border_of_space(snapshot, primitive.a_world);
  const Border at_b = border_of_space(snapshot, primitive.b_world);
  const bool a_first = at_a.distance_m <= at_b.distance_m;
  const Border& border = a_first ? at_a : at_b;
  const Eigen::Vector3d& border_axis = a_first ? primitive.a_world : primitive.b_world;
  const bool outside_counts = s.policies.outside == Policy::obstacle;
  if (!(border.distance_m >= 0)) {
    nearest.state = ProximityState::outside;
    if (outside_counts) {
      nearest.distance_m = 0;
      nearest.nearest_world = border_axis;
      nearest.direction_world.setZero();
      result.on_axis_world = border_axis;
    }
    return;
  }
  if (!outside_counts) {
    nearest.known_to_m = std::max(0.0, border.distance_m - primitive.radius_m);
  }
  const double reach_m = s.rho_m + primitive.radius_m;
  const bool border_bounds = outside_counts && border.distance_m < reach_m;
  descent.aim(primitive, reach_m);
  const Nearest found = descent.find(border_bounds ? border.distance_m : reach_m, allowance);
  nearest.budget = found.stopped;
  nearest.distance_m = std::max(0.0, found.distance_m - primitive.radius_m - kRounding);
  if (found.found && !found.stopped) {
    nearest.nearest_world = found.in_obstacle + descent.origin_world();
    result.on_axis_world = found.on_axis + descent.origin_world();
    const Classification what = classify(snapshot, nearest.nearest_world);
    nearest.state = what.state;
    nearest.camera = what.camera;
  } else if (border_bounds && !found.stopped) {
    nearest.nearest_world = border.point_world;
    result.on_axis_world = border_axis;
    nearest.state = ProximityState::outside;
  } else {
    nearest.state = ProximityState::beyond_rho;
    if (!found.stopped) {
      nearest.distance_m = s.rho_m;
    }
    return;
  }
  const Eigen::Vector3d towards = nearest.nearest_world - result.on_axis_world;
  const double length_m = towards.norm();
  nearest.direction_world = nearest.distance_m > 0 && length_m > 0 ? (towards / length_m).eval() : Eigen::Vector3d::Zero();
}

Search::Search(const Settings& settings, std::size_t) : state_(std::make_unique<State>(settings)) {}
Search::~Search() = default;
Search::Search(Search&&) noexcept = default;
Search& Search::operator=(Search&&) noexcept = default;

/// V = n + b (t - (t.n) n), normalised: the nearest direction leads, the others only turn it.
void Search::State::add_hybrid(const Snapshot& snapshot, const Primitive& primitive, Descent& descent,
                               Allowance& allowance, Answer& result) noexcept {
  const Eigen::Vector3d n = result.nearest.direction_world;
  if (!n.allFinite() || n.isZero() || result.nearest.budget) {
    return;
  }
  const Settings& s = snapshot.settings();
  descent.aim(primitive, s.rho_m + primitive.radius_m);
  const Eigen::Vector3d t = descent.mean_direction(allowance);
  result.hybrid_direction_world = (n + s.direction_blend * (t - t.dot(n) * n)).normalized();
}

void Search::State::call(const Snapshot& snapshot, std::span<const Primitive> primitives, std::span<Answer> answers,
                         const Budget& budget, Count* count, bool with_direction) noexcept {
  Count own;
  Descent descent(snapshot, query, frontier, count != nullptr ? *count : own);
  std::int64_t nodes_left = budget.nodes > 0 ? budget.nodes : std::numeric_limits<std::int64_t>::max();
  Allowance allowance;
  allowance.timed = budget.time_s > 0;
  if (allowance.timed) {
    allowance.deadline = std::chrono::steady_clock::now() +
                         std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                             std::chrono::duration<double>(std::min(budget.time_s, 1e6)));
  }
  const std::size_t both = std::min(primitives.size(), answers.size());
  for (std::size_t i = 0; i < both; ++i) {
    // What the primitives before have left is shared evenly by the rest.
    const auto share = nodes_left / static_cast<std::int64_t>(both - i);
    allowance.nodes = share;
    answer(snapshot, primitives[i], descent, allowance, answers[i]);
    if (with_direction) {
      add_hybrid(snapshot, primitives[i], descent, allowance, answers[i]);
    }
    nodes_left -= share - allowance.nodes;
  }
  for (std::size_t i = both; i < answers.size(); ++i) {
    answers[i] = Answer{};
  }
}

void Search::distances(const Snapshot& snapshot, std::span<const Primitive> primitives, std::span<Answer> answers,
                       const Budget& budget, Count* count) noexcept {
  state_->call(snapshot, primitives, answers, budget, count, false);
}

void Search::hybrid(const Snapshot& snapshot, std::span<const Primitive> primitives, std::span<Answer> answers,
                    const Budget& budget, Count* count) noexcept {
  state_->call(snapshot, primitives, answers, budget, count, true);
}

}  // namespace depthgrid::search
