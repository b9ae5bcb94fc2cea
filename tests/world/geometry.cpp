#include "world/geometry.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid::world {
namespace {

using Eigen::Vector3d;

double to_segment_m(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d axis = b - a;
  const double square = axis.squaredNorm();
  const double s = square > 0 ? std::clamp((p - a).dot(axis) / square, 0.0, 1.0) : 0.0;
  return (p - a - s * axis).norm();
}

/// The earlier crossing of a quadratic a s^2 + 2 b s + c <= 0, if it is crossed at all.
std::optional<double> first_root(double a, double b, double c) {
  const double discriminant = b * b - a * c;
  return a > 0 && discriminant >= 0 ? std::optional((-b - std::sqrt(discriminant)) / a) : std::nullopt;
}

}  // namespace

// The distance is that of an end to the other segment, or that of the two lines' nearest points where both lie on the
// segments. Each candidate is the distance of two points that do lie on them, so none is too small.
double segment_distance_m(const Vector3d& a0, const Vector3d& a1, const Vector3d& b0, const Vector3d& b1) {
  double least_m = std::min(std::min(to_segment_m(a0, b0, b1), to_segment_m(a1, b0, b1)),
                            std::min(to_segment_m(b0, a0, a1), to_segment_m(b1, a0, a1)));
  const Vector3d a = a1 - a0;
  const Vector3d b = b1 - b0;
  const Vector3d between = a0 - b0;
  const double determinant = a.squaredNorm() * b.squaredNorm() - a.dot(b) * a.dot(b);
  if (determinant > 0) {
    const double s = (a.dot(b) * b.dot(between) - b.squaredNorm() * a.dot(between)) / determinant;
    const double t = (a.squaredNorm() * b.dot(between) - a.dot(b) * a.dot(between)) / determinant;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1) {
      least_m = std::min(least_m, (between + s * a - t * b).norm());
    }
  }
  return least_m;
}

double gap_m(const Capsule& a, const Capsule& b) {
  return segment_distance_m(a.a, a.b, b.a, b.b) - a.radius_m - b.radius_m;
}

double gap_m(const Capsule& a, const HalfSpace& b) {
  return std::min(b.normal.dot(a.a), b.normal.dot(a.b)) - a.radius_m - b.offset_m;
}

double gap_m(const Capsule& a, const Vector3d& point) { return to_segment_m(point, a.a, a.b) - a.radius_m; }

std::optional<double> first_hit(const Capsule& capsule, const Vector3d& ray) {
  if (gap_m(capsule, Vector3d::Zero()) <= 0) {
    return 0.0;
  }
  std::optional<double> first;
  const auto keep = [&first](double s) {
    if (s >= 0 && (!first || s < *first)) {
      first = s;
    }
  };
  const double radius_square = capsule.radius_m * capsule.radius_m;
  for (const Vector3d* end : {&capsule.a, &capsule.b}) {
    if (const auto s = first_root(ray.squaredNorm(), -ray.dot(*end), end->squaredNorm() - radius_square)) {
      keep(*s);
    }
  }
  const Vector3d axis = capsule.b - capsule.a;
  const double square = axis.squaredNorm();
  if (square > 0) {
    const Vector3d ray_across = ray - ray.dot(axis) / square * axis;
    const Vector3d a_across = capsule.a - capsule.a.dot(axis) / square * axis;
    const auto s =
        first_root(ray_across.squaredNorm(), -ray_across.dot(a_across), a_across.squaredNorm() - radius_square);
    if (s) {
      const double along = (*s * ray - capsule.a).dot(axis);
      if (along >= 0 && along <= square) {
        keep(*s);
      }
    }
  }
  return first;
}

}  // namespace depthgrid::world
