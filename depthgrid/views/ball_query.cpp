#include "depthgrid/views/ball_query.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "depthgrid/core/pixel_frustum.hpp"
#include "depthgrid/views/ball_scan.hpp"

namespace depthgrid::views {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kGuard = 1e-9;

/// A ball in one camera's frame and the piece of the image that it can touch.
struct Ball {
  const LocalCamera& camera;
  const Clip& clip;
  Eigen::Vector3d p;
  double radius_m;
  double squared_radius;

  [[nodiscard]] bool meets(const Window& pixels, double d1_m, double d2_m) const noexcept {
    d1_m = std::max(d1_m, clip.to_view ? clip.d_min_m : 0.0);
    d2_m = std::min(d2_m, clip.to_view ? clip.d_max_m : kInfinity);
    if (d1_m > d2_m || d1_m > p.z() + radius_m || d2_m < p.z() - radius_m) {
      return false;
    }
    const PinholeCamera& c = camera.pinhole;
    const PixelFrustum frustum{(pixels.u0 - c.cx_px) / c.fx_px,
                               (pixels.u1 + 1 - c.cx_px) / c.fx_px,
                               (pixels.v0 - c.cy_px) / c.fy_px,
                               (pixels.v1 + 1 - c.cy_px) / c.fy_px,
                               d1_m,
                               d2_m};
    return squared_distance(frustum, p) <= squared_radius;
  }

  /// The two parts of a pixel's frustum that are not known free, each less the robot's island.
  [[nodiscard]] bool meets_pixel(int u, int v) const noexcept {
    const PreparedImage& image = *camera.image;
    const auto free_m = static_cast<double>(image.free_m.at(u, v));
    const double start_m = free_m > camera.near_m ? free_m : camera.near_m;
    const Window pixel{u, v, u, v};
    if (!camera.has_islands) {
      return meets(pixel, start_m, kInfinity) || (camera.near_m > 0 && meets(pixel, 0, camera.near_m));
    }
    const auto near_m = static_cast<double>(image.island_near_m.at(u, v));
    const auto far_m = static_cast<double>(image.island_far_m.at(u, v));
    if (!(near_m <= far_m)) {
      return meets(pixel, start_m, kInfinity) || (camera.near_m > 0 && meets(pixel, 0, camera.near_m));
    }
    return (near_m > start_m && meets(pixel, start_m, near_m)) || meets(pixel, std::max(start_m, far_m), kInfinity) ||
           (camera.near_m > 0 && (meets(pixel, 0, std::min(camera.near_m, near_m)) ||
                                  (far_m < camera.near_m && meets(pixel, far_m, camera.near_m))));
  }

  /// Whether the ball meets the not known free part of a block of 2^level pixels a side.
  [[nodiscard]] bool meets_block(int level, int i, int j, const Window& window) const noexcept {
    const Window block{std::max(i << level, window.u0), std::max(j << level, window.v0),
                       std::min(((i + 1) << level) - 1, window.u1), std::min(((j + 1) << level) - 1, window.v1)};
    if (block.u0 > block.u1 || block.v0 > block.v1) {
      return false;
    }
    if (level == 0) {
      return meets_pixel(i, j);
    }
    const double smallest_m = smallest(level, i, j);
    const bool blind = p.z() - radius_m <= camera.near_m;
    if (!blind && !meets(block, smallest_m, kInfinity)) {
      return false;
    }
    if (blind && !meets(block, 0, kInfinity)) {
      return false;
    }
    for (int child = 0; child < 4; ++child) {
      if (meets_block(level - 1, 2 * i + (child & 1), 2 * j + (child >> 1), window)) {
        return true;
      }
    }
    return false;
  }

  /// The least free depth of a block.
  [[nodiscard]] double smallest(int level, int i, int j) const noexcept {
    if (level >= 2) {
      // The texel two levels down covers this block exactly.
      const PyramidLevel& texels = camera.levels[level - 2];
      return static_cast<double>(camera.minima_m[texels.offset + 4 * j * texels.width + 4 * i]);
    }
    const int last_u = camera.pinhole.width_px - 1;
    const int last_v = camera.pinhole.height_px - 1;
    float smallest_m = std::numeric_limits<float>::infinity();
    for (int v = 2 * j; v <= std::min(2 * j + 1, last_v); ++v) {
      for (int u = 2 * i; u <= std::min(2 * i + 1, last_u); ++u) {
        smallest_m = std::min(smallest_m, camera.image->free_m.at(u, v));
      }
    }
    return static_cast<double>(smallest_m);
  }
};

/// The pixels that a ball can project to, not clipped. The ball must lie in front of the camera's plane, or the whole
/// image is returned.
Window window_of(const PinholeCamera& camera, const Eigen::Vector3d& p, double radius_m) noexcept {
  const double low_z = p.z() - radius_m;
  if (low_z <= 1e-9) {
    return {0, 0, camera.width_px - 1, camera.height_px - 1};
  }
  const double high_z = p.z() + radius_m;
  const auto bounds = [&](double x, double f_px, double c_px) {
    const double low = x - radius_m;
    const double high = x + radius_m;
    const double first = f_px * low / (low < 0 ? low_z : high_z) + c_px - 1e-6;
    const double last = f_px * high / (high < 0 ? high_z : low_z) + c_px + 1e-6;
    return std::array<int, 2>{static_cast<int>(std::floor(std::clamp(first, -1e8, 1e8))),
                              static_cast<int>(std::floor(std::clamp(last, -1e8, 1e8)))};
  };
  const auto [u0, u1] = bounds(p.x(), camera.fx_px, camera.cx_px);
  const auto [v0, v1] = bounds(p.y(), camera.fy_px, camera.cy_px);
  return {u0, v0, u1, v1};
}

/// How far inside the image's four borders a point in front of the camera lies; negative outside.
double inside_image_m(const PinholeCamera& c, const Eigen::Vector3d& p) noexcept {
  // Distance to the planes x = s z through the camera's centre and the image's borders.
  const auto inside_m = [&](double x, double slope, double sign) {
    return sign * (x - slope * p.z()) / std::sqrt(1 + slope * slope);
  };
  return std::min({inside_m(p.x(), -c.cx_px / c.fx_px, 1), inside_m(p.x(), (c.width_px - c.cx_px) / c.fx_px, -1),
                   inside_m(p.y(), -c.cy_px / c.fy_px, 1), inside_m(p.y(), (c.height_px - c.cy_px) / c.fy_px, -1)});
}

bool leaves_view(const PinholeCamera& c, const Eigen::Vector3d& p, double radius_m) noexcept {
  return p.z() <= radius_m || inside_image_m(c, p) <= radius_m;
}

}  // namespace

bool meets_not_known_free(const LocalCamera& camera, const Clip& clip, const Eigen::Vector3d& p_camera,
                          double radius_m) noexcept {
  radius_m += kGuard;
  Window window = window_of(camera.pinhole, p_camera, radius_m);
  // With pixels to all sides of it the ball is far from the view's border.
  const bool amid = window.u0 > 0 && window.v0 > 0 && window.u1 < camera.pinhole.width_px - 1 &&
                    window.v1 < camera.pinhole.height_px - 1;
  if (!clip.to_view && !amid && leaves_view(camera.pinhole, p_camera, radius_m)) {
    return true;
  }
  window = {std::max(window.u0, 0), std::max(window.v0, 0), std::min(window.u1, camera.pinhole.width_px - 1),
            std::min(window.v1, camera.pinhole.height_px - 1)};
  if (window.u0 > window.u1 || window.v0 > window.v1) {
    return false;  // only with to_view: outside the image nothing counts
  }
  const Ball ball{camera, clip, p_camera, radius_m, radius_m * radius_m};
  if (p_camera.z() - radius_m > camera.near_m && p_camera.z() > radius_m && can_scan(camera, window)) {
    // Guarded for the position's rounding, for that of distances from it, and for that of the pixels' borders.
    const Eigen::Vector3f p = p_camera.cast<float>();
    const float radius = static_cast<float>(radius_m) + 2 * camera.guard_m;
    const float border_m = camera.guard_px * (p.z() + radius) / std::min(camera.fx, camera.fy);
    const ScannedBall scanned{p.x(), p.y(), p.z(), radius + border_m, window};
    return scan(
        camera, scanned,
        [](const void* context, int u, int v) { return static_cast<const Ball*>(context)->meets_pixel(u, v); }, &ball);
  }
  const int side = std::max(window.u1 - window.u0, window.v1 - window.v0);
  int level = 0;
  while ((1 << level) < side && level < camera.level_count + 1) {
    ++level;
  }
  for (int j = window.v0 >> level; j <= window.v1 >> level; ++j) {
    for (int i = window.u0 >> level; i <= window.u1 >> level; ++i) {
      if (ball.meets_block(level, i, j, window)) {
        return true;
      }
    }
  }
  return false;
}

bool covers_some(const LocalCamera& camera, const Eigen::Vector3d& p_camera, double radius_m) noexcept {
  return p_camera.z() + radius_m >= camera.near_m && inside_image_m(camera.pinhole, p_camera) >= -radius_m;
}

}  // namespace depthgrid::views
