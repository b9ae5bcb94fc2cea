// A whole text file as a string, read and written. Internal.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace depthgrid::files {

/// Text that people write is smaller; lists of points and of images, too.
inline constexpr std::uint64_t kLargestText = std::uint64_t{64} << 20U;

/// Throws Error that names the file and the reason when it is absent, no regular file (a folder, pipe or device), has
/// more than `max_bytes`, or cannot be read.
std::string read_text_file(const std::filesystem::path& file, std::uint64_t max_bytes = kLargestText);

/// The file is written whole or not at all. Throws Error that names it and the system's reason.
void write_text_file(const std::filesystem::path& file, std::string_view text);

}  // namespace depthgrid::files
