// Where the mesh is that a URDF file names. Internal.
#pragma once

#include <filesystem>
#include <string>

#include "depthgrid/robot/urdf.hpp"

namespace depthgrid::robot {

/// The file that `name` (package://, file:// or relative to the folder of `urdf`) stands for. Throws Error, beginning
/// with `context`, when the package is unknown or the file is not there; where neither is required the file in an
/// unknown package is `name` as it is.
[[nodiscard]] std::filesystem::path mesh_path(const std::string& name, const std::filesystem::path& urdf,
                                              const UrdfOptions& options, const std::string& context);

}  // namespace depthgrid::robot
