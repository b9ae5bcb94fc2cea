// Depth images in colour.
#pragma once

#include "depthgrid/core/depth_image.hpp"
#include "report/canvas.hpp"

namespace depthgrid::report {

/// Depths that get the first and the last colour, metres.
struct DepthRange {
  double near_m = 0.5;
  double far_m = 5.0;
};

/// The range of an image's measured depths; the default one when nothing is measured.
[[nodiscard]] DepthRange depth_range(const DepthImage& depth_m) noexcept;

/// One pixel a pixel; 0 (no measurement) in kNoMeasurement.
[[nodiscard]] Raster depth_raster(const DepthImage& depth_m, const DepthRange& range);

/// The image scaled to fill `area`.
void draw_depth(Canvas& canvas, const Rectangle& area, const DepthImage& depth_m, const DepthRange& range);

/// A horizontal bar with the colours from near to far and the depths at its ends in metres.
void draw_depth_legend(Canvas& canvas, const Rectangle& area, const DepthRange& range);

}  // namespace depthgrid::report
