// The search with a budget. Internal.
#pragma once

#include "depthgrid/search/frontier.hpp"
#include "depthgrid/search/nearest_leaf.hpp"
#include "depthgrid/search/remaining_budget.hpp"
#include "depthgrid/search/verdict_tree.hpp"

namespace depthgrid::search {

/// The nearest leaf, cubes in the order of their distance, so that what has been looked at bounds the answer at any
/// time. Counts every cube that it opens, whether it is remembered or not: a budget of nodes ends it at the same place
/// whatever was asked before.
[[nodiscard]] Nearest find_nearest(VerdictTree& tree, Frontier& frontier, const Question& question,
                                   RemainingBudget& budget, Count& count) noexcept;

}  // namespace depthgrid::search
