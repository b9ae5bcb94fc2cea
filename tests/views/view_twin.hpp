// A prepared image pixel by pixel from its definition, in extended precision: slow and plain.
#pragma once

#include <gtest/gtest.h>

#include "depthgrid/core/rig.hpp"
#include "depthgrid/views/view.hpp"

namespace depthgrid::views {

/// Whether `view` is what its camera's newest frame `frame` (its buffers are still alive) has to be made into:
/// - measured depths equal those of measured_depth_m(), bit for bit;
/// - free depths lie at or below the exact ones, by at most 2^-20 of the depths that they are made of (1 um a metre);
/// - a pixel is an island exactly where the robot begins beyond the free depth, up to that rounding, or in the blind
///   zone, and holds the robot's interval, bit for bit;
/// - every texel of every level is the extremum of the pixels that it covers, bit for bit.
testing::AssertionResult follows_definition(const View& view, const RigCamera& camera, const CameraMargins& margins,
                                            const Policies& policies, const Frame& frame);

}  // namespace depthgrid::views
