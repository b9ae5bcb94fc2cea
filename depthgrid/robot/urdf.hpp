// Robots from URDF files.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "depthgrid/robot/robot_description.hpp"

namespace depthgrid::robot {

struct UrdfOptions {
  /// Where package://NAME/... is. A name that is not listed is looked for among the folders that hold the URDF file.
  std::map<std::string, std::filesystem::path> packages;
  /// Whether files of meshes must exist.
  bool require_meshes = true;
};

/// Reads a URDF file. Shapes are the collision shapes of each link, and the visual ones of links that have none. Joints
/// are fixed, revolute, continuous or prismatic. Names of meshes may be package://, file:// or relative to the file.
/// Throws Error, naming the file, when it cannot be read, is no URDF, holds a number that is none, or names a link, a
/// package or a mesh that is not there. RobotModel checks the tree. Prints nothing; may be called from many threads.
[[nodiscard]] RobotDescription load_urdf(const std::filesystem::path& file, const UrdfOptions& options = {});

/// The same from text. `source` stands for the file in messages, and relative names begin in its folder.
[[nodiscard]] RobotDescription parse_urdf(const std::string& text, const std::filesystem::path& source,
                                          const UrdfOptions& options = {});

}  // namespace depthgrid::robot
