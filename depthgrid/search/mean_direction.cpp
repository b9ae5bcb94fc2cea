#include "depthgrid/search/mean_direction.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "depthgrid/core/rounding.hpp"

namespace depthgrid::search {
namespace {

/// Half side over distance at which a cube counts as one piece of the mean direction.
constexpr double kFineness = 1.0 / 6;
/// Axes that are not longer, squared metres, count as points.
constexpr double kShortestDirected = 1e-30;

/// What the children of a node have in common.
struct Children {
  double half_m;          ///< half a side
  double fine_square_m2;  ///< those at least this far from the axis, squared, are fine enough
  double volume_m3;       ///< of each, unless the border of W cuts some
  bool cut;               ///< it may
};

class Gathering {
 public:
  Gathering(VerdictTree& tree, const Question& question, double radius_m, const views::Settings& settings,
            const RepulsionTable& repulsion, RemainingBudget& budget, Count& count) noexcept
      : tree_(tree),
        lattice_(tree.query().lattice),
        question_(question),
        along_(question.b - question.a),
        inverse_square_(along_.squaredNorm() > kShortestDirected ? 1 / along_.squaredNorm() : 0.0),
        radius_m_(radius_m),
        finest_m_(settings.rho_m / 32),
        reach_square_m2_((settings.rho_m + radius_m) * (settings.rho_m + radius_m)),
        repulsion_(repulsion),
        bound_m_(float_above(question.limit_m + near_guard_m(lattice_.extent_m))),
        budget_(budget),
        count_(count) {}

  /// What is exhausted holds no pieces. With a budget of nodes it is visited all the same: that ends at the same place
  /// whatever was asked before.
  // NOLINTNEXTLINE(misc-no-recursion): as deep as the lattice
  void visit(VerdictNode& node) noexcept {
    const int level = node.cube.level + 1;
    std::array<float, 8> distances_m;  // NOLINT(*-member-init): not read
    std::uint32_t near = near_children(question_.axis, node.cube, lattice_.half_side_m(level), bound_m_, distances_m) &
                         std::uint32_t{node.open};
    near &= budget_.is_counted() ? near : ~std::uint32_t{node.exhausted};
    const Children children = children_of(node);
    if (children.fine_square_m2 == 0) {
      // All are pieces, and these add nothing.
      near &= ~(std::uint32_t{node.asked_centre} & ~std::uint32_t{node.blocked_centre});
    }
    for (; near != 0; near &= near - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(near));
      if (is_piece(node, lane, children)) {
        continue;
      }
      if (budget_.is_spent()) {
        return;
      }
      budget_.take(1);
      VerdictNode spare;
      VerdictNode& child = tree_.child(node, lane, spare, count_);
      visit(child);
      if ((child.open & ~std::uint32_t{child.exhausted}) == 0 && level < lattice_.leaf_level) {
        node.exhausted |= static_cast<std::uint8_t>(1U << lane);
      }
    }
  }

  [[nodiscard]] Eigen::Vector3d mean() const noexcept { return total_ > 0 ? Eigen::Vector3d(sum_ / total_) : sum_; }

 private:
  [[nodiscard]] Children children_of(const VerdictNode& node) const noexcept {
    const auto half_m = static_cast<double>(lattice_.half_side_m(node.cube.level + 1));
    const CubeQuery& query = tree_.query();
    bool cut = false;
    for (int i = 0; query.boxed && i < 3; ++i) {
      const auto centre_m = static_cast<double>(i == 0 ? node.cube.x : i == 1 ? node.cube.y : node.cube.z);
      cut = cut || centre_m - 2 * half_m < query.space_low[i] || centre_m + 2 * half_m > query.space_high[i];
    }
    const double farthest_coarse_m = half_m > finest_m_ ? half_m / kFineness : 0.0;
    return {half_m, farthest_coarse_m * farthest_coarse_m, 8 * half_m * half_m * half_m, cut};
  }

  /// Adds a child that is fine enough.
  [[nodiscard]] bool is_piece(VerdictNode& node, std::size_t lane, const Children& children) noexcept {
    const Cube cube = tree_.child_cube(node, lane);
    Eigen::Vector3d centre(static_cast<double>(cube.x), static_cast<double>(cube.y), static_cast<double>(cube.z));
    double volume_m3 = children.volume_m3;
    if (children.cut) {
      const Box box = box_of(tree_.query(), cube);
      centre = 0.5 * (box.low + box.high);
      volume_m3 = (box.high - box.low).prod();
    }
    const Eigen::Vector3d from_axis = centre - nearest_on_axis(centre);
    const double square_m2 = from_axis.squaredNorm();
    if (square_m2 < children.fine_square_m2) {
      return false;
    }
    if (square_m2 < reach_square_m2_ && square_m2 > 0 && tree_.has_blocked_centre(node, lane)) {
      const double to_centre_m = std::sqrt(square_m2);
      const double weight = volume_m3 * repulsion_(to_centre_m - radius_m_);
      sum_ += weight / to_centre_m * from_axis;
      total_ += weight;
    }
    return true;
  }

  [[nodiscard]] Eigen::Vector3d nearest_on_axis(const Eigen::Vector3d& x) const noexcept {
    const double share = (x - question_.a).dot(along_) * inverse_square_;
    return question_.a + std::clamp(share, 0.0, 1.0) * along_;
  }

  VerdictTree& tree_;
  const Lattice& lattice_;
  const Question& question_;
  Eigen::Vector3d along_;
  double inverse_square_;
  double radius_m_;
  double finest_m_;         ///< half a side that is always fine enough
  double reach_square_m2_;  ///< farther from the axis nothing counts
  const RepulsionTable& repulsion_;
  float bound_m_;
  RemainingBudget& budget_;
  Count& count_;
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  double total_ = 0;
};

}  // namespace

Eigen::Vector3d mean_direction(VerdictTree& tree, const Question& question, double radius_m,
                               const views::Settings& settings, const RepulsionTable& repulsion,
                               RemainingBudget& budget, Count& count) noexcept {
  Gathering gathering(tree, question, radius_m, settings, repulsion, budget, count);
  if (!budget.is_spent()) {
    budget.take(1);
    gathering.visit(tree.root(count));
  }
  return gathering.mean();
}

}  // namespace depthgrid::search
