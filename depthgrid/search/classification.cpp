#include "depthgrid/search/classification.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depthgrid::search {
namespace {

/// Pixels to each side that are looked at at most.
constexpr double kWidestLook = 24;

/// What one camera says of a point.
struct Look {
  bool measured = false;
  bool occluded = false;
  bool unmeasured = false;
};

/// Pixels around (u, v) from the filter's reach on, up to window_px.
Look look(const View& view, const SensorMargin& margin, int u, int v, double z_m, double slack_m,
          int window_px) noexcept {
  Look result;
  result.unmeasured =
      u < window_px || v < window_px || u + window_px >= view.width_px() || v + window_px >= view.height_px();
  for (int j = std::max(0, v - window_px); j <= std::min(view.height_px() - 1, v + window_px); ++j) {
    for (int i = std::max(0, u - window_px); i <= std::min(view.width_px() - 1, u + window_px); ++i) {
      const double depth_m = static_cast<double>(view.measured_m().at(i, j));
      if (!(depth_m > 0)) {
        result.unmeasured = true;
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

Classification classify(const Snapshot& snapshot, const Eigen::Vector3d& x_world) noexcept {
  Classification result;
  double nearest_camera_m = std::numeric_limits<double>::infinity();
  bool occluded = false;
  bool unmeasured = false;
  for (std::size_t k = 0; k < snapshot.camera_count(); ++k) {
    const View& view = snapshot.view(k);
    const RigCamera& camera = snapshot.camera(k);
    const Pose& T_world_camera = snapshot.T_world_camera(k);
    const Eigen::Vector3d x = T_world_camera.linear().transpose() * (x_world - T_world_camera.translation());
    if (!(x.z() > 0)) {
      continue;
    }
    const DepthPoint p = project(camera.intrinsics, x);
    if (!(p.x_px >= 0 && p.y_px >= 0 && p.x_px < camera.intrinsics.width_px && p.y_px < camera.intrinsics.height_px)) {
      continue;
    }
    if (p.depth_m <= camera.rule.near_m) {
      unmeasured = true;
      continue;
    }
    const PoseMargin& e = snapshot.pose_margin(k);
    const double range_m = x.norm();
    const double slack_m =
        snapshot.settings().resolution_m + e.translation_m + e.time_m + e.rotation_rad * range_m;
    const SensorMargin& margin = snapshot.settings().margins[k].sensor;
    const auto u = static_cast<int>(p.x_px);
    const auto v = static_cast<int>(p.y_px);
    Look seen = look(view, margin, u, v, p.depth_m, slack_m, margin.lateral_px);
    if (!seen.measured && !seen.occluded && !seen.unmeasured) {
      // What keeps the camera from freeing the point stands beside it, within slack and reach.
      const double aside_px = slack_m * std::max(camera.intrinsics.fx_px, camera.intrinsics.fy_px) / p.depth_m;
      const int window_px = margin.lateral_px + 1 + static_cast<int>(std::min(aside_px, kWidestLook));
      seen = look(view, margin, u, v, p.depth_m, slack_m, window_px);
      seen.unmeasured = seen.unmeasured || p.depth_m - slack_m <= camera.rule.near_m;
      // Beyond the widest look: the camera looks there and does not free it, so something is before it.
      seen.occluded = seen.occluded || (!seen.measured && !seen.unmeasured);
    }
    if (seen.measured && range_m < nearest_camera_m) {
      nearest_camera_m = range_m;
      result.camera = static_cast<std::uint16_t>(k);
    }
    occluded = occluded || seen.occluded;
    unmeasured = unmeasured || seen.unmeasured;
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

}  // namespace depthgrid::search
