// A static kitchen seen by four cameras: figures only, because the recording's licence allows no published picture.
#pragma once

#include <string>

namespace depthgrid::lab {

/// Runs the first of the four-camera rigs that redkitchen_poses suggests and gives its tables as Markdown. Throws
/// Error.
[[nodiscard]] std::string kitchen_tables();

}  // namespace depthgrid::lab
