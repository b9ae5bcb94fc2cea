#include "depthgrid/search/space.hpp"

#include <array>
#include <limits>

namespace depthgrid::search {
namespace {

/// normal . x <= offset holds inside; normal has unit length.
struct Plane {
  Eigen::Vector3d normal;
  double offset_m;
};

Border nearest_plane(const std::array<Plane, 6>& planes, const Eigen::Vector3d& p) noexcept {
  Border result{std::numeric_limits<double>::infinity(), p};
  for (const Plane& plane : planes) {
    const double distance_m = plane.offset_m - plane.normal.dot(p);
    if (!(distance_m >= result.distance_m)) {
      result = {distance_m, p + distance_m * plane.normal};
    }
  }
  return result;
}

}  // namespace

Border border_of_space(const views::Snapshot& snapshot, const Eigen::Vector3d& p_world) noexcept {
  const views::Settings& settings = snapshot.settings();
  using V = Eigen::Vector3d;
  if (const auto* box = std::get_if<views::BoxSpace>(&settings.space)) {
    return nearest_plane({{{V(-1, 0, 0), -box->low_world.x()},
                           {V(1, 0, 0), box->high_world.x()},
                           {V(0, -1, 0), -box->low_world.y()},
                           {V(0, 1, 0), box->high_world.y()},
                           {V(0, 0, -1), -box->low_world.z()},
                           {V(0, 0, 1), box->high_world.z()}}},
                         p_world);
  }
  const auto& frustum = std::get<views::FrustumSpace>(settings.space);
  const Pose& T_world_camera = snapshot.T_world_camera(frustum.principal);
  const PinholeCamera& c = snapshot.camera(frustum.principal).intrinsics;
  const V p = T_world_camera.linear().transpose() * (p_world - T_world_camera.translation());
  const double left = -c.cx_px / c.fx_px;
  const double right = (c.width_px - c.cx_px) / c.fx_px;
  const double top = -c.cy_px / c.fy_px;
  const double bottom = (c.height_px - c.cy_px) / c.fy_px;
  Border border = nearest_plane({{{V(-1, 0, left).normalized(), 0},
                                  {V(1, 0, -right).normalized(), 0},
                                  {V(0, -1, top).normalized(), 0},
                                  {V(0, 1, -bottom).normalized(), 0},
                                  {V(0, 0, -1), -frustum.d_min_m},
                                  {V(0, 0, 1), frustum.d_max_m}}},
                                p);
  border.point_world = T_world_camera * border.point_world;
  return border;
}

}  // namespace depthgrid::search
