#include "depthgrid/grid/classification.hpp"

#include <cmath>
#include <limits>

namespace depthgrid::grid {

Classification classify(std::span<const Eigen::Vector3d> samples_world, std::span<const ViewingCamera> cameras,
                        const SensorMargin& margin, double slack_m) noexcept {
  Classification result;
  double nearest_camera_m = std::numeric_limits<double>::infinity();
  bool occluded = false;
  bool unmeasured = false;
  for (std::size_t k = 0; k < cameras.size(); ++k) {
    const ViewingCamera& view = cameras[k];
    for (const Eigen::Vector3d& sample_world : samples_world) {
      const Eigen::Vector3d x_camera = view.T_camera_world * sample_world;
      if (!(x_camera.z() > 0)) {
        continue;
      }
      const DepthPoint p = project(view.camera, x_camera);
      if (!(p.x_px >= 0 && p.y_px >= 0 && p.x_px < view.camera.width_px && p.y_px < view.camera.height_px)) {
        continue;
      }
      const double depth_m = view.measured_m->at(static_cast<int>(p.x_px), static_cast<int>(p.y_px));
      if (!(depth_m > 0) || p.depth_m < view.near_m) {
        unmeasured = true;
        continue;
      }
      const double reach_m = depth_margin_m(margin, depth_m) + slack_m;
      if (std::abs(p.depth_m - depth_m) <= reach_m) {
        if (x_camera.norm() < nearest_camera_m) {
          nearest_camera_m = x_camera.norm();
          result.camera = static_cast<std::uint16_t>(k);
        }
      } else if (p.depth_m > depth_m) {
        occluded = true;
      }
    }
  }
  if (result.camera) {
    result.state = ProximityState::measured;
  } else if (occluded) {
    result.state = ProximityState::occluded;
  } else if (unmeasured) {
    result.state = ProximityState::unmeasured;
  }
  return result;
}

}  // namespace depthgrid::grid
