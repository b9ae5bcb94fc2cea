// One or more cameras side by side that look along z through a small region, and images that show one depth.
#pragma once

#include <vector>

#include "depthgrid/core/frame.hpp"
#include "depthgrid/memory/settings.hpp"
#include "depthgrid/views/view_store.hpp"

namespace depthgrid::memory {

inline constexpr int kWidth = 160;
inline constexpr int kHeight = 120;
inline constexpr double kFastest = 1.0;  ///< m/s

/// The region is 0.4 m wide, its middle at the world's origin and 1 m before each camera.
inline Rig small_rig(std::size_t cameras = 1) {
  Rig rig{.name = "cell", .cameras = std::vector<RigCamera>(cameras), .T_floor_world = {}};
  for (std::size_t k = 0; k < cameras; ++k) {
    rig.cameras[k].id = std::to_string(k);
    rig.cameras[k].intrinsics = {kWidth, kHeight, 100, 100, 80, 60};
    rig.cameras[k].T_world_camera.translation() = Eigen::Vector3d(0.05 * static_cast<double>(k), 0, -1);
  }
  return rig;
}

inline views::Settings small_settings(std::size_t cameras = 1, double v_max_m_s = kFastest) {
  views::Settings settings;
  settings.space = views::BoxSpace{Eigen::Vector3d::Constant(-1), Eigen::Vector3d::Constant(1)};
  settings.policies = {views::Policy::obstacle, views::Policy::ignored, views::Policy::obstacle, 0};
  settings.margins.resize(cameras);
  for (CameraMargins& margins : settings.margins) {
    margins.sensor = {0.005, 0, 0, 0};
    margins.smallest_obstacle_m = 0;
  }
  settings.v_max_m_s = v_max_m_s;
  return settings;
}

inline MemorySettings small_memory() {
  MemorySettings memory;
  memory.low_world = Eigen::Vector3d::Constant(-0.2);
  memory.high_world = Eigen::Vector3d::Constant(0.2);
  memory.start = StartUnknown{};
  return memory;
}

/// An image that shows one depth, and another in a rectangle of pixels.
class Wall {
 public:
  explicit Wall(float depth_m) : depth_m_(std::size_t{kWidth} * kHeight, depth_m) {}
  Wall& put(int u0, int v0, int u1, int v1, float depth_m) {
    for (int v = v0; v < v1; ++v) {
      for (int u = u0; u < u1; ++u) {
        depth_m_[static_cast<std::size_t>(v * kWidth + u)] = depth_m;
      }
    }
    return *this;
  }
  [[nodiscard]] Frame frame(double time_s) const { return {depth_view(depth_m_, kWidth, kHeight), {}, time_s}; }

 private:
  std::vector<float> depth_m_;
};

}  // namespace depthgrid::memory
