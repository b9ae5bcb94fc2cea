#include "depthgrid/grid/removed_robot.hpp"

#include <cmath>

#include "depthgrid/core/usable_frame.hpp"

namespace depthgrid::grid {

RemovedRobot::RemovedRobot(const RigCamera& camera, double beyond_m)
    : rule_(camera.rule),
      beyond_m_(static_cast<float>(beyond_m)),
      depth_m_(camera.intrinsics.width_px, camera.intrinsics.height_px) {}

Frame RemovedRobot::of(const Frame& frame) noexcept {
  if (frame.robot.near_m == nullptr) {
    return frame;
  }
  const Frame read = with_strides(frame);
  normalise(read.depth, rule_, depth_m_);
  for (int v = 0; v < depth_m_.height_px(); ++v) {
    for (int u = 0; u < depth_m_.width_px(); ++u) {
      const std::ptrdiff_t at = v * read.robot.stride_px + u;
      float& reading_m = depth_m_.at(u, v);
      if (read.robot.near_m[at] > 0 && read.robot.near_m[at] <= reading_m && reading_m <= read.robot.far_m[at] &&
          std::isfinite(read.robot.far_m[at])) {
        reading_m = beyond_m_;
      }
    }
  }
  return {depth_view(depth_m_), {}, frame.time_s};
}

}  // namespace depthgrid::grid
