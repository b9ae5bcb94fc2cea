// A whole text file as a string, read and written. Internal.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace depthgrid::files {

/// Throws Error that names the file and the system's reason when it is absent, a folder or cannot be read.
std::string read_text_file(const std::filesystem::path& file);

/// The file is written whole or not at all. Throws Error that names it and the system's reason.
void write_text_file(const std::filesystem::path& file, std::string_view text);

}  // namespace depthgrid::files
