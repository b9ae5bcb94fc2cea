// What arrives with every exposure of one camera.
#pragma once

#include <cstddef>

#include "depthgrid/core/depth_image.hpp"

namespace depthgrid {

/// The robot as one camera sees it: the depth interval [near_m, far_m] that it fills in each pixel.
/// - Shape: that of the depth image.
/// - Unit: metres of depth; near_m = 0: no robot in this pixel.
/// - Memory: not owned; the buffers must outlive the view.
///
/// The interval is that of the padded robot model along the pixel's frustum, at the joint positions of the exposure,
/// and all of it counts as robot. Where a ray crosses the robot several times it is the contiguous interval that holds
/// its first surface. A camera's pixel counts as robot only where its own measured depth lies in the interval and far_m
/// is finite.
struct RobotView {
  const float* near_m = nullptr;  ///< null: no robot in view
  const float* far_m = nullptr;
  std::ptrdiff_t stride_px = 0;  ///< floats between rows; 0: rows without padding
};

/// One exposure of one camera: depth and, where there is one, the robot in it.
/// - Unit of time: seconds.
/// - Memory: not owned.
struct Frame {
  DepthView depth;
  RobotView robot;
  double time_s = 0.0;  ///< middle of the exposure, on the clock that all cameras of the rig share
};

}  // namespace depthgrid
