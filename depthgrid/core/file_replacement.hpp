// A file that appears under its name only when it is complete. Not part of the installed headers. Internal.
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>

namespace depthgrid {

/// The file that writing to `path` replaces: the target of a symbolic link, else `path` itself. Throws Error when it
/// exists and is not a regular file, since renaming over a device, pipe or folder would destroy it.
std::filesystem::path replaceable_file(const std::filesystem::path& path);

/// Removes the temporary files of all FileReplacements under way. For a signal handler, after which the process ends:
/// it is async-signal-safe, and the FileReplacements themselves are of no use any more.
void remove_unfinished_files() noexcept;

/// Writes to a temporary name in the same folder; commit() renames it, the destructor removes it if it never came to
/// that. So that a full disk or an error half-way leaves what was there before.
class FileReplacement {
 public:
  /// Opens the temporary file. Throws Error naming `file` and the system's reason.
  explicit FileReplacement(const std::filesystem::path& file);
  ~FileReplacement();
  FileReplacement(const FileReplacement&) = delete;
  FileReplacement& operator=(const FileReplacement&) = delete;

  [[nodiscard]] std::FILE* stream() const noexcept { return stream_; }

  /// Closes and renames. Throws Error when anything since the start could not be written.
  void commit();

 private:
  std::filesystem::path file_;
  std::filesystem::path temporary_;
  std::FILE* stream_ = nullptr;
  std::size_t entry_ = 0;  ///< in the table of unfinished files
};

}  // namespace depthgrid
