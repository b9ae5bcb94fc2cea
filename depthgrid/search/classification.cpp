#include "depthgrid/search/classification.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depthgrid::search {
namespace {

/// What one camera says of a point.
struct Look {
  bool measured = false;
  bool occluded = false;
  bool unmeasured = false;
};

Look look(const View& view, const SensorMargin& margin, int u, int v, double z_m, double slack_m) noexcept {
  Look result;
  const DepthImage& measured_m = view.measured_m();
  const int reach_px = margin.lateral_px;
  result.unmeasured = u < reach_px || v < reach_px || u + reach_px >= view.width_px() || v + reach_px >= view.height_px();
  for (int j = std::max(0, v - reach_px); j <= std::min(view.height_px() - 1, v + reach_px); ++j) {
    for (int i = std::max(0, u - reach_px); i <= std::min(view.width_px() - 1, u + reach_px); ++i) {
      const double depth_m = static_cast<double>(measured_m.at(i, j));
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
    const Pose& T_world_camera = view.T_world_camera();
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
    const Look seen = look(view, snapshot.settings().margins[k].sensor, static_cast<int>(p.x_px),
                           static_cast<int>(p.y_px), p.depth_m, slack_m);
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
