// Readings that say no more than "farther than far_m".
#pragma once

#include <cstdint>

#include "depthgrid/core/depth_image.hpp"

namespace depthgrid::program {

/// Removes what a rule with clamp_beyond_far made far_m of: such a pixel frees space up to there, but no surface was
/// seen there, so it says nothing about noise and agreement. `depth` is normalised by the same rule. Returns how many
/// pixels that were; 0 where the rule does not clamp.
std::int64_t remove_clamped(const MeasurementRule& rule, DepthImage& depth) noexcept;

}  // namespace depthgrid::program
