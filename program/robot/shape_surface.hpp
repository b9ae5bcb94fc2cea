// The surface of a robot's shapes as triangles, and how much space they fill.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "depthgrid/core/capsule.hpp"
#include "depthgrid/robot/robot_description.hpp"

namespace depthgrid::program {

/// Corners of triangles, three after the other, metres, in the link's frame. A mesh is read from its file; round solids
/// are made of flat faces whose corners lie on them. Throws Error where the mesh cannot be read.
[[nodiscard]] std::vector<Eigen::Vector3d> surface_triangles(const robot::LinkShape& shape);

/// What the shape fills, m^3, exactly. Of a mesh by its triangles; nothing where they do not close: an edge of one has
/// no other that runs along it the other way.
[[nodiscard]] std::optional<double> shape_volume_m3(const robot::LinkShape& shape,
                                                    std::span<const Eigen::Vector3d> triangles);

[[nodiscard]] double capsule_volume_m3(const Capsule& capsule) noexcept;

/// "mesh link_0.stl", "box", ...
[[nodiscard]] std::string shape_text(const robot::LinkShape& shape);

}  // namespace depthgrid::program
