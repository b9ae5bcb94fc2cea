#include "depthgrid/core/file_target.hpp"

#include <system_error>

#include "depthgrid/core/error.hpp"

namespace depthgrid {

std::filesystem::path replaceable_file(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    fail(path.string(), ": exists and is not a regular file, will not be replaced");
  }
  if (std::filesystem::is_symlink(path, error) && std::filesystem::exists(status)) {
    return std::filesystem::canonical(path, error);
  }
  return path;
}

}  // namespace depthgrid
