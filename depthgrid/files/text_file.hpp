// A whole text file as a string. Not part of the installed headers.
#pragma once

#include <filesystem>
#include <string>

namespace depthgrid::files {

/// Throws Error that names the file and the system's reason when it is absent, a folder or cannot be read.
std::string read_text_file(const std::filesystem::path& file);

}  // namespace depthgrid::files
