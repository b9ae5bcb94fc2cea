// Triangle meshes of rigid bodies, and meshes of the round solids for where only triangles are taken.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "depthgrid/simulation/shapes.hpp"

namespace depthgrid::simulation {

/// A surface; metres, in the frame of its body. Each triangle is three indices of vertices, in either sense.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices_m;
  std::vector<Eigen::Vector3i> triangles;
};

/// Throws Error with value and rule unless there is a triangle, every vertex is finite and every index is that of a
/// vertex.
void validate(const TriangleMesh& mesh, const char* name = "mesh");

/// The twelve triangles of a box.
[[nodiscard]] TriangleMesh mesh_of(const Box& box);

/// Vertices on the surface, `segments` (at least 3) around the axis and half as many from pole to pole: the mesh lies
/// inside the solid, nowhere deeper than inscribed_depth_m(). Throws Error for fewer segments.
[[nodiscard]] TriangleMesh mesh_of(const Sphere& sphere, int segments);
[[nodiscard]] TriangleMesh mesh_of(const Capsule& capsule, int segments);

/// How far such a mesh lies below the surface at most, metres.
[[nodiscard]] double inscribed_depth_m(double radius_m, int segments) noexcept;

}  // namespace depthgrid::simulation
