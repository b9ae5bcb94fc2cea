#include "depthgrid/views/pixel_bounds.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid::views {
namespace {

/// Of a rectangle in continuous coordinates.
bool may_have_islands(const LocalCamera& camera, float u_low, float u_high, float v_low, float v_high) noexcept {
  if (!(u_low < camera.width && u_high >= 0 && v_low < camera.height && v_high >= 0)) {
    return false;
  }
  const auto pixel = [](float at, float size) { return static_cast<int>(std::clamp(at, 0.0F, size - 1)); };
  const PixelRange columns{pixel(u_low, camera.width), pixel(u_high, camera.width) + 1};
  const int last = pixel(v_high, camera.height) / PreparedImage::kBandRows;
  for (int band = pixel(v_low, camera.height) / PreparedImage::kBandRows; band <= last; ++band) {
    if (!common(columns, camera.image->island_bands[static_cast<std::size_t>(band)]).empty()) {
      return true;
    }
  }
  return false;
}

}  // namespace

PixelBounds pixel_bounds(const LocalCamera& camera, const Cube& parent, float half_m) noexcept {
  const auto& r = camera.rotation;
  const auto& a = camera.absolute_rotation;
  const float x = r[0] * parent.x + r[1] * parent.y + r[2] * parent.z + camera.offset_m[0];
  const float y = r[3] * parent.x + r[4] * parent.y + r[5] * parent.z + camera.offset_m[1];
  const float z = r[6] * parent.x + r[7] * parent.y + r[8] * parent.z + camera.offset_m[2];
  float grown = 2 * camera.guard_m;
  if (camera.has_pose_error) {
    // A child that W cuts has its centre up to 3.5 half sides from the parent's.
    const float range = std::sqrt(x * x + y * y + z * z) + 6 * half_m;
    grown += (camera.pose_error_m + camera.pose_error_per_m * range) * 1.0001F;
  }
  const float spread_x = (a[0] + a[1] + a[2]) * half_m;
  const float spread_y = (a[3] + a[4] + a[5]) * half_m;
  const float spread_z = (a[6] + a[7] + a[8]) * half_m;
  const float z_low = z - 2 * spread_z - grown;  // of the parent
  if (!(z_low > 1e-3F)) {
    return {1U << 20U, camera.has_islands};  // the coarsest level
  }
  // A box of half sides h at x has its edges at (x +- h_x) / (z -+ h_z).
  const float half_z = spread_z + grown;
  const float fx = camera.fx / z_low;
  const float fy = camera.fy / z_low;
  const float wide = 2 * fx * (spread_x + grown + (std::abs(x) + 2 * spread_x + grown) / z_low * half_z);
  const float high = 2 * fy * (spread_y + grown + (std::abs(y) + 2 * spread_y + grown) / z_low * half_z);
  const float side = std::min(std::max(wide, high) * 1.0001F + 4 * camera.guard_px, 1e5F);
  PixelBounds result{static_cast<std::uint32_t>(side) + 1, false};
  if (camera.has_islands) {
    // |X / Z - x / z| <= (|X - x| + |x| / z |Z - z|) / Z.
    const float parent_z = 2 * spread_z + grown;
    const float around_u = fx * (2 * spread_x + grown + std::abs(x) / z * parent_z) * 1.0001F + 4 * camera.guard_px;
    const float around_v = fy * (2 * spread_y + grown + std::abs(y) / z * parent_z) * 1.0001F + 4 * camera.guard_px;
    const float u = camera.fx * x / z + camera.cx;
    const float v = camera.fy * y / z + camera.cy;
    result.islands = may_have_islands(camera, u - around_u, u + around_u, v - around_v, v + around_v);
  }
  return result;
}

}  // namespace depthgrid::views
