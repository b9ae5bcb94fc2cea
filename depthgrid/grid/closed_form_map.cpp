#include "depthgrid/grid/closed_form_map.hpp"

#include <algorithm>
#include <cmath>

#include "depthgrid/core/error.hpp"

namespace depthgrid::grid {

ClosedFormMap::ClosedFormMap(const DepthGrid& grid, std::span<const SecondaryCamera> secondaries) {
  for (int n = -kPadding; n <= grid.count() + kPadding; ++n) {
    const int begin = std::clamp(n, 0, grid.count() - 1);
    boundary_m_.push_back(static_cast<float>(grid.boundary_m(std::clamp(n, 0, grid.count()))));
    centre_m_.push_back(static_cast<float>(0.5 * (grid.boundary_m(begin) + grid.boundary_m(begin + 1))));
  }
  const PinholeCamera& p = grid.principal();
  for (const SecondaryCamera& secondary : secondaries) {
    const PinholeCamera& s = secondary.camera;
    validate(s, "secondary camera");
    if (!secondary.T_secondary_principal.matrix().allFinite()) {
      fail("depth grid map: the pose of a secondary camera is not finite");
    }
    Eigen::Matrix3d intrinsics;
    intrinsics << s.fx_px, 0, s.cx_px, 0, s.fy_px, s.cy_px, 0, 0, 1;
    Eigen::Matrix3d ray_of_pixel;  // columns: constant, per u, per v; at the pixel's centre
    ray_of_pixel << (0.5 - p.cx_px) / p.fx_px, 1 / p.fx_px, 0, (0.5 - p.cy_px) / p.fy_px, 0, 1 / p.fy_px, 1, 0, 0;
    const Eigen::Matrix3d a = intrinsics * secondary.T_secondary_principal.linear() * ray_of_pixel;
    const Eigen::Vector3d b = intrinsics * secondary.T_secondary_principal.translation();
    Camera camera{};
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        camera.a[row][column] = static_cast<float>(a(row, column));
      }
      camera.b[row] = static_cast<float>(b(row));
    }
    camera.half_spread_z = static_cast<float>(0.5 * (std::abs(a(2, 1)) + std::abs(a(2, 2))));
    camera.width_px = static_cast<float>(s.width_px);
    camera.height_px = static_cast<float>(s.height_px);
    cameras_.push_back(camera);
  }
}

}  // namespace depthgrid::grid
