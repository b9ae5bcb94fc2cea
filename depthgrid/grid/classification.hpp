// What stands at the nearest point of an answer. Internal.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/margin.hpp"
#include "depthgrid/core/pose.hpp"
#include "depthgrid/core/proximity.hpp"

namespace depthgrid::grid {

/// One camera as the classification sees it.
struct ViewingCamera {
  PinholeCamera camera;
  Pose T_camera_world;
  double near_m = 0;
  const DepthImage* measured_m = nullptr;
  const std::uint8_t* is_robot = nullptr;  ///< a byte a pixel: 1 where the robot was removed; null: no robot
};

struct Classification {
  ProximityState state = ProximityState::unobserved;
  std::optional<std::uint16_t> camera;
  Unmeasured unmeasured = Unmeasured::not_told;
};

/// A camera looks at a sample through its pixel and the pixels within margin.lateral_px of it, because that is what its
/// free depth was taken from: on a slanted surface the nearest of them lies well in front of the pixel's own depth.
/// measured if some camera has one of the samples within [D - m - slack, D + m + slack] of one of these pixels'
/// measured depths D (the nearest such camera is named); else occluded if it is behind one of them for some camera;
/// else unmeasured if a camera looks there without measurement, or so near the
/// image's edge that the filter leaves the image; else unobserved. A removed robot's pixel measures
/// nothing and occludes what is behind it. The samples are points of the nearest
/// cell (world frame); slack_m is the cell's depth, within which the grid cannot tell surface from shadow.
[[nodiscard]] Classification classify(std::span<const Eigen::Vector3d> samples_world,
                                      std::span<const ViewingCamera> cameras, const SensorMargin& margin,
                                      double slack_m) noexcept;

}  // namespace depthgrid::grid
