#include "depthgrid/grid/classification.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depthgrid::grid {
namespace {

/// What the pixels around (u, v) say of a sample at depth z.
struct Look {
  bool measured = false;
  bool occluded = false;
  Unmeasured unmeasured = Unmeasured::not_told;

  void says_nothing(Unmeasured why) noexcept { unmeasured = first_of(unmeasured, why); }
};

Look look(const ViewingCamera& view, int u, int v, double z_m, const SensorMargin& margin, double slack_m) noexcept {
  Look result;
  const DepthImage& measured_m = *view.measured_m;
  const int radius_px = margin.lateral_px;
  // Beyond the image's edge nothing is measured, so the free depth of the pixels beside it is 0.
  if (u < radius_px || v < radius_px || u + radius_px >= measured_m.width_px() ||
      v + radius_px >= measured_m.height_px()) {
    result.says_nothing(Unmeasured::image_edge);
  }
  for (int j = std::max(0, v - radius_px); j <= std::min(measured_m.height_px() - 1, v + radius_px); ++j) {
    for (int i = std::max(0, u - radius_px); i <= std::min(measured_m.width_px() - 1, u + radius_px); ++i) {
      const double depth_m = measured_m.at(i, j);
      if (!(depth_m > 0)) {
        result.says_nothing(Unmeasured::no_reading);
      } else if (view.is_robot != nullptr && view.is_robot[measured_m.index(i, j)] != 0) {
        result.occluded = result.occluded || z_m > depth_m;
      } else if (std::abs(z_m - depth_m) <= depth_margin_m(margin, depth_m) + slack_m) {
        result.measured = true;
      } else if (z_m > depth_m) {
        result.occluded = true;
      }
    }
  }
  return result;
}

}  // namespace

Classification classify(std::span<const Eigen::Vector3d> samples_world, std::span<const ViewingCamera> cameras,
                        const SensorMargin& margin, double slack_m) noexcept {
  Classification result;
  double nearest_camera_m = std::numeric_limits<double>::infinity();
  bool occluded = false;
  Unmeasured unmeasured = Unmeasured::not_told;
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
      if (p.depth_m < view.near_m) {
        unmeasured = first_of(unmeasured, Unmeasured::blind_zone);
        continue;
      }
      const Look seen = look(view, static_cast<int>(p.x_px), static_cast<int>(p.y_px), p.depth_m, margin, slack_m);
      if (seen.measured && x_camera.norm() < nearest_camera_m) {
        nearest_camera_m = x_camera.norm();
        result.camera = static_cast<std::uint16_t>(k);
      }
      occluded = occluded || seen.occluded;
      unmeasured = first_of(unmeasured, seen.unmeasured);
    }
  }
  if (result.camera) {
    result.state = ProximityState::measured;
  } else if (occluded) {
    result.state = ProximityState::occluded;
  } else if (unmeasured != Unmeasured::not_told) {
    result.state = ProximityState::unmeasured;
    result.unmeasured = unmeasured;
  }
  return result;
}

}  // namespace depthgrid::grid
