#include "depthgrid/simulation/triangle_mesh.hpp"

#include <cmath>
#include <numbers>

#include "depthgrid/core/error.hpp"

namespace depthgrid::simulation {

namespace {

/// Rings of vertices from the pole at `b` to the one at `a`; the same polar angle may stand at both ends of a capsule.
TriangleMesh round_mesh(const Capsule& capsule, int segments, bool two_ends) {
  if (segments < 3) {
    fail("mesh of a round solid: ", segments, " segments around its axis, must be at least 3");
  }
  const Eigen::Vector3d ab = capsule.b - capsule.a;
  const Eigen::Vector3d axis = two_ends ? Eigen::Vector3d(ab.normalized()) : Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d x = axis.unitOrthogonal();
  const Eigen::Vector3d y = axis.cross(x);
  const int half_rings = (segments + 3) / 4;  // from a pole to the equator
  TriangleMesh mesh;
  const auto ring = [&](const Eigen::Vector3d& centre, double polar_rad) {
    for (int k = 0; k < segments; ++k) {
      const double around_rad = 2 * std::numbers::pi * k / segments;
      const Eigen::Vector3d normal =
          std::sin(polar_rad) * (std::cos(around_rad) * x + std::sin(around_rad) * y) + std::cos(polar_rad) * axis;
      mesh.vertices_m.emplace_back((centre + capsule.radius_m * normal).cast<float>());
    }
  };
  int rings = 0;
  for (int i = 1; i <= half_rings; ++i, ++rings) {
    ring(capsule.b, 0.5 * std::numbers::pi * i / half_rings);
  }
  for (int i = two_ends ? 0 : 1; i < half_rings; ++i, ++rings) {
    ring(capsule.a, 0.5 * std::numbers::pi * (1 + static_cast<double>(i) / half_rings));
  }
  const int top = rings * segments;
  const int bottom = top + 1;
  mesh.vertices_m.emplace_back((capsule.b + capsule.radius_m * axis).cast<float>());
  mesh.vertices_m.emplace_back((capsule.a - capsule.radius_m * axis).cast<float>());
  for (int k = 0; k < segments; ++k) {
    const int next = (k + 1) % segments;
    mesh.triangles.emplace_back(top, k, next);
    for (int i = 0; i + 1 < rings; ++i) {
      const int upper = i * segments;
      const int lower = upper + segments;
      mesh.triangles.emplace_back(upper + k, lower + k, upper + next);
      mesh.triangles.emplace_back(upper + next, lower + k, lower + next);
    }
    mesh.triangles.emplace_back((rings - 1) * segments + k, bottom, (rings - 1) * segments + next);
  }
  return mesh;
}

}  // namespace

void validate(const TriangleMesh& mesh, const char* name) {
  if (mesh.triangles.empty()) {
    fail(name, ": has no triangle");
  }
  for (std::size_t i = 0; i < mesh.vertices_m.size(); ++i) {
    if (!mesh.vertices_m[i].allFinite()) {
      fail(name, ": vertex ", i, " is not finite");
    }
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Eigen::Vector3i& corners = mesh.triangles[i];
    if (corners.minCoeff() < 0 || static_cast<std::size_t>(corners.maxCoeff()) >= mesh.vertices_m.size()) {
      fail(name, ": triangle ", i, " has corners ", corners.transpose(), ", must be indices of ",
           mesh.vertices_m.size(), " vertices");
    }
  }
}

TriangleMesh mesh_of(const Box& box) {
  validate(box);
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d sign((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1, (corner & 4) != 0 ? 1 : -1);
    mesh.vertices_m.emplace_back((box.T_world_box * sign.cwiseProduct(box.half_size_m)).cast<float>());
  }
  // Two opposite faces an axis; the other two axes span a face.
  for (int axis = 0; axis < 3; ++axis) {
    const int normal = 1 << axis;
    const int first = 1 << ((axis + 1) % 3);
    const int second = 1 << ((axis + 2) % 3);
    for (const int side : {0, normal}) {
      mesh.triangles.emplace_back(side, side + first, side + second);
      mesh.triangles.emplace_back(side + first, side + first + second, side + second);
    }
  }
  return mesh;
}

TriangleMesh mesh_of(const Sphere& sphere, int segments) {
  validate(sphere);
  return round_mesh({sphere.centre_world, sphere.centre_world, sphere.radius_m}, segments, false);
}

TriangleMesh mesh_of(const Capsule& capsule, int segments) {
  validate(capsule);
  return round_mesh(capsule, segments, (capsule.b - capsule.a).norm() > 0);
}

double inscribed_depth_m(double radius_m, int segments) noexcept {
  // A facet spans 2 pi / segments around the axis and no more from pole to pole; its middle is lowest in both.
  const double half_rad = std::numbers::pi / segments;
  return radius_m * (1 - std::cos(half_rad) * std::cos(half_rad));
}

}  // namespace depthgrid::simulation
