// The shapes of a link in a URDF file. Internal.
#pragma once

#include <filesystem>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "depthgrid/robot/robot_description.hpp"
#include "depthgrid/robot/urdf.hpp"

namespace depthgrid::robot {

/// The collision shapes of a <link>, or the visual ones where it has none. Shapes that are a point (a box of size
/// 0 0 0) are left out. `file` is where names of meshes begin.
[[nodiscard]] std::vector<LinkShape> shapes_of(const pugi::xml_node& link, const std::filesystem::path& file,
                                               const UrdfOptions& options, const std::string& context);

}  // namespace depthgrid::robot
