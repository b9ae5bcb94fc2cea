// The levels of a pyramid from their rows below. Internal.
#pragma once

#include <vector>

#include "depthgrid/views/preparation_rows.hpp"
#include "depthgrid/views/prepared_image.hpp"

namespace depthgrid::views {

/// Row j of level 0 of a pyramid of minima is written: writes the rows of the levels above that were waiting for it.
/// Rows of level 0 come in their order.
void minimum_rows_above(const std::vector<PyramidLevel>& levels, int j, float* texels) noexcept;

/// Builds the pyramids of the second interval of `image` from its other pyramid, its island images and their columns.
/// blind_m: where the blind zone ends, rounded up.
void build_second_pyramids(float blind_m, PreparationRows& rows, PreparedImage& image) noexcept;

}  // namespace depthgrid::views
