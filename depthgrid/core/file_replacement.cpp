#include "depthgrid/core/file_replacement.hpp"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "depthgrid/core/error.hpp"

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

std::filesystem::path replaceable_file(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    fail(path.string(), ": exists and is not a regular file, will not be replaced");
  }
  if (std::filesystem::is_symlink(path, error) && std::filesystem::exists(status)) {
    return std::filesystem::canonical(path, error);
  }
  return path;
}

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
