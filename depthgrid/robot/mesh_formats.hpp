// The formats of meshes, one reader each. Internal.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace depthgrid::robot {

/// Corners of triangles, three after the other; in a face of one or two corners they repeat.
using Corners = std::vector<Eigen::Vector3d>;

/// Each reads all of a text and throws Error, beginning with `context`, where it does not keep to its format; corners
/// may still be none or not finite.
[[nodiscard]] Corners stl_corners(std::string_view bytes, const std::string& context);
[[nodiscard]] Corners obj_corners(std::string_view text, const std::string& context);
[[nodiscard]] Corners collada_corners(std::string_view text, const std::string& context);

/// The same by a file's ending, and checked as mesh_points() promises.
[[nodiscard]] Corners mesh_corners(std::string_view bytes, std::string_view ending, const std::string& context);

/// Throws where a mesh has become larger than a program can hold: instances in instances, mostly.
void check_size(std::size_t corners, const std::string& context);

/// Adds a convex polygon, or one that is at least within the hull of its corners, which is all that capsules need.
void add_polygon(const Corners& polygon, Corners& corners);

}  // namespace depthgrid::robot
