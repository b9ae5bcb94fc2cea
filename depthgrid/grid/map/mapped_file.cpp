#include "depthgrid/grid/map/mapped_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/file_replacement.hpp"

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
  ~Descriptor() {
    if (valid()) {
      ::close(value_);
    }
  }

  [[nodiscard]] int get() const noexcept { return value_; }
  [[nodiscard]] bool valid() const noexcept { return value_ >= 0; }

 private:
  int value_;
};

[[noreturn]] void fail_with_reason(const std::string& path, const char* what) {
  const int code = errno;
  fail("file '", path, "': cannot ", what, ": ", std::generic_category().message(code));
}

}  // namespace

std::shared_ptr<const MappedFile> MappedFile::open(const std::string& path) {
  // Opening a pipe would wait for its writer.
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the system's own interface
  const Descriptor descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
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
  FileReplacement target(path);
  for (const std::span<const std::byte> part : parts) {
    if (std::fwrite(part.data(), 1, part.size(), target.stream()) != part.size()) {
      fail_with_reason(path, "write");
    }
  }
  if (std::fflush(target.stream()) != 0 || ::fsync(::fileno(target.stream())) != 0) {
    fail_with_reason(path, "write");
  }
  target.commit();
}

}  // namespace depthgrid::grid
