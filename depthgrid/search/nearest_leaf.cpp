#include "depthgrid/search/nearest_leaf.hpp"

#include <array>
#include <tuple>

#include "depthgrid/core/rounding.hpp"

namespace depthgrid::search {
namespace {

/// Axes at least this long, squared, are segments to single precision.
constexpr double kShortest = 1e-12;

bool comes_before(const Cube& a, const Cube& b) noexcept {
  return std::tie(a.level, a.z, a.y, a.x) < std::tie(b.level, b.z, b.y, b.x);
}

}  // namespace

Question::Question(const CubeQuery& query, const Capsule& capsule, double limit_m_in) noexcept
    : a(capsule.a - query.lattice.origin_world), b(capsule.b - query.lattice.origin_world), limit_m(limit_m_in) {
  const Eigen::Vector3d along = b - a;
  for (std::size_t k = 0; k < 3; ++k) {
    axis.a[k] = static_cast<float>(a[static_cast<Eigen::Index>(k)]);
    axis.along[k] = static_cast<float>(along[static_cast<Eigen::Index>(k)]);
  }
  const double square = along.squaredNorm();
  axis.inverse_square = square > kShortest ? static_cast<float>(1 / square) : 0.0F;
}

bool touches(const CubeQuery& query, const Question& question, Nearest& nearest) noexcept {
  constexpr std::array<double, 9> kPlaces{0.5, 0, 1, 0.25, 0.75, 0.125, 0.375, 0.625, 0.875};
  const std::size_t count = question.axis.inverse_square != 0 ? kPlaces.size() : 1;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d x = question.a + kPlaces[i] * (question.b - question.a);
    if (is_blocked(query, x, i == 0 ? query.slack_m : 0.0)) {
      nearest = {0.0, true, false, x, x};
      return true;
    }
  }
  return false;
}

void NearestLeaf::look_within(double distance_m) noexcept {
  bound_m_ = float_above(distance_m + near_guard_m(query_.lattice.extent_m));
}

bool NearestLeaf::offer(const Cube& leaf) noexcept {
  const Box box = box_of(query_, leaf);
  const AxisToBox pair = search::nearest(question_.a, question_.b, box.low, box.high);
  if (query_.principal >= 0 && leaf.level < query_.lattice.last_level && !in_space(query_, pair.in_box)) {
    return false;
  }
  if (pair.distance_m < distance_m_ || (found_ && pair.distance_m == distance_m_ && comes_before(leaf, leaf_))) {
    pair_ = pair;
    leaf_ = leaf;
    found_ = true;
    distance_m_ = pair.distance_m;
    look_within(distance_m_);
  }
  return true;
}

Nearest NearestLeaf::nearest() const noexcept {
  return found_ ? Nearest{distance_m_, true, false, pair_.on_axis, pair_.in_box} : Nearest{distance_m_};
}

}  // namespace depthgrid::search
