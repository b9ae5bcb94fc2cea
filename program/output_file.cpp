#include "program/output_file.hpp"

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "program/output_check.hpp"

namespace depthgrid::program {

namespace fs = std::filesystem;

OutputFile::OutputFile(std::string path) : path_(std::move(path)) {
  if (path_ == "-") {
    return;
  }
  check_output_file(path_);
  replacement_.emplace(path_);
  stream_ = replacement_->stream();
}

void OutputFile::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stream_) != text.size()) {
    fail("cannot write ", replacement_ ? path_ : "standard output", ": ", std::generic_category().message(errno));
  }
}

void OutputFile::commit() {
  if (replacement_) {
    replacement_->commit();
  } else if (std::fflush(stream_) != 0) {
    fail("cannot write standard output: ", std::generic_category().message(errno));
  }
}

void make_output_directory(const std::string& directory) {
  if (fs::is_directory(directory)) {
    return;
  }
  if (fs::exists(directory)) {
    fail("cannot create the folder ", directory, ": a file of that name is in the way");
  }
  auto path = fs::path(directory).lexically_normal();
  path = path.has_filename() ? path : path.parent_path();
  if (path.has_parent_path() && !fs::is_directory(path.parent_path())) {
    fail("cannot create the folder ", directory, ": there is no folder ", path.parent_path().string(),
         "; create it first");
  }
  std::error_code error;
  if (!fs::create_directory(directory, error) || error) {
    fail("cannot create the folder ", directory, ": ", error.message());
  }
}

}  // namespace depthgrid::program
