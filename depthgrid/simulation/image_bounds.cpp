#include "depthgrid/simulation/image_bounds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace depthgrid::simulation {

namespace {

struct Range {
  double lower = std::numeric_limits<double>::infinity();
  double upper = -std::numeric_limits<double>::infinity();
};

/// Slopes x/z between which the circle of radius r around (x, z), z > r, is seen from the origin.
void extend(Range& range, double x, double z, double r) {
  const double denominator = z * z - r * r;
  const double spread = r * std::sqrt(std::max(0.0, x * x + denominator));
  range.lower = std::min(range.lower, (x * z - spread) / denominator);
  range.upper = std::max(range.upper, (x * z + spread) / denominator);
}

/// First pixel and one past the last, one pixel wider on each side to absorb rounding.
int pixel(double x_px, int margin, int size) {
  return static_cast<int>(std::clamp(std::floor(x_px) + margin, 0.0, static_cast<double>(size)));
}

PixelBounds bounds_of_hull(const PinholeCamera& camera, std::span<const Sphere> spheres) {
  constexpr double kNearest = 1e-6;
  Range x;
  Range y;
  bool all_behind = true;
  bool all_in_front = true;
  for (const Sphere& s : spheres) {
    all_behind = all_behind && s.centre_world.z() < -s.radius_m;
    all_in_front = all_in_front && s.centre_world.z() > s.radius_m + kNearest;
  }
  if (all_behind) {
    return {};
  }
  if (!all_in_front) {
    return {0, 0, camera.width_px, camera.height_px};
  }
  for (const Sphere& s : spheres) {
    extend(x, s.centre_world.x(), s.centre_world.z(), s.radius_m);
    extend(y, s.centre_world.y(), s.centre_world.z(), s.radius_m);
  }
  return {pixel(camera.fx_px * x.lower + camera.cx_px, -1, camera.width_px),
          pixel(camera.fy_px * y.lower + camera.cy_px, -1, camera.height_px),
          pixel(camera.fx_px * x.upper + camera.cx_px, 2, camera.width_px),
          pixel(camera.fy_px * y.upper + camera.cy_px, 2, camera.height_px)};
}

}  // namespace

PixelBounds image_bounds(const PinholeCamera& camera, const Plane& /*plane*/) noexcept {
  return {0, 0, camera.width_px, camera.height_px};
}

PixelBounds image_bounds(const PinholeCamera& camera, const Box& box) noexcept {
  std::array<Sphere, 8> corners;
  for (unsigned i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d sign((i & 1U) != 0 ? 1 : -1, (i & 2U) != 0 ? 1 : -1, (i & 4U) != 0 ? 1 : -1);
    corners[i] = {box.T_world_box * box.half_size_m.cwiseProduct(sign), 0.0};
  }
  return bounds_of_hull(camera, corners);
}

PixelBounds image_bounds(const PinholeCamera& camera, const Sphere& sphere) noexcept {
  return bounds_of_hull(camera, std::span(&sphere, 1));
}

PixelBounds image_bounds(const PinholeCamera& camera, const Capsule& capsule) noexcept {
  const std::array<Sphere, 2> ends{Sphere{capsule.a, capsule.radius_m}, Sphere{capsule.b, capsule.radius_m}};
  return bounds_of_hull(camera, ends);
}

}  // namespace depthgrid::simulation
