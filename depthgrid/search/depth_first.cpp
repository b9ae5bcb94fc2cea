#include "depthgrid/search/depth_first.hpp"

#include <algorithm>
#include <array>
#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "depthgrid/search/depth_first.cpp"
#include <hwy/foreach_target.h>
// After foreach_target: it must be seen once for each target.
#include "depthgrid/search/near_children-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace depthgrid::search::octants::HWY_NAMESPACE {

/// The nearest leaf below a node.
class Walk {
 public:
  Walk(VerdictTree& tree, const Question& question, NearestLeaf& best, Count& count) noexcept
      : tree_(tree), lattice_(tree.query().lattice), question_(question), best_(best), count_(count) {}

  // NOLINTNEXTLINE(misc-no-recursion): as deep as the lattice
  void visit(VerdictNode& node) noexcept {
    const int level = node.cube.level + 1;
    std::array<float, 8> distances_m;  // NOLINT(*-member-init): written before it is read
    const std::uint32_t near = near_of(node.open & ~std::uint32_t{node.exhausted}, question_.axis, node.cube,
                                       lattice_.half_side_m(level), best_.bound_m(), distances_m);
    if (near == 0) {
      return;
    }
    const std::uint32_t octant = octant_of_axis(node.cube);
    for (std::uint32_t rest = turned(near, octant); rest != 0; rest &= rest - 1) {
      const std::size_t lane = static_cast<std::uint32_t>(std::countr_zero(rest)) ^ octant;
      if (distances_m[lane] < best_.bound_m() && !has_leaves(node, lane, level)) {
        node.exhausted |= static_cast<std::uint8_t>(1U << lane);
      }
    }
  }

 private:
  /// Looks at a child; false when it is known that there are no leaves in it, for any question: a cube on the border of
  /// W that is split for one is a leaf for another.
  // NOLINTNEXTLINE(misc-no-recursion): as deep as the lattice
  bool has_leaves(VerdictNode& node, std::size_t lane, int level) noexcept {
    if (level >= lattice_.exact_level && tree_.has_free_ball(node, lane, count_)) {
      return false;
    }
    if (level >= lattice_.leaf_level && best_.offer(tree_.child_cube(node, lane))) {
      return true;
    }
    VerdictNode spare;
    VerdictNode& child = tree_.child(node, lane, spare, count_);
    if (child.open != 0) {
      visit(child);
    }
    return level >= lattice_.leaf_level || (child.open & ~std::uint32_t{child.exhausted}) != 0;
  }

  /// The octant of a cube that the axis is nearest to.
  [[nodiscard]] std::uint32_t octant_of_axis(const Cube& cube) const noexcept {
    const Axis& axis = question_.axis;
    const float product = ((cube.x - axis.a[0]) * axis.along[0] + (cube.y - axis.a[1]) * axis.along[1] +
                           (cube.z - axis.a[2]) * axis.along[2]) *
                          axis.inverse_square;
    const float t = std::clamp(product, 0.0F, 1.0F);
    return (axis.a[0] + t * axis.along[0] > cube.x ? 1U : 0U) | (axis.a[1] + t * axis.along[1] > cube.y ? 2U : 0U) |
           (axis.a[2] + t * axis.along[2] > cube.z ? 4U : 0U);
  }

  /// Bit i of the result: bit i ^ octant of the lanes. So nearer children come first.
  [[nodiscard]] static std::uint32_t turned(std::uint32_t lanes, std::uint32_t octant) noexcept {
    lanes = (octant & 1U) != 0 ? ((lanes & 0x55U) << 1U) | ((lanes >> 1U) & 0x55U) : lanes;
    lanes = (octant & 2U) != 0 ? ((lanes & 0x33U) << 2U) | ((lanes >> 2U) & 0x33U) : lanes;
    return (octant & 4U) != 0 ? ((lanes & 0x0FU) << 4U) | ((lanes >> 4U) & 0x0FU) : lanes;
  }

  VerdictTree& tree_;
  const Lattice& lattice_;
  const Question& question_;
  NearestLeaf& best_;
  Count& count_;
};

void walk(VerdictTree& tree, const Question& question, NearestLeaf& best, Count& count) {
  Walk(tree, question, best, count).visit(tree.root(count));
}

}  // namespace depthgrid::search::octants::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace depthgrid::search {
namespace octants {

HWY_EXPORT(walk);

/// Offers leaves to `best` until no other can be nearer.
void walk_from_root(VerdictTree& tree, const Question& question, NearestLeaf& best, Count& count) noexcept {
  HWY_DYNAMIC_DISPATCH(walk)(tree, question, best, count);
}

}  // namespace octants

namespace {

/// Obstacles move this much from one snapshot to the next, roughly, metres. Decides about time only.
constexpr float kMoved = 0.01F;

}  // namespace

void Memory::aim(const views::Snapshot& snapshot, const memory::MemorySnapshot* memory) noexcept {
  if (tree.aim(snapshot, memory)) {
    before = leaves;
    leaves.clear();
  }
}

Nearest find_nearest(Memory& memory, const Question& question, Count& count) noexcept {
  VerdictTree& tree = memory.tree;
  // Without room for more the search still ends, but leaves nothing to the next.
  tree.make_room(tree.capacity() / 8);
  Nearest touching;
  if (touches(tree.query(), question, touching)) {
    return touching;
  }
  NearestLeaf best(tree.query(), question);
  float about_m = 0;
  bool whole = false;
  if (!memory.leaves.empty()) {
    best.offer(memory.leaves.nearest_to(question.axis, about_m));
  }
  if (!memory.before.empty()) {
    static_cast<void>(memory.before.nearest_to(question.axis, about_m));
    const auto guess_m = static_cast<double>(about_m + kMoved);
    if (guess_m < best.distance_m()) {
      // If something is as near as in the snapshot before, nothing farther needs to be looked at.
      best.look_within(guess_m);
      octants::walk_from_root(tree, question, best, count);
      whole = best.found() && best.distance_m() <= guess_m;
      best.look_within(best.distance_m());
    }
  }
  if (!whole) {
    octants::walk_from_root(tree, question, best, count);
  }
  if (best.found()) {
    memory.leaves.add(best.leaf());
  }
  return best.nearest();
}

}  // namespace depthgrid::search
#endif
