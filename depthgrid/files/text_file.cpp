#include "depthgrid/files/text_file.hpp"

#include <cstdio>

#include "depthgrid/core/file_replacement.hpp"
#include "depthgrid/core/whole_file.hpp"

namespace depthgrid::files {

std::string read_text_file(const std::filesystem::path& file, std::uint64_t max_bytes) {
  return read_whole_file(file, max_bytes);
}

void write_text_file(const std::filesystem::path& file, std::string_view text) {
  FileReplacement target(file);
  static_cast<void>(std::fwrite(text.data(), 1, text.size(), target.stream()));  // commit() sees a failure
  target.commit();
}

}  // namespace depthgrid::files
