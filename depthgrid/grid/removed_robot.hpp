// Images with the robot taken out: RobotPixels::removed. Internal.
#pragma once

#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/rig.hpp"

namespace depthgrid::grid {

/// Of one camera. A pixel whose reading lies in the robot's interval reads `beyond_m`, which the camera could measure.
class RemovedRobot {
 public:
  RemovedRobot(const RigCamera& camera, double beyond_m);

  /// The frame must be usable. Its depth is good until the next call.
  [[nodiscard]] Frame of(const Frame& frame) noexcept;

 private:
  MeasurementRule rule_;
  float beyond_m_;
  DepthImage depth_m_;
};

}  // namespace depthgrid::grid
