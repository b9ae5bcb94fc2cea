// A depth image without the robot, as every peer sees it.
#pragma once

#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/frame.hpp"

namespace depthgrid::lab {

/// Depth of everything but the robot, for clouds: 0 = no measurement, or the robot.
void robot_removed(const Frame& frame, const MeasurementRule& rule, DepthImage& depth_m);

/// Depth up to which each pixel's ray is free, for shadows: the robot's exit where the pixel shows the robot, 0 = no
/// measurement.
void robot_looked_through(const Frame& frame, const MeasurementRule& rule, DepthImage& free_m);

}  // namespace depthgrid::lab
