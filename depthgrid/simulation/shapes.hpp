// The solids of a scene. All are convex, so a line meets each in one interval. World frame, metres.
#pragma once

#include <Eigen/Core>
#include <limits>

#include "depthgrid/core/capsule.hpp"
#include "depthgrid/core/pose.hpp"

namespace depthgrid::simulation {

/// Half space { x : normal . x <= offset_m } is solid.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit
  double offset_m = 0;
};
struct Box {
  Pose T_world_box = Pose::Identity();  ///< centre and axes
  Eigen::Vector3d half_size_m = Eigen::Vector3d::Constant(0.5);
};
struct Sphere {
  Eigen::Vector3d centre_world = Eigen::Vector3d::Zero();
  double radius_m = 0.1;
};

/// Throws Error with value and rule: numbers must be finite, sizes positive, normals of unit length and rotations
/// orthonormal (both to 1e-9).
void validate(const Plane& plane);
void validate(const Box& box);
void validate(const Sphere& sphere);
void validate(const Capsule& capsule);

/// The point of the solid nearest to p_world: p_world itself when it lies inside.
[[nodiscard]] Eigen::Vector3d nearest_point(const Plane& plane, const Eigen::Vector3d& p_world) noexcept;
[[nodiscard]] Eigen::Vector3d nearest_point(const Box& box, const Eigen::Vector3d& p_world) noexcept;
[[nodiscard]] Eigen::Vector3d nearest_point(const Sphere& sphere, const Eigen::Vector3d& p_world) noexcept;
[[nodiscard]] Eigen::Vector3d nearest_point(const Capsule& capsule, const Eigen::Vector3d& p_world) noexcept;

/// Whether p_world lies in the closed solid. Decided by the solid's own inequality, not by nearest_point().
[[nodiscard]] bool contains(const Plane& plane, const Eigen::Vector3d& p_world) noexcept;
[[nodiscard]] bool contains(const Box& box, const Eigen::Vector3d& p_world) noexcept;
[[nodiscard]] bool contains(const Sphere& sphere, const Eigen::Vector3d& p_world) noexcept;
[[nodiscard]] bool contains(const Capsule& capsule, const Eigen::Vector3d& p_world) noexcept;

/// Parameters t with origin + t direction inside a solid; empty when exit < entry. Both ends may be infinite.
struct Interval {
  double entry = std::numeric_limits<double>::infinity();
  double exit = -std::numeric_limits<double>::infinity();

  [[nodiscard]] bool empty() const noexcept { return !(entry <= exit); }
};

/// An infinite line; the direction is not zero and need not be a unit vector.
struct Line {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
};

[[nodiscard]] Interval intersect(const Plane& plane, const Line& line) noexcept;
[[nodiscard]] Interval intersect(const Box& box, const Line& line) noexcept;
[[nodiscard]] Interval intersect(const Sphere& sphere, const Line& line) noexcept;
[[nodiscard]] Interval intersect(const Capsule& capsule, const Line& line) noexcept;

/// The solid with its surface moved outward by padding_m >= 0 (a box keeps its sharp edges, so it grows by more there).
[[nodiscard]] Plane grown(const Plane& plane, double padding_m) noexcept;
[[nodiscard]] Box grown(const Box& box, double padding_m) noexcept;
[[nodiscard]] Sphere grown(const Sphere& sphere, double padding_m) noexcept;
[[nodiscard]] Capsule grown(const Capsule& capsule, double padding_m) noexcept;

/// The same solid in another frame: T_A_world maps world to frame A.
[[nodiscard]] Plane transformed(const Pose& T_A_world, const Plane& plane) noexcept;
[[nodiscard]] Box transformed(const Pose& T_A_world, const Box& box) noexcept;
[[nodiscard]] Sphere transformed(const Pose& T_A_world, const Sphere& sphere) noexcept;
[[nodiscard]] Capsule transformed(const Pose& T_A_world, const Capsule& capsule) noexcept;

}  // namespace depthgrid::simulation
