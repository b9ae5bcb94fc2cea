// Files of robots, whole and not larger than they may be. Internal.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace depthgrid::robot {

/// All bytes of a file. Throws Error naming it when it is not there, is no regular file, cannot be read, has more than
/// `max_bytes`, or is a Git LFS pointer instead of what it points to.
[[nodiscard]] std::string read_robot_file(const std::filesystem::path& file, std::size_t max_bytes);

}  // namespace depthgrid::robot
