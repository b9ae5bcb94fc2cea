// The faces of one COLLADA geometry. Internal.
#pragma once

#include <pugixml.hpp>
#include <string>

#include "depthgrid/robot/mesh_formats.hpp"

namespace depthgrid::robot {

/// Corners of the triangles, strips, fans and polygons of a <geometry>, in its own frame and unit; lines are no faces.
/// Throws Error beginning with `context` where it is no <mesh> or breaks the format's rules.
[[nodiscard]] Corners geometry_corners(const pugi::xml_node& geometry, const std::string& context);

}  // namespace depthgrid::robot
