#include "depthgrid/core/file_replacement.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
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

/// A file under way. Its place never moves and is never freed, so that a signal handler may look at any time.
struct Unfinished {
  enum State : int { kFree, kClaimed, kInUse };
  std::atomic<int> state{kFree};
  std::array<char, PATH_MAX> path{};
};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler reads it");

/// More files at once are written all the same; only a signal would leave them behind.
constexpr std::size_t kMostUnfinished = 16;
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): a signal handler gets nothing handed over
std::array<Unfinished, kMostUnfinished> unfinished;

/// kMostUnfinished: there is no room, or the path is too long for the system anyway.
std::size_t enter_unfinished(const std::string& path) noexcept {
  if (path.size() >= PATH_MAX) {
    return kMostUnfinished;
  }
  for (std::size_t entry = 0; entry < kMostUnfinished; ++entry) {
    int expected = Unfinished::kFree;
    if (unfinished[entry].state.compare_exchange_strong(expected, Unfinished::kClaimed)) {
      *std::copy(path.begin(), path.end(), unfinished[entry].path.begin()) = '\0';
      unfinished[entry].state.store(Unfinished::kInUse);
      return entry;
    }
  }
  return kMostUnfinished;
}

void leave_unfinished(std::size_t entry) noexcept {
  if (entry < kMostUnfinished) {
    unfinished[entry].state.store(Unfinished::kFree);
  }
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

void remove_unfinished_files() noexcept {
  for (const Unfinished& file : unfinished) {
    if (file.state.load() == Unfinished::kInUse) {
      static_cast<void>(::unlink(file.path.data()));
    }
  }
}

FileReplacement::FileReplacement(const std::filesystem::path& file) : file_(replaceable_file(file)), temporary_(file_) {
  temporary_ += temporary_suffix();
  entry_ = enter_unfinished(temporary_.string());  // before the file is there
  // NOLINTNEXTLINE(cppcoreguidelines-prefer-member-initializer): the name must be complete first
  stream_ = std::fopen(temporary_.c_str(), "wb");
  if (stream_ == nullptr) {
    const int reason = errno;
    leave_unfinished(entry_);
    fail_to_write(file_, reason);
  }
}

FileReplacement::~FileReplacement() {
  if (stream_ != nullptr) {
    static_cast<void>(std::fclose(stream_));
  }
  std::error_code ignored;  // after commit() there is nothing left to remove
  std::filesystem::remove(temporary_, ignored);
  leave_unfinished(entry_);
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
