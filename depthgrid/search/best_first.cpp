#include "depthgrid/search/best_first.hpp"

#include <algorithm>
#include <bit>

#include "depthgrid/core/rounding.hpp"

namespace depthgrid::search {
namespace {

class Expansion {
 public:
  Expansion(VerdictTree& tree, Frontier& frontier, const Question& question, Count& count) noexcept
      : tree_(tree),
        lattice_(tree.query().lattice),
        frontier_(frontier),
        question_(question),
        best_(tree.query(), question),
        unseen_m_(question.limit_m),
        count_(count) {}

  Nearest run(RemainingBudget& budget) noexcept {
    frontier_.reset(nearest_float(question_.limit_m));
    if (budget.is_spent()) {
      unseen_m_ = 0;
      return result();
    }
    budget.take(1);
    push_children(tree_.root(count_));
    OpenCube cube{};
    while (frontier_.pop(cube)) {
      if (!(cube.distance_m < best_.bound_m()) || is_settled(cube)) {
        continue;
      }
      VerdictNode spare;
      VerdictNode* child = nullptr;
      if (!budget.is_spent()) {
        budget.take(1);
        child = &tree_.child(*cube.node, cube.lane, spare, count_);
      }
      if (child == nullptr || (child == &spare && child->open != 0)) {
        stop(frontier_.lower_bound_m());
        break;
      }
      push_children(*child);
    }
    return result();
  }

 private:
  /// Whether a child is free, or was offered as a leaf.
  [[nodiscard]] bool is_settled(const OpenCube& cube) noexcept {
    const int level = cube.node->cube.level + 1;
    return (level >= lattice_.exact_level && tree_.has_free_ball(*cube.node, cube.lane, count_)) ||
           (level >= lattice_.leaf_level && best_.offer(tree_.child_cube(*cube.node, cube.lane)));
  }

  void push_children(VerdictNode& node) noexcept {
    std::array<float, 8> distances_m;  // NOLINT(*-member-init): written before it is read
    const float half_m = lattice_.half_side_m(node.cube.level + 1);
    std::uint32_t near =
        near_children(question_.axis, node.cube, half_m, best_.bound_m(), distances_m) & std::uint32_t{node.open};
    for (; near != 0; near &= near - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(near));
      if (!frontier_.push({&node, distances_m[lane], lane})) {
        stop(distances_m[lane]);
      }
    }
  }

  /// Nothing is known from here on.
  void stop(float distance_m) noexcept {
    const double guarded_m = static_cast<double>(distance_m) - near_guard_m(lattice_.extent_m);
    unseen_m_ = guarded_m > 0 ? std::min(guarded_m, unseen_m_) : 0.0;  // what is no number, too, means nothing is known
  }

  [[nodiscard]] Nearest result() const noexcept {
    return unseen_m_ < best_.distance_m() ? Nearest{unseen_m_, false, true} : best_.nearest();
  }

  VerdictTree& tree_;
  const Lattice& lattice_;
  Frontier& frontier_;
  const Question& question_;
  NearestLeaf best_;
  double unseen_m_;  ///< from here on something was not looked at
  Count& count_;
};

}  // namespace

Nearest find_nearest(VerdictTree& tree, Frontier& frontier, const Question& question, RemainingBudget& budget,
                     Count& count) noexcept {
  // Either there is room for all that the budget pays for, or the search begins with an empty tree: where it ends does
  // not depend on what was remembered.
  const auto paid = static_cast<std::size_t>(std::max(budget.nodes(), std::int64_t{0}));
  tree.make_room(budget.is_counted() ? std::min(paid, tree.capacity()) : tree.capacity() / 8);
  Nearest touching;
  return touches(tree.query(), question, touching) ? touching : Expansion(tree, frontier, question, count).run(budget);
}

}  // namespace depthgrid::search
