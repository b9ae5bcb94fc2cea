#include "lab/experiments/text_output.hpp"

#include <cerrno>
#include <cstdio>
#include <system_error>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/file_replacement.hpp"

namespace depthgrid::experiments {

void write_text(const std::filesystem::path& file, const std::string& text) {
  FileReplacement replacement(file);
  if (std::fwrite(text.data(), 1, text.size(), replacement.stream()) != text.size()) {
    fail("cannot write ", file.string(), ": ", std::generic_category().message(errno));
  }
  replacement.commit();
}

}  // namespace depthgrid::experiments
