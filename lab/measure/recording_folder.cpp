#include "lab/measure/recording_folder.hpp"

#include <cstdlib>

namespace depthgrid::lab {

std::filesystem::path recording_folder(const std::string& name) {
  const char* data = std::getenv("DEPTHGRID_DATA");  // NOLINT(concurrency-mt-unsafe): nobody changes the environment
  return std::filesystem::path(data != nullptr && *data != '\0' ? data : "../shared/data") / name;
}

}  // namespace depthgrid::lab
