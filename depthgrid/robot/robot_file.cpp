#include "depthgrid/robot/robot_file.hpp"

#include <fstream>
#include <system_error>

#include "depthgrid/core/error.hpp"

namespace depthgrid::robot {

std::string read_robot_file(const std::filesystem::path& file, std::size_t max_bytes) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {  // a pipe or a device may never end
    fail(file.string(), ": there is no such file, or it is a folder, pipe or device");
  }
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error || size > max_bytes) {
    fail(file.string(), ": has ", size, " bytes, must have at most ", max_bytes);
  }
  std::string bytes(static_cast<std::size_t>(size), '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(bytes.data(), static_cast<std::streamsize>(size))) {
    fail(file.string(), ": cannot be opened or read to its end");
  }
  if (bytes.starts_with("version https://git-lfs.github.com/spec/")) {
    fail(file.string(), ": is a Git LFS pointer, not the file itself: run `git lfs pull` in its repository");
  }
  return bytes;
}

}  // namespace depthgrid::robot
