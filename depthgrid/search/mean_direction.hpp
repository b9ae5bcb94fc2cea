// The mean of the directions to all obstacles around a capsule. Internal.
#pragma once

#include <Eigen/Core>

#include "depthgrid/core/capsule.hpp"
#include "depthgrid/search/nearest_leaf.hpp"
#include "depthgrid/search/remaining_budget.hpp"
#include "depthgrid/search/repulsion_table.hpp"
#include "depthgrid/search/verdict_tree.hpp"

namespace depthgrid::search {

/// Mean of the unit vectors from the axis to all obstacle space within rho of the capsule's surface, weighted by volume
/// and by the repulsion v(D). Cubes are split until their side is about a third of their distance or 1/16 of rho, and
/// count as their centre does. Zero where there is no such space; coarser where the budget ends it. The question's
/// limit is rho and the radius; `repulsion` is of these settings.
[[nodiscard]] Eigen::Vector3d mean_direction(VerdictTree& tree, const Question& question, double radius_m,
                                             const views::Settings& settings, const RepulsionTable& repulsion,
                                             RemainingBudget& budget, Count& count) noexcept;

}  // namespace depthgrid::search
