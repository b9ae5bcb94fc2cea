// A file as read-only memory.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>

namespace depthgrid::grid {

/// Maps a whole file into memory; unmapped with the last copy of the pointer. The file must not be shortened or
/// overwritten in place meanwhile: the system ends a process that reads beyond the end. Replacing it by rename, as
/// save_map() does, is fine.
class MappedFile {
 public:
  /// Throws Error with the system's reason when the file cannot be read, is no regular file, or is empty.
  static std::shared_ptr<const MappedFile> open(const std::string& path);

  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  MappedFile(MappedFile&&) = delete;
  MappedFile& operator=(MappedFile&&) = delete;
  ~MappedFile();

  [[nodiscard]] std::span<const std::byte> bytes() const noexcept { return bytes_; }

 private:
  explicit MappedFile(std::span<const std::byte> bytes) : bytes_(bytes) {}
  std::span<const std::byte> bytes_;
};

/// Writes the parts one after the other into a temporary file beside `path`, flushes it to the disk and renames it to
/// `path`: a reader sees the old file or the whole new one. Throws Error with the system's reason; nothing is left
/// over.
void write_file_whole(const std::string& path, std::span<const std::span<const std::byte>> parts);

}  // namespace depthgrid::grid
