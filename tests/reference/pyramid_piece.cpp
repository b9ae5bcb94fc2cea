#include "reference/pyramid_piece.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depthgrid::reference {
namespace {

/// x less its nearest value in an interval.
double excess(double x, double low, double high) { return x < low ? x - low : (x > high ? x - high : 0.0); }

}  // namespace

Eigen::Vector3d PyramidPiece::nearest_to(const Eigen::Vector3d& p) const {
  // At a given depth the nearest point is p clamped to the slice. The squared distance is convex in the depth and
  // piecewise quadratic: Newton's step on half its slope, inside a bracket. No nearest point is deeper than |p|.
  double low = d1_m;
  double high = std::min(d2_m, std::max(d1_m, p.norm()));
  double z = std::clamp(p.z(), low, high);
  for (int step = 0; step < 100 && high > low; ++step) {
    const double x = excess(p.x(), a0 * z, a1 * z);
    const double y = excess(p.y(), b0 * z, b1 * z);
    const double a = x < 0 ? a0 : (x > 0 ? a1 : 0.0);
    const double b = y < 0 ? b0 : (y > 0 ? b1 : 0.0);
    const double slope = z - p.z() - a * x - b * y;
    (slope < 0 ? low : high) = z;
    double next = z - slope / (1 + a * a + b * b);
    if (!(next >= low && next <= high)) {
      next = 0.5 * (low + high);
    }
    if (std::abs(next - z) < 1e-13) {
      break;
    }
    z = next;
  }
  return {std::clamp(p.x(), a0 * z, a1 * z), std::clamp(p.y(), b0 * z, b1 * z), z};
}

double PyramidPiece::support(const Eigen::Vector3d& direction) const {
  const double growth = std::max(direction.x() * a0, direction.x() * a1) +
                        std::max(direction.y() * b0, direction.y() * b1) + direction.z();
  return growth > 0 ? growth * d2_m : growth * d1_m;
}

Separation separation(const PyramidPiece& piece, const Eigen::Vector3d& a, const Eigen::Vector3d& b, double enough_m) {
  constexpr double kPrecisionM = 1e-7;
  const Eigen::Vector3d axis = b - a;
  Separation result{0.0, Eigen::Vector3d::Zero()};
  double upper_m = std::numeric_limits<double>::infinity();
  // One point of the axis: true when nothing is left to find. `slope` is that of the distance along the axis.
  double slope = 0;
  const auto attempt = [&](double t) {
    const Eigen::Vector3d p = a + t * axis;
    const Eigen::Vector3d nearest = piece.nearest_to(p);
    const double distance_m = (p - nearest).norm();
    if (distance_m < upper_m) {
      upper_m = distance_m;
      result.nearest = nearest;
    }
    if (distance_m == 0) {
      return true;
    }
    // Whatever the normal, the gap between the two sets along it is a lower bound of their distance.
    const Eigen::Vector3d normal = (p - nearest) / distance_m;
    slope = normal.dot(axis);
    const double gap_m = std::min(normal.dot(a), normal.dot(b)) - piece.support(normal);
    result.lower_m = std::max(result.lower_m, gap_m);
    return result.lower_m >= std::min(enough_m, upper_m - kPrecisionM);
  };
  if (attempt(0) || axis.isZero(0)) {
    return result;
  }
  double low = 0;
  double slope_low = slope;
  if (attempt(1)) {
    return result;
  }
  double high = 1;
  double slope_high = slope;
  // The distance is convex along the axis: false position on its slope, with every third step in the middle.
  for (int step = 1; step < 60 && slope_low < 0 && slope_high > 0; ++step) {
    const double t = step % 3 == 0 ? 0.5 * (low + high) : low + (high - low) * slope_low / (slope_low - slope_high);
    if (attempt(t)) {
      break;
    }
    (slope < 0 ? low : high) = t;
    (slope < 0 ? slope_low : slope_high) = slope;
  }
  return result;
}

}  // namespace depthgrid::reference
