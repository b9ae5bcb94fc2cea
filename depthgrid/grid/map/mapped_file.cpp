#include "depthgrid/grid/map/mapped_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/file_target.hpp"

namespace depthgrid::grid {
namespace {

// A file descriptor that is closed whatever happens.
class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor(Descriptor&&) = delete;
  Descriptor& operator=(Descriptor&&) = delete;
  ~Descriptor() { close(); }

  [[nodiscard]] int get() const noexcept { return value_; }
  [[nodiscard]] bool valid() const noexcept { return value_ >= 0; }
  bool close() noexcept {
    const int value = std::exchange(value_, -1);
    return value < 0 || ::close(value) == 0;
  }

 private:
  int value_;
};

[[noreturn]] void fail_with_reason(const std::string& path, const char* what) {
  const int code = errno;
  fail("file '", path, "': cannot ", what, ": ", std::generic_category().message(code));
}

bool write_all(int descriptor, std::span<const std::byte> bytes) noexcept {
  constexpr std::size_t kOnce = std::size_t{1} << 30U;
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), std::min(bytes.size(), kOnce));
    if (written < 0 && errno == EINTR) {
      continue;
    }
    if (written <= 0) {
      return false;
    }
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

std::shared_ptr<const MappedFile> MappedFile::open(const std::string& path) {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the system's own interface
  const Descriptor descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  struct stat status {};
  if (!descriptor.valid() || ::fstat(descriptor.get(), &status) != 0) {
    fail_with_reason(path, "open");
  }
  if (!S_ISREG(status.st_mode)) {
    fail("file '", path, "': is not a regular file");
  }
  if (status.st_size == 0) {
    fail("file '", path, "': is empty");
  }
  const auto size = static_cast<std::size_t>(status.st_size);
  void* memory = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor.get(), 0);
  if (memory == MAP_FAILED) {
    fail_with_reason(path, "map");
  }
  return std::shared_ptr<const MappedFile>(new MappedFile({static_cast<const std::byte*>(memory), size}));
}

MappedFile::~MappedFile() {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): munmap takes what mmap gave
  ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

void write_file_whole(const std::string& path, std::span<const std::span<const std::byte>> parts) {
  const std::string target = replaceable_file(path).string();
  static std::atomic<unsigned> serial{0};
  const std::string temporary = target + ".part-" + std::to_string(::getpid()) + "-" + std::to_string(serial++);
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the system's own interface
  Descriptor descriptor(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (!descriptor.valid()) {
    fail_with_reason(path, "write");
  }
  const bool written = std::all_of(parts.begin(), parts.end(),
                                   [&](std::span<const std::byte> part) { return write_all(descriptor.get(), part); });
  if (!written || ::fsync(descriptor.get()) != 0 || !descriptor.close() ||
      std::rename(temporary.c_str(), target.c_str()) != 0) {
    const int code = errno;
    ::unlink(temporary.c_str());
    errno = code;
    fail_with_reason(path, "write");
  }
}

}  // namespace depthgrid::grid
