// The corners of a surface in a file.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

namespace depthgrid::robot {

/// Corners of all faces of an STL, OBJ, COLLADA or other file that assimp reads, in the file's units and axes (COLLADA:
/// its unit counts, its up-axis does not, as robot tools read it). Throws Error naming the file when it cannot be read,
/// has no corner, or one is not finite.
[[nodiscard]] std::vector<Eigen::Vector3d> mesh_points(const std::filesystem::path& file);

}  // namespace depthgrid::robot
