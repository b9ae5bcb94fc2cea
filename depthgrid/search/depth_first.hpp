// The search without a budget. Internal.
#pragma once

#include "depthgrid/search/nearest_leaf.hpp"
#include "depthgrid/search/recent_leaves.hpp"
#include "depthgrid/search/verdict_tree.hpp"

namespace depthgrid::search {

/// What calls leave to those after them.
struct Memory {
  explicit Memory(std::size_t cells) : tree(cells) {}

  /// From here on about this snapshot and, unless it is null, this memory of the space, which have to be held.
  void aim(const views::Snapshot& snapshot, const memory::MemorySnapshot* memory) noexcept;

  VerdictTree tree;
  RecentLeaves leaves;  ///< of this snapshot
  RecentLeaves before;  ///< of the one before: a guess where to look
};

/// The nearest leaf, depth first, children nearer to the axis before the others. It begins with leaves that were the
/// nearest lately, and cubes that are no nearer than the best so far are passed over.
[[nodiscard]] Nearest find_nearest(Memory& memory, const Question& question, Count& count) noexcept;

}  // namespace depthgrid::search
