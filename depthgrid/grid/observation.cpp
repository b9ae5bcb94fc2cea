#include "depthgrid/grid/observation.hpp"

#include <algorithm>
#include <cmath>

#include "depthgrid/core/usable_frame.hpp"

namespace depthgrid::grid {

Observation::Observation(const RigCamera& camera, const SensorMargin* margins)
    : camera_(camera),
      with_free_depth_(margins != nullptr),
      measured_m_(camera.intrinsics.width_px, camera.intrinsics.height_px),
      removed_m_(camera.intrinsics.width_px, camera.intrinsics.height_px),
      is_robot_(static_cast<std::size_t>(camera.intrinsics.width_px) *
                static_cast<std::size_t>(camera.intrinsics.height_px)),
      free_(with_free_depth_ ? camera.intrinsics.width_px : 1, with_free_depth_ ? camera.intrinsics.height_px : 1,
            margins != nullptr ? *margins : SensorMargin{}) {}

bool Observation::update(const Frame& frame) noexcept {
  present_ = why_unusable(frame, camera_) == nullptr;
  RobotView robot;
  if (present_) {
    const Frame read = with_strides(frame);
    normalise(read.depth, camera_.rule, measured_m_);
    time_s_ = read.time_s;
    robot = read.robot;
  } else {
    std::fill_n(measured_m_.data(), is_robot_.size(), 0.0F);
  }
  remove_robot(robot);
  if (with_free_depth_) {
    free_.update(measured_m_, robot);
  }
  return present_;
}

void Observation::remove_robot(const RobotView& robot) noexcept {
  std::copy_n(measured_m_.data(), is_robot_.size(), removed_m_.data());
  std::fill(is_robot_.begin(), is_robot_.end(), std::uint8_t{0});
  if (robot.near_m == nullptr) {
    return;
  }
  for (int v = 0; v < measured_m_.height_px(); ++v) {
    const float* near_m = robot.near_m + robot.stride_px * v;
    const float* far_m = robot.far_m + robot.stride_px * v;
    for (int u = 0; u < measured_m_.width_px(); ++u) {
      const float depth_m = measured_m_.at(u, v);
      if (near_m[u] > 0 && depth_m >= near_m[u] && depth_m <= far_m[u] && std::isfinite(far_m[u])) {
        removed_m_.at(u, v) = far_m[u];
        is_robot_[measured_m_.index(u, v)] = 1;
      }
    }
  }
}

}  // namespace depthgrid::grid
