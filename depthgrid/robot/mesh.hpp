// The corners of a surface in a file.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

namespace depthgrid::robot {

/// Corners of all faces of an STL, OBJ or COLLADA file (by its ending), in the file's units and axes; COLLADA: its unit
/// counts, its up-axis does not, as robot tools read it. Three after the other are a triangle. Throws Error naming the
/// file when it cannot be read, is of another format, breaks the rules of its own, has no face, or its faces no area,
/// or when a corner is not finite.
[[nodiscard]] std::vector<Eigen::Vector3d> mesh_points(const std::filesystem::path& file);

/// Whether the triangles have an area that is more than rounding.
[[nodiscard]] bool has_area(const std::vector<Eigen::Vector3d>& corners) noexcept;

}  // namespace depthgrid::robot
