// Where recorded data lies.
#pragma once

#include <filesystem>
#include <string>

namespace depthgrid::lab {

/// That folder below DEPTHGRID_DATA, or below ../shared/data when that is not set. It need not exist.
[[nodiscard]] std::filesystem::path recording_folder(const std::string& name);

}  // namespace depthgrid::lab
