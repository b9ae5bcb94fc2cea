// What the pixels of an image count as: readings, and in small holes what surrounds them. Written for obviousness:
// every pixel asks all places and all pixels around.
#pragma once

#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/margin.hpp"

namespace depthgrid::reference {

/// A missing pixel p belongs to the last of the steps below whose shape is missing somewhere within `around_px` of p,
/// or to the first. The step after it has radius r: then every disc of diameter W = 2 r that comes within half a
/// pixel's diagonal of p's centre shows a reading, and p counts as
///
///     min(s f / W, least reading no more than W + half a diagonal of columns and rows away) - s / 2,
///
/// the last divided by 1 - m'(bound), since the margin is subtracted afterwards. In the last step there is no W: 0.
///
/// Steps by radius: a pixel, 0.70711; two neighbours in a row or column, 1; three of two by two, 1.11804; digital discs
/// of squared radius k, sqrt(k) + 0.70711, for k = 1 and every next sum of two squares that is at least 1.25 times the
/// last, up to the first with a diameter of at least s f / (max(near, 0.25) + s / 2) or a radius above 52.
///
/// Windows begin and end at multiples of the first power of two of which 3.5 are no less than W and half a diagonal.
/// Least readings of float images are in steps of 1/4096 m, rounded down, and what is written is rounded down to a
/// value that the measurement rule takes for a reading.
///
/// `readings_m`: 0 = none, as the measurement rule has it. Returns them with holes filled.
[[nodiscard]] std::vector<float> with_holes_filled(const std::vector<float>& readings_m, const PinholeCamera& camera,
                                                   const MeasurementRule& rule, const SensorMargin& margin,
                                                   const DepthView& format, double smallest_obstacle_m);

}  // namespace depthgrid::reference
