// The shapes of a link in a URDF file. Internal.
#pragma once

#include <filesystem>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "depthgrid/robot/robot_description.hpp"
#include "depthgrid/robot/urdf.hpp"

namespace depthgrid::robot {

/// Gives a link the shapes of its <link> that are of the kind wanted, or those of the other kind where it has none.
/// Shapes that are a point (a box of size 0 0 0) are left out. `file` is where names of meshes begin.
void add_shapes(const pugi::xml_node& link, const std::filesystem::path& file, const UrdfOptions& options,
                const std::string& context, LinkDescription& result);

}  // namespace depthgrid::robot
