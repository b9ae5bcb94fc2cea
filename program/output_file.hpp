// Results go to a file that appears only when it is complete.
#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

#include "depthgrid/core/file_replacement.hpp"

namespace depthgrid::program {

/// Text output to a file or, for "-", to standard output. A file is written beside its final name and renamed by
/// commit(); without commit() (an error on the way) nothing is left behind.
class OutputFile {
 public:
  /// Throws Error when the folder does not exist or cannot be written.
  explicit OutputFile(std::string path);

  /// Throws Error when the disk is full or the reader of standard output is gone.
  void write(std::string_view text);
  /// Everything is written: give the file its name. Throws Error as write().
  void commit();

 private:
  std::string path_;
  std::optional<FileReplacement> replacement_;  ///< none: standard output
  std::FILE* stream_ = stdout;
};

/// Creates `directory` unless it exists. Throws Error when its parent is missing or it is not a folder.
void make_output_directory(const std::string& directory);

}  // namespace depthgrid::program
