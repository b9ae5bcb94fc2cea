// The walk along the cells of one principal pixel until all involved secondary cameras confirm an obstacle. Internal.
//
// For the closed form several cells are judged at once with the widest instructions of the machine at hand, chosen at
// run time; the answers are those of one cell after the other, bit for bit.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "depthgrid/grid/closed_form_map.hpp"

namespace depthgrid::grid {

/// Where a walk ended. Without a hit both flags are false.
struct ColumnHit {
  int j = 0;            ///< steps from the start
  bool beyond = false;  ///< cell start + j is confirmed
  bool before = false;  ///< cell start - j is confirmed (j > 0)
};

/// "The existence of an obstacle is considered only if all involved cameras do confirm its presence."
template <class Ray>
[[nodiscard]] bool confirmed_by_all(std::span<const Ray> rays, std::span<const float* const> depths_m, int n) noexcept {
  for (std::size_t k = 0; k < rays.size(); ++k) {
    if (rays[k].confirm(n, depths_m[k]) == Confirmation::denied) {
      return false;
    }
  }
  return true;
}

/// Case (iii): cells start, start +- 1, start +- 2, ... within [first, last], until one is confirmed. Any storage.
template <class Ray>
[[nodiscard]] ColumnHit search_outwards(std::span<const Ray> rays, std::span<const float* const> depths_m, int start,
                                        int first, int last) noexcept {
  for (int j = 0; start + j <= last || start - j >= first; ++j) {
    ColumnHit hit{j, false, false};
    hit.beyond = start + j >= first && start + j <= last && confirmed_by_all(rays, depths_m, start + j);
    hit.before = j > 0 && start - j >= first && start - j <= last && confirmed_by_all(rays, depths_m, start - j);
    if (hit.beyond || hit.before) {
      return hit;
    }
  }
  return {std::max(last - start, start - first), false, false};
}

/// The same with the closed form, several cells at once, by the widest instructions of this machine. Requires
/// 0 <= first <= start <= last < count.
[[nodiscard]] ColumnHit search_outwards_wide(std::span<const ClosedFormMap::Ray> rays,
                                             std::span<const float* const> depths_m, int start, int first,
                                             int last) noexcept;

[[nodiscard]] inline ColumnHit search_outwards(std::span<const ClosedFormMap::Ray> rays,
                                               std::span<const float* const> depths_m, int start, int first,
                                               int last) noexcept {
  // In gray space that every camera shares the first cell decides: not worth a wide look.
  if (confirmed_by_all(rays, depths_m, start)) {
    return {0, true, false};
  }
  return search_outwards_wide(rays, depths_m, start, first, last);
}

/// Cells that the walk looked at, one after the other, to end like this.
[[nodiscard]] inline std::int64_t cells_visited(const ColumnHit& hit, int start, int first, int last) noexcept {
  const int beyond = std::min(start + hit.j, last) - std::max(start, first) + 1;
  const int before = std::min(start - 1, last) - std::max(start - hit.j, first) + 1;
  return std::max(beyond, 0) + std::max(before, 0);
}

}  // namespace depthgrid::grid
