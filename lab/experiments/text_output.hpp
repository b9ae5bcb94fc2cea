// Text files that appear when they are complete.
#pragma once

#include <filesystem>
#include <string>

namespace depthgrid::experiments {

/// The file is written whole or not at all. Throws Error that names it.
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace depthgrid::experiments
