#include "depthgrid/views/blocking_point.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid::views {

bool projects_inside(const PinholeCamera& camera, const Eigen::Vector3d& x_camera) noexcept {
  const DepthPoint pixel = project(camera, x_camera);
  return pixel.x_px >= 0 && pixel.y_px >= 0 && pixel.x_px < camera.width_px && pixel.y_px < camera.height_px;
}

bool blocks(const LocalCamera& camera, const Eigen::Vector3d& x_local, double slack_m) noexcept {
  const Eigen::Vector3d x = camera.to_camera(x_local);
  if (!(x.z() > 0) || !projects_inside(camera.pinhole, x)) {
    return true;
  }
  const PinholeCamera& c = camera.pinhole;
  const DepthPoint at = project(c, x);
  const auto u = static_cast<int>(at.x_px);
  const auto v = static_cast<int>(at.y_px);
  const auto is_robot = [&](int i, int j, double z_m) {
    return camera.has_islands && z_m >= static_cast<double>(camera.image->island_near_m.at(i, j)) &&
           z_m <= static_cast<double>(camera.image->island_far_m.at(i, j));
  };
  if (!(x.z() > camera.near_m)) {
    return !is_robot(u, v, x.z());
  }
  const double part_u = at.x_px - u;
  const double part_v = at.y_px - v;
  const double slack = slack_m + (camera.has_pose_error ? camera.pose_error(x) : 0.0);
  const double tangent = x.head<2>().norm() / x.z();
  // Beside x at lateral distance s begins a pixel whose border has the tangent t to the optical axis; a depth h beyond
  // x is within the slack there if (s + t h)^2 + h^2 <= slack^2, so if h <= c sqrt(slack^2 - s^2 c^2) - s t c^2, c^2 (1
  // + t^2) = 1.
  const auto reaches = [&](int i, int j, double side_m) {
    if (side_m > slack || !c.contains(i, j)) {
      return false;
    }
    const double t = tangent + side_m / x.z();
    const double square = 1 / (1 + t * t);
    const double rest = slack * slack - side_m * side_m * square;
    const double z_m = x.z() + std::max(0.0, std::sqrt(square * rest) - side_m * t * square);
    const auto free_m = static_cast<double>(camera.image->free_m.at(i, j));
    if (z_m < free_m) {
      return false;
    }
    // What is not known free begins at free_m, or where x lies beyond that; in the robot's island it is the robot.
    return !is_robot(i, j, std::max(free_m, x.z()));
  };
  return reaches(u, v, 0) || reaches(part_u < 0.5 ? u - 1 : u + 1, v, std::min(part_u, 1 - part_u) * x.z() / c.fx_px) ||
         reaches(u, part_v < 0.5 ? v - 1 : v + 1, std::min(part_v, 1 - part_v) * x.z() / c.fy_px);
}

}  // namespace depthgrid::views
