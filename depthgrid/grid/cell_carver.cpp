#include "depthgrid/grid/cell_carver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depthgrid::grid {
namespace {

// Guards that outweigh double rounding at room scale by three orders of magnitude.
constexpr double kGuardPx = 1e-7;
constexpr double kGuardM = 1e-10;

/// Largest quotient x/z over a box around (x, z), z > 0; the smallest is -largest_quotient(-x, z).
double largest_quotient(double x_high, double z_low, double z_high) noexcept {
  return x_high > 0 ? x_high / z_low : x_high / z_high;
}

}  // namespace

CellCarver::CellCarver(const PinholeCamera& camera, const Pose& T_camera_principal, double near_m,
                       const PoseMargin& margin)
    : camera_(camera),
      rotation_(T_camera_principal.linear()),
      origin_(T_camera_principal.translation()),
      near_m_(near_m),
      margin_(margin),
      has_margin_(margin.translation_m > 0 || margin.rotation_rad > 0 || margin.time_m > 0) {}

CellCarver::Edges CellCarver::edges(const PixelFrustum& pixel) const noexcept {
  return {rotation_ * Eigen::Vector3d(pixel.a0, pixel.b0, 1), rotation_ * Eigen::Vector3d(pixel.a1, pixel.b0, 1),
          rotation_ * Eigen::Vector3d(pixel.a0, pixel.b1, 1), rotation_ * Eigen::Vector3d(pixel.a1, pixel.b1, 1)};
}

bool CellCarver::project(const Edges& edges, double d1_m, double d2_m, Extent& extent) const noexcept {
  std::array<Eigen::Vector3d, 8> corners;
  double range_m = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    corners[i] = d1_m * edges[i] + origin_;
    corners[i + 4] = d2_m * edges[i] + origin_;
  }
  if (has_margin_) {
    for (const Eigen::Vector3d& corner : corners) {
      range_m = std::max(range_m, corner.norm());
    }
  }
  const double e = margin_.translation_m + margin_.rotation_rad * range_m + margin_.time_m;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  extent = {kInfinity, -kInfinity, kInfinity, -kInfinity, -kInfinity};
  for (const Eigen::Vector3d& corner : corners) {
    if (!has_margin_) {
      if (!(corner.z() > std::max(near_m_, 1e-6))) {
        return false;
      }
      const double inverse = 1.0 / corner.z();  // its rounding is far below kGuardPx
      extent.u_low = std::min(extent.u_low, corner.x() * inverse);
      extent.u_high = std::max(extent.u_high, corner.x() * inverse);
      extent.v_low = std::min(extent.v_low, corner.y() * inverse);
      extent.v_high = std::max(extent.v_high, corner.y() * inverse);
      extent.z_high = std::max(extent.z_high, corner.z());
      continue;
    }
    const double z_low = corner.z() - e;
    const double z_high = corner.z() + e;
    if (!(z_low > std::max(near_m_, 1e-6))) {
      return false;
    }
    extent.u_low = std::min(extent.u_low, -largest_quotient(e - corner.x(), z_low, z_high));
    extent.u_high = std::max(extent.u_high, largest_quotient(corner.x() + e, z_low, z_high));
    extent.v_low = std::min(extent.v_low, -largest_quotient(e - corner.y(), z_low, z_high));
    extent.v_high = std::max(extent.v_high, largest_quotient(corner.y() + e, z_low, z_high));
    extent.z_high = std::max(extent.z_high, z_high);
  }
  extent.u_low = camera_.fx_px * extent.u_low + camera_.cx_px - kGuardPx;
  extent.u_high = camera_.fx_px * extent.u_high + camera_.cx_px + kGuardPx;
  extent.v_low = camera_.fy_px * extent.v_low + camera_.cy_px - kGuardPx;
  extent.v_high = camera_.fy_px * extent.v_high + camera_.cy_px + kGuardPx;
  return extent.u_low >= 0 && extent.v_low >= 0 && extent.u_high < camera_.width_px &&
         extent.v_high < camera_.height_px;
}

bool CellCarver::frees(const Edges& edges, double d1_m, double d2_m, const DepthImage& free_m) const noexcept {
  Extent extent{};
  if (!project(edges, d1_m, d2_m, extent)) {
    return false;
  }
  const double behind_m = extent.z_high + kGuardM;
  const int u_last = static_cast<int>(extent.u_high);
  const int v_last = static_cast<int>(extent.v_high);
  for (int v = static_cast<int>(extent.v_low); v <= v_last; ++v) {
    for (int u = static_cast<int>(extent.u_low); u <= u_last; ++u) {
      if (!(free_m.at(u, v) > behind_m)) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace depthgrid::grid
