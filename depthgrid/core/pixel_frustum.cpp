#include "depthgrid/core/pixel_frustum.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid {
namespace {

/// The interval [s0 z, s1 z] of one lateral axis seen from the point's coordinate on that axis.
struct Side {
  double s0, s1, coordinate;

  /// Slope of the face that attracts the point at depth z; 0 where the coordinate lies inside the interval. Over
  /// z >= 0 each face is the attracting one on one stretch only, so equal slopes at two depths mean one linear piece
  /// of F' between them.
  [[nodiscard]] double slope(double z) const noexcept {
    const double upper = s1 * z < coordinate ? s1 : 0.0;
    return s0 * z > coordinate ? s0 : upper;
  }

  /// Coordinate of the nearest point at depth z. Equal to `coordinate`, bit for bit, inside the interval.
  [[nodiscard]] double nearest(double z) const noexcept { return std::max(s0 * z, std::min(coordinate, s1 * z)); }

  /// This axis' part of F'(z) / 2.
  [[nodiscard]] double half_derivative(double z) const noexcept { return slope(z) * (slope(z) * z - coordinate); }
};

struct Problem {
  Side x, y;
  double depth;
  double d1, d2;

  /// Root of the linear piece of F' on which the faces with these slopes attract, clipped to [low, high].
  [[nodiscard]] double root(double slope_x, double slope_y, double low, double high) const noexcept {
    const double z =
        (depth + slope_x * x.coordinate + slope_y * y.coordinate) / (1.0 + slope_x * slope_x + slope_y * slope_y);
    return std::min(std::max(z, low), high);
  }
};

/// The minimiser of F when its linear piece is not the one at the point's own depth: the breakpoints shrink [d1, d2]
/// to the piece that contains the minimum. A slope of 0 gives an infinite or NaN breakpoint, which no comparison lets
/// in.
double minimiser_by_breakpoints(const Problem& problem) noexcept {
  const Side& x = problem.x;
  const Side& y = problem.y;
  double low = problem.d1;
  double high = problem.d2;
  for (const double z : {x.coordinate / x.s0, x.coordinate / x.s1, y.coordinate / y.s0, y.coordinate / y.s1}) {
    if (z > low && z < high) {
      const bool falling = z - problem.depth + x.half_derivative(z) + y.half_derivative(z) < 0.0;
      low = falling ? z : low;
      high = falling ? high : z;
    }
  }
  // Any depth inside the piece tells its faces. Where rounding leaves no depth inside, the clip decides. (A minimum
  // beyond the last breakpoint is not beyond the point's own depth, so minimiser() has found it: `high` is infinite
  // here only when rounding brings such a case along.)
  const double inside = std::isinf(high) ? 2.0 * low + 1.0 : 0.5 * (low + high);
  return problem.root(x.slope(inside), y.slope(inside), low, high);
}

/// Depth of the nearest point. Most cells are settled by the piece at the point's own depth, with one division.
double minimiser(const Problem& problem) noexcept {
  const double start = std::min(std::max(problem.depth, problem.d1), problem.d2);
  const double slope_x = problem.x.slope(start);
  const double slope_y = problem.y.slope(start);
  const double z = problem.root(slope_x, slope_y, problem.d1, problem.d2);
  if (problem.x.slope(z) == slope_x && problem.y.slope(z) == slope_y) {
    return z;
  }
  return minimiser_by_breakpoints(problem);
}

Problem problem_of(const PixelFrustum& frustum, const Eigen::Vector3d& p_camera) noexcept {
  return {{frustum.a0, frustum.a1, p_camera.x()},
          {frustum.b0, frustum.b1, p_camera.y()},
          p_camera.z(),
          frustum.d1_m,
          frustum.d2_m};
}

NearestPoint from_point(const Eigen::Vector3d& point_camera, const Eigen::Vector3d& p_camera) noexcept {
  const Eigen::Vector3d step = point_camera - p_camera;
  const double distance_m = step.norm();
  if (!(distance_m > 0.0)) {
    return {point_camera, 0.0, Eigen::Vector3d::Zero()};
  }
  return {point_camera, distance_m, step / distance_m};
}

}  // namespace

PixelFrustum pixel_frustum(const PinholeCamera& camera, int u, int v, double d1_m, double d2_m) noexcept {
  return {(u - camera.cx_px) / camera.fx_px,
          (u + 1.0 - camera.cx_px) / camera.fx_px,
          (v - camera.cy_px) / camera.fy_px,
          (v + 1.0 - camera.cy_px) / camera.fy_px,
          d1_m,
          d2_m};
}

NearestPoint nearest_point(const PixelFrustum& frustum, const Eigen::Vector3d& p_camera) noexcept {
  const Problem problem = problem_of(frustum, p_camera);
  const double z = minimiser(problem);
  return from_point({problem.x.nearest(z), problem.y.nearest(z), z}, p_camera);
}

double squared_distance(const PixelFrustum& frustum, const Eigen::Vector3d& p_camera) noexcept {
  const Problem problem = problem_of(frustum, p_camera);
  const double z = minimiser(problem);
  const double dx = problem.x.nearest(z) - p_camera.x();
  const double dy = problem.y.nearest(z) - p_camera.y();
  const double dz = z - p_camera.z();
  return dx * dx + dy * dy + dz * dz;
}

NearestPoint nearest_point_letter(const PinholeCamera& camera, int u, int v, double d1_m, double d2_m,
                                  const DepthPoint& p) noexcept {
  const Eigen::Vector3d p_camera = deproject(camera, p);
  return from_point(p_camera + LetterDistance(camera, p).vector(u, v, d1_m, d2_m), p_camera);
}

}  // namespace depthgrid
