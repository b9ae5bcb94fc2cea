// The layer around a robot that is removed from images, in which nothing is seen (docs/robot.md).
#pragma once

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/margin.hpp"

namespace depthgrid {

/// Intervals of a robot whose surface was grown by padding_m, each along the ray through its pixel's centre, with their
/// layer stated: the padding and half a pixel's diagonal where the robot is farthest. Looks at every pixel. Nothing is
/// stated when the padding is negative or not finite. `robot`: of the camera's size.
[[nodiscard]] RobotView with_layer(RobotView robot, const PinholeCamera& camera, double padding_m) noexcept;

/// The layer in the world, where readings may stand lateral_px beside their place and the camera elsewhere: that of the
/// view, and what these errors are at its reach. Metres; 0 without robot, NaN where the view does not state its own.
/// Only lateral_px of `sensor` counts: a reading is the robot's only if all that it may mean lies in the interval. Time
/// does not count: the layer is one of the exposure.
[[nodiscard]] double blind_layer_m(const RobotView& robot, const PinholeCamera& camera, const SensorMargin& sensor,
                                   const PoseMargin& pose) noexcept;

/// Half a pixel's diagonal at depth 1.
[[nodiscard]] double half_pixel(const PinholeCamera& camera) noexcept;

/// The thicker of two; not known (NaN) where one is not.
[[nodiscard]] double thicker(double a_m, double b_m) noexcept;

}  // namespace depthgrid
