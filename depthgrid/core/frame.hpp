// What arrives with every exposure of one camera.
#pragma once

#include <cstddef>

#include "depthgrid/core/depth_image.hpp"

namespace depthgrid {

/// The robot as one camera sees it: for each pixel the depth interval [near_m, far_m] of the padded robot model
/// along that pixel's frustum, at the joint positions of the exposure. near_m = 0: no robot in this pixel. Where a
/// ray crosses the robot several times this is the contiguous interval that holds its first surface. The whole interval
/// of a pixel's frustum counts as robot. Same size as the depth image; the buffers must outlive the view.
/// A camera's pixel counts as robot only where its own measured depth lies in the interval and far_m is finite.
struct RobotView {
  const float* near_m = nullptr;  ///< null: no robot in view
  const float* far_m = nullptr;
  std::ptrdiff_t stride_px = 0;  ///< floats between rows; 0: rows without padding
};

/// One exposure of one camera: depth and, where there is one, the robot in it. Never owns memory.
struct Frame {
  DepthView depth;
  RobotView robot;
  double time_s = 0.0;  ///< middle of the exposure, on the clock that all cameras of the rig share
};

}  // namespace depthgrid
