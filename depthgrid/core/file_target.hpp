// Where a file that is written whole and then renamed may go.
#pragma once

#include <filesystem>

namespace depthgrid {

/// The file that writing to `path` replaces: the target of a symbolic link, else `path` itself. Throws Error when it
/// exists and is not a regular file, since renaming over a device, pipe or folder would destroy it.
std::filesystem::path replaceable_file(const std::filesystem::path& path);

}  // namespace depthgrid
