// The levels of a pyramid from their rows below. Internal.
#pragma once

#include <cstddef>
#include <vector>

#include "depthgrid/views/preparation_rows.hpp"
#include "depthgrid/views/view.hpp"

namespace depthgrid::views {

/// Row j of level 0 of a pyramid of minima is written: writes the rows of the levels above that were waiting for it.
/// `scratch` is a row of PreparationRows. Rows of level 0 come in their order.
void minimum_rows_above(const std::vector<PyramidLevel>& levels, int j, float* scratch, float* texels) noexcept;

/// Rows of the island pyramids in which a texel may hold an island: those of all levels, one level after the other.
[[nodiscard]] std::size_t row_count(const std::vector<PyramidLevel>& levels) noexcept;

/// Builds the island pyramids: the largest `near` and the smallest `far` of what each texel covers. `image_columns`:
/// where each row of the images may hold islands, and holds "none" elsewhere. `texel_columns` says the same of all rows
/// of the pyramids as they are, and is brought up to date.
void build_island_pyramids(const std::vector<PyramidLevel>& levels, const float* near_m, const float* far_m,
                           const std::vector<PixelRange>& image_columns, float* scratch, float* near_maxima_m,
                           float* far_minima_m, std::vector<PixelRange>& texel_columns) noexcept;

}  // namespace depthgrid::views
