// The levels of a pyramid from their rows below. Internal.
#pragma once

#include <vector>

#include "depthgrid/views/prepared_image.hpp"

namespace depthgrid::views {

/// Row j of level 0 of a pyramid of minima is written: writes the rows of the levels above that were waiting for it.
/// `scratch` is a row of PreparationRows. Rows of level 0 come in their order.
void minimum_rows_above(const std::vector<PyramidLevel>& levels, int j, float* scratch, float* texels) noexcept;

/// Builds the island pyramids of `image` from its island images and columns: the largest `near` and the smallest `far`
/// of what each texel covers.
void build_island_pyramids(PreparedImage& image, float* scratch) noexcept;

}  // namespace depthgrid::views
