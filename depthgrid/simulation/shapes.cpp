#include "depthgrid/simulation/shapes.hpp"

#include <algorithm>
#include <cmath>

#include "depthgrid/core/error.hpp"

namespace depthgrid::simulation {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kUnitTolerance = 1e-9;

void require_finite(const char* what, const Eigen::Vector3d& value) {
  if (!value.allFinite()) {
    fail(what, " is (", value.transpose(), "), must be finite");
  }
}

void require_positive(const char* what, double value_m) {
  if (!(std::isfinite(value_m) && value_m > 0)) {
    fail(what, " is ", value_m, " m, must be a positive finite number");
  }
}

Interval both(const Interval& a, const Interval& b) { return {std::max(a.entry, b.entry), std::min(a.exit, b.exit)}; }

/// Hull of two intervals; an empty one adds nothing. Equals the union where that is convex.
Interval hull(const Interval& a, const Interval& b) {
  if (a.empty() || b.empty()) {
    return a.empty() ? b : a;
  }
  return {std::min(a.entry, b.entry), std::max(a.exit, b.exit)};
}

/// t with lower <= origin + t direction <= upper.
Interval slab(double origin, double direction, double lower, double upper) {
  if (direction == 0) {
    return origin >= lower && origin <= upper ? Interval{-kInfinity, kInfinity} : Interval{};
  }
  const double t0 = (lower - origin) / direction;
  const double t1 = (upper - origin) / direction;
  return {std::min(t0, t1), std::max(t0, t1)};
}

/// t with |direction t - to_centre| <= radius. By the foot of the perpendicular: no difference of large squares.
Interval ball(const Eigen::Vector3d& to_centre, const Eigen::Vector3d& direction, double radius_m) {
  const double squared_length = direction.squaredNorm();
  const double t_foot = direction.dot(to_centre) / squared_length;
  const double remainder = radius_m * radius_m - (to_centre - t_foot * direction).squaredNorm();
  if (remainder < 0) {
    return {};
  }
  const double half = std::sqrt(remainder / squared_length);
  return {t_foot - half, t_foot + half};
}

}  // namespace

void validate(const Plane& plane) {
  require_finite("plane: normal", plane.normal);
  if (std::abs(plane.normal.norm() - 1) > kUnitTolerance) {
    fail("plane: normal (", plane.normal.transpose(), ") has length ", plane.normal.norm(), ", must be 1");
  }
  if (!std::isfinite(plane.offset_m)) {
    fail("plane: offset is ", plane.offset_m, " m, must be finite");
  }
}

void validate(const Box& box) {
  require_finite("box: centre", box.T_world_box.translation());
  const Eigen::Matrix3d rotation = box.T_world_box.linear();
  const double deviation = (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(deviation <= kUnitTolerance)) {
    fail("box: rotation deviates from orthonormal by ", deviation, ", must be at most ", kUnitTolerance);
  }
  require_positive("box: half size in x", box.half_size_m.x());
  require_positive("box: half size in y", box.half_size_m.y());
  require_positive("box: half size in z", box.half_size_m.z());
}

void validate(const Sphere& sphere) {
  require_finite("sphere: centre", sphere.centre_world);
  require_positive("sphere: radius", sphere.radius_m);
}

void validate(const Capsule& capsule) {
  require_finite("capsule: end a", capsule.a);
  require_finite("capsule: end b", capsule.b);
  require_positive("capsule: radius", capsule.radius_m);
}

Eigen::Vector3d nearest_point(const Plane& plane, const Eigen::Vector3d& p_world) noexcept {
  return p_world - std::max(0.0, plane.normal.dot(p_world) - plane.offset_m) * plane.normal;
}

Eigen::Vector3d nearest_point(const Box& box, const Eigen::Vector3d& p_world) noexcept {
  if (contains(box, p_world)) {
    return p_world;
  }
  const Eigen::Vector3d p_box = box.T_world_box.inverse(Eigen::Isometry) * p_world;
  return box.T_world_box * p_box.cwiseMax(-box.half_size_m).cwiseMin(box.half_size_m);
}

Eigen::Vector3d nearest_point(const Sphere& sphere, const Eigen::Vector3d& p_world) noexcept {
  const Eigen::Vector3d from_centre = p_world - sphere.centre_world;
  const double distance_m = from_centre.norm();
  return distance_m <= sphere.radius_m ? p_world : sphere.centre_world + from_centre * (sphere.radius_m / distance_m);
}

Eigen::Vector3d nearest_point(const Capsule& capsule, const Eigen::Vector3d& p_world) noexcept {
  return nearest_point(Sphere{nearest_on_axis(capsule, p_world), capsule.radius_m}, p_world);
}

bool contains(const Plane& plane, const Eigen::Vector3d& p_world) noexcept {
  return plane.normal.dot(p_world) <= plane.offset_m;
}

bool contains(const Box& box, const Eigen::Vector3d& p_world) noexcept {
  const Eigen::Vector3d p_box = box.T_world_box.inverse(Eigen::Isometry) * p_world;
  return (p_box.cwiseAbs().array() <= box.half_size_m.array()).all();
}

bool contains(const Sphere& sphere, const Eigen::Vector3d& p_world) noexcept {
  return (p_world - sphere.centre_world).squaredNorm() <= sphere.radius_m * sphere.radius_m;
}

bool contains(const Capsule& capsule, const Eigen::Vector3d& p_world) noexcept {
  return contains(Sphere{nearest_on_axis(capsule, p_world), capsule.radius_m}, p_world);
}

Interval intersect(const Plane& plane, const Line& line) noexcept {
  const double slope = plane.normal.dot(line.direction);
  const double height_m = plane.normal.dot(line.origin) - plane.offset_m;
  if (slope == 0) {
    return height_m <= 0 ? Interval{-kInfinity, kInfinity} : Interval{};
  }
  const double t = -height_m / slope;
  return slope > 0 ? Interval{-kInfinity, t} : Interval{t, kInfinity};
}

Interval intersect(const Box& box, const Line& line) noexcept {
  const auto to_box = box.T_world_box.linear().transpose();
  const Eigen::Vector3d origin = to_box * (line.origin - box.T_world_box.translation());
  const Eigen::Vector3d direction = to_box * line.direction;
  Interval interval{-kInfinity, kInfinity};
  for (int axis = 0; axis < 3; ++axis) {
    interval = both(interval, slab(origin[axis], direction[axis], -box.half_size_m[axis], box.half_size_m[axis]));
  }
  return interval;
}

Interval intersect(const Sphere& sphere, const Line& line) noexcept {
  return ball(sphere.centre_world - line.origin, line.direction, sphere.radius_m);
}

Interval intersect(const Capsule& capsule, const Line& line) noexcept {
  const Eigen::Vector3d to_a = capsule.a - line.origin;
  const Eigen::Vector3d axis = capsule.b - capsule.a;
  const double length_m = axis.norm();
  Interval interval = ball(to_a, line.direction, capsule.radius_m);
  if (!(length_m > 0)) {
    return interval;
  }
  interval = hull(interval, ball(capsule.b - line.origin, line.direction, capsule.radius_m));

  // The cylinder between the two end planes: in the plane across the axis it is a disc.
  const Eigen::Vector3d unit_axis = axis / length_m;
  const double along = unit_axis.dot(line.direction);
  const double origin_along_m = -unit_axis.dot(to_a);
  const Eigen::Vector3d across = line.direction - along * unit_axis;
  const Eigen::Vector3d to_axis = to_a + origin_along_m * unit_axis;
  Interval cylinder;
  if (across.squaredNorm() > 1e-24 * line.direction.squaredNorm()) {
    cylinder = ball(to_axis, across, capsule.radius_m);
  } else if (to_axis.squaredNorm() <= capsule.radius_m * capsule.radius_m) {
    cylinder = {-kInfinity, kInfinity};  // along the axis
  }
  return hull(interval, both(cylinder, slab(origin_along_m, along, 0.0, length_m)));
}

Plane grown(const Plane& plane, double padding_m) noexcept { return {plane.normal, plane.offset_m + padding_m}; }
Box grown(const Box& box, double padding_m) noexcept {
  return {box.T_world_box, box.half_size_m + Eigen::Vector3d::Constant(padding_m)};
}
Sphere grown(const Sphere& sphere, double padding_m) noexcept {
  return {sphere.centre_world, sphere.radius_m + padding_m};
}
Capsule grown(const Capsule& capsule, double padding_m) noexcept {
  return {capsule.a, capsule.b, capsule.radius_m + padding_m};
}

Plane transformed(const Pose& T_A_world, const Plane& plane) noexcept {
  const Eigen::Vector3d normal = T_A_world.linear() * plane.normal;
  return {normal, plane.offset_m + normal.dot(T_A_world.translation())};
}
Box transformed(const Pose& T_A_world, const Box& box) noexcept {
  return {T_A_world * box.T_world_box, box.half_size_m};
}
Sphere transformed(const Pose& T_A_world, const Sphere& sphere) noexcept {
  return {T_A_world * sphere.centre_world, sphere.radius_m};
}
Capsule transformed(const Pose& T_A_world, const Capsule& capsule) noexcept {
  return {T_A_world * capsule.a, T_A_world * capsule.b, capsule.radius_m};
}

}  // namespace depthgrid::simulation
