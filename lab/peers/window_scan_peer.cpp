#include "lab/peers/window_scan_peer.hpp"

#include <algorithm>
#include <cmath>

#include "lab/peers/wide_scan.hpp"

namespace depthgrid::lab {

namespace {

/// From p (camera frame) to the nearest of the four planes that bound the view; 0 outside.
double border_distance_m(const PinholeCamera& camera, const Eigen::Vector3d& p) {
  const auto to_plane = [&p](double coordinate, double slope) {
    return (coordinate - slope * p.z()) / std::hypot(1.0, slope);
  };
  const double left_m = to_plane(p.x(), -camera.cx_px / camera.fx_px);
  const double right_m = to_plane(-p.x(), -(camera.width_px - camera.cx_px) / camera.fx_px);
  const double top_m = to_plane(p.y(), -camera.cy_px / camera.fy_px);
  const double bottom_m = to_plane(-p.y(), -(camera.height_px - camera.cy_px) / camera.fy_px);
  return std::max(0.0, std::min({left_m, right_m, top_m, bottom_m}));
}

}  // namespace

WindowScanPeer::WindowScanPeer(const PeerSetting& setting, Combine combine) : rho_m_(setting.rho_m), combine_(combine) {
  for (const RigCamera& source : setting.rig.cameras) {
    Camera& camera = cameras_.emplace_back();
    camera.source = source;
    camera.T_camera_world = source.T_world_camera.inverse();
    camera.free_m = DepthImage(source.intrinsics.width_px, source.intrinsics.height_px);
    for (int u = 0; u < source.intrinsics.width_px; ++u) {
      camera.slope_x.push_back(static_cast<float>((u + 0.5 - source.intrinsics.cx_px) / source.intrinsics.fx_px));
    }
    for (int v = 0; v < source.intrinsics.height_px; ++v) {
      camera.slope_y.push_back(static_cast<float>((v + 0.5 - source.intrinsics.cy_px) / source.intrinsics.fy_px));
    }
    if (combine == Combine::first) {
      break;
    }
  }
}

void WindowScanPeer::prepare(std::span<const Frame> frames, const Region& /*region*/) {
  for (std::size_t k = 0; k < cameras_.size(); ++k) {
    robot_looked_through(frames[k], cameras_[k].source.rule, cameras_[k].free_m);
  }
}

double WindowScanPeer::one_camera_m(const Camera& camera, const Eigen::Vector3d& p_world) const {
  const Eigen::Vector3d p = camera.T_camera_world * p_world;
  const PinholeCamera& intrinsics = camera.source.intrinsics;
  double bound_m = rho_m_;
  if (combine_ == Combine::maximum) {
    // What lies outside the image is not known free either: only then is each camera's distance a bound of the whole.
    bound_m = std::min(bound_m, border_distance_m(intrinsics, p));
  }
  const grid::PixelWindow window = grid::sphere_window(intrinsics, p, bound_m);
  if (window.empty()) {
    return bound_m;
  }
  const RayImage image{camera.free_m.data(), camera.slope_x.data(), camera.slope_y.data(), intrinsics.width_px};
  return std::sqrt(nearest_shadow_squared(image, window, p.cast<float>(), static_cast<float>(bound_m * bound_m)));
}

void WindowScanPeer::query(std::span<const Eigen::Vector3d> points_world, std::span<double> distances_m) {
  for (std::size_t i = 0; i < points_world.size(); ++i) {
    double smallest_m = rho_m_;
    double largest_m = 0;
    for (const Camera& camera : cameras_) {
      const double distance_m = one_camera_m(camera, points_world[i]);
      smallest_m = std::min(smallest_m, distance_m);
      largest_m = std::max(largest_m, distance_m);
    }
    distances_m[i] = combine_ == Combine::maximum ? largest_m : smallest_m;
  }
}

}  // namespace depthgrid::lab
