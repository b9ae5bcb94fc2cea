// The bytes of a file that may not be larger than is sensible. Not part of the installed headers. Internal.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace depthgrid {

/// Closes a stream that fopen() or fdopen() gave.
struct CloseStream {
  void operator()(std::FILE* stream) const noexcept { static_cast<void>(std::fclose(stream)); }
};
using InputStream = std::unique_ptr<std::FILE, CloseStream>;

/// Opens a regular file for reading; nothing is waited for, and nothing else is touched. Throws Error that names the
/// file and the reason: absent, no permission, a folder, a pipe, a device.
[[nodiscard]] InputStream open_regular_file(const std::filesystem::path& file);

/// All of a regular file. Throws Error as open_regular_file(), where it has more than `max_bytes` (before it is read,
/// and where it grows meanwhile), and where it cannot be read.
[[nodiscard]] std::string read_whole_file(const std::filesystem::path& file, std::uint64_t max_bytes);

}  // namespace depthgrid
