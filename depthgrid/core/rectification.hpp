// The pinhole camera as which a distorted depth image is best handed on.
#pragma once

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/distortion.hpp"

namespace depthgrid {

/// Intrinsics for DepthUndistortion that keep what the lens sees: the same focal lengths, so nothing near the axis gets
/// coarser, and columns and rows added on each side until every ray up to 65 degrees off the axis that falls into the
/// distorted image has a pixel. Each side grows by at most half the image: the rays of a fisheye towards 90 degrees
/// have no end on a plane, and what lies beyond is cut off (DepthUndistortion::pixels_read()). Never smaller than
/// `distorted`, and equal to it without a lens. Throws Error as validate() and refuse_fold().
[[nodiscard]] PinholeCamera rectified_camera(const PinholeCamera& distorted, const Distortion& lens);

}  // namespace depthgrid
