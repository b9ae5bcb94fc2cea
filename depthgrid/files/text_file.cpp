#include "depthgrid/files/text_file.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/file_replacement.hpp"

namespace depthgrid::files {

std::string read_text_file(const std::filesystem::path& file) {
  const auto refuse = [&file](int system_error) {
    fail(file.string(), ": cannot be read: ", std::generic_category().message(system_error));
  };
  const auto close = [](std::FILE* stream) { static_cast<void>(std::fclose(stream)); };
  const std::unique_ptr<std::FILE, decltype(close)> stream(std::fopen(file.c_str(), "rb"), close);
  if (stream == nullptr) {
    refuse(errno);
  }
  std::string text;
  std::array<char, 65536> block{};
  for (std::size_t count = 1; count > 0;) {
    count = std::fread(block.data(), 1, block.size(), stream.get());
    text.append(block.data(), count);
  }
  if (std::ferror(stream.get()) != 0) {
    refuse(errno);  // a folder ends here
  }
  return text;
}

void write_text_file(const std::filesystem::path& file, std::string_view text) {
  FileReplacement target(file);
  static_cast<void>(std::fwrite(text.data(), 1, text.size(), target.stream()));  // commit() sees a failure
  target.commit();
}

}  // namespace depthgrid::files
