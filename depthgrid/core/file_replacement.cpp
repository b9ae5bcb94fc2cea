#include "depthgrid/core/file_replacement.hpp"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/file_target.hpp"

namespace depthgrid {
namespace {

/// Distinct for every file of this process and, by its id, between processes that write into one folder.
std::string temporary_suffix() {
  static std::atomic<unsigned> counter{0};
  return ".tmp-" + std::to_string(::getpid()) + "-" + std::to_string(counter.fetch_add(1));
}

[[noreturn]] void fail_to_write(const std::filesystem::path& file, int system_error) {
  fail(file.string(), ": cannot be written: ", std::generic_category().message(system_error));
}

}  // namespace

FileReplacement::FileReplacement(const std::filesystem::path& file) : file_(replaceable_file(file)), temporary_(file_) {
  temporary_ += temporary_suffix();
  // NOLINTNEXTLINE(cppcoreguidelines-prefer-member-initializer): the name must be complete first
  stream_ = std::fopen(temporary_.c_str(), "wb");
  if (stream_ == nullptr) {
    fail_to_write(file_, errno);
  }
}

FileReplacement::~FileReplacement() {
  if (stream_ != nullptr) {
    static_cast<void>(std::fclose(stream_));
  }
  std::error_code ignored;  // after commit() there is nothing left to remove
  std::filesystem::remove(temporary_, ignored);
}

void FileReplacement::commit() {
  const bool written = std::ferror(stream_) == 0;
  const bool closed = std::fclose(std::exchange(stream_, nullptr)) == 0;
  if (!written || !closed) {
    fail_to_write(file_, errno != 0 ? errno : EIO);
  }
  std::error_code error;
  std::filesystem::rename(temporary_, file_, error);
  if (error) {
    fail_to_write(file_, error.value());
  }
}

}  // namespace depthgrid
