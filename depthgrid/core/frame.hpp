// What arrives with every exposure of one camera.
#pragma once

#include <cstddef>
#include <limits>
#include <span>

#include "depthgrid/core/capsule.hpp"
#include "depthgrid/core/depth_image.hpp"

namespace depthgrid {

/// The robot as one camera sees it: the depth interval [near_m, far_m] that it fills in each pixel.
/// - Shape: that of the depth image.
/// - Unit: metres of depth; near_m = 0: no robot in this pixel.
/// - Memory: not owned; the buffers must outlive the view.
///
/// The interval is that of the padded robot model along the pixel's frustum, at the joint positions of the exposure,
/// and all of it counts as robot. Where a ray crosses the robot several times it is the contiguous interval that holds
/// its first surface. A camera's pixel counts as robot only where its own measured depth D lies in the interval and
/// far_m is finite; m being the sensor's margin, that is where near_m <= D - m(D) and D <= far_m, or, with
/// within_margin, where near_m <= D + m(D) and D - m(D) <= far_m.
struct RobotView {
  const float* near_m = nullptr;  ///< null: no robot in view
  const float* far_m = nullptr;
  std::ptrdiff_t stride_px = 0;  ///< floats between rows; 0: rows without padding
  /// The blind layer: nothing that is farther than this from the robot's surface is taken for it, wherever in a pixel
  /// it stands. Metres; NaN: not stated, and then no answer can say. Whoever makes the intervals states it:
  /// robot::RobotRemoval does, with_layer() (core/blind_layer.hpp) for rendered ones.
  double blind_m = std::numeric_limits<double>::quiet_NaN();
  /// No part of the padded robot in the image is farther from the camera than this, metres.
  double reach_m = std::numeric_limits<double>::quiet_NaN();
  /// A reading counts as the robot where some of what it may mean lies in the interval, not only where all of it does.
  /// Then the padding need not hold the sensor's margin, and what stands before the robot, within 2 m(D) of the layer
  /// along a camera's ray, may be taken for it (docs/robot.md). Only the search knows it; everything else asks for all.
  bool within_margin = false;
  /// The links that are in this image, world frame, each grown by its padding: a memory takes what is in them for the
  /// robot. Not owned. Empty: it learns of the robot by the image alone.
  std::span<const Capsule> links_world{};
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
