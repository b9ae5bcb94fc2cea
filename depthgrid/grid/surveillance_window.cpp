#include "depthgrid/grid/surveillance_window.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid::grid {
namespace {

/// The pixels [begin, end) that the continuous interval [low, high] touches, clipped to [0, size).
void touched(double low_px, double high_px, int size_px, int& begin, int& end) noexcept {
  begin = static_cast<int>(std::floor(std::clamp(low_px, 0.0, static_cast<double>(size_px))));
  end = static_cast<int>(std::floor(std::clamp(high_px, -1.0, size_px - 1.0))) + 1;
}

struct Slopes {
  double low, high;
};

/// Slopes x/z of the two tangents from the origin to the circle of radius rho around (x, z), z > rho.
Slopes tangent_slopes(double x, double z, double rho) noexcept {
  const double root = rho * std::sqrt(x * x + z * z - rho * rho);
  const double denominator = z * z - rho * rho;
  return {(x * z - root) / denominator, (x * z + root) / denominator};
}

}  // namespace

PixelWindow whole_image(const PinholeCamera& camera) noexcept { return {0, 0, camera.width_px, camera.height_px}; }

PixelWindow printed_window(const PinholeCamera& camera, const DepthPoint& p, double rho_m) noexcept {
  if (!(p.depth_m > rho_m)) {
    return whole_image(camera);
  }
  const double x_s = rho_m * camera.fx_px / (p.depth_m - rho_m);
  const double y_s = rho_m * camera.fy_px / (p.depth_m - rho_m);
  PixelWindow window;
  touched(p.x_px - x_s / 2, p.x_px + x_s / 2, camera.width_px, window.u_begin, window.u_end);
  touched(p.y_px - y_s / 2, p.y_px + y_s / 2, camera.height_px, window.v_begin, window.v_end);
  return window;
}

PixelWindow sphere_window(const PinholeCamera& camera, const Eigen::Vector3d& p_camera, double rho_m) noexcept {
  if (p_camera.z() <= -rho_m) {
    return {};
  }
  // Just above rho the tangents run almost along the image plane: the quotient loses its digits before it matters.
  if (p_camera.z() <= rho_m * (1 + 1e-9)) {
    return whole_image(camera);
  }
  constexpr double kRoundingPx = 1e-6;
  const Slopes x = tangent_slopes(p_camera.x(), p_camera.z(), rho_m);
  const Slopes y = tangent_slopes(p_camera.y(), p_camera.z(), rho_m);
  PixelWindow window;
  touched(camera.cx_px + camera.fx_px * x.low - kRoundingPx, camera.cx_px + camera.fx_px * x.high + kRoundingPx,
          camera.width_px, window.u_begin, window.u_end);
  touched(camera.cy_px + camera.fy_px * y.low - kRoundingPx, camera.cy_px + camera.fy_px * y.high + kRoundingPx,
          camera.height_px, window.v_begin, window.v_end);
  return window;
}

}  // namespace depthgrid::grid
