#include "depthgrid/core/whole_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <system_error>

#include "depthgrid/core/error.hpp"

namespace depthgrid {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, int system_error) {
  fail(file.string(), ": cannot be read: ", std::generic_category().message(system_error));
}

const char* kind_of(mode_t mode) noexcept {
  return S_ISFIFO(mode)   ? "a pipe"
         : S_ISSOCK(mode) ? "a socket"
         : S_ISCHR(mode)  ? "a device"
         : S_ISBLK(mode)  ? "a device"
                          : "not a regular file";
}

}  // namespace

InputStream open_regular_file(const std::filesystem::path& file) {
  // Opening a pipe would wait for its writer.
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the system's own interface
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0) {
    refuse(file, errno == ENXIO ? ENODEV : errno);
  }
  InputStream stream(::fdopen(descriptor, "rb"));
  if (stream == nullptr) {
    const int reason = errno;
    ::close(descriptor);
    refuse(file, reason);
  }
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) {
    refuse(file, errno);
  }
  if (S_ISDIR(status.st_mode)) {
    refuse(file, EISDIR);
  }
  if (!S_ISREG(status.st_mode)) {
    fail(file.string(), ": is ", kind_of(status.st_mode), ", must be a regular file; copy what it gives into one");
  }
  return stream;
}

std::string read_whole_file(const std::filesystem::path& file, std::uint64_t max_bytes) {
  const InputStream stream = open_regular_file(file);
  const auto refuse_size = [&](std::uint64_t bytes) {
    fail(file.string(), ": has ", bytes, " bytes, must have at most ", max_bytes);
  };
  struct stat status {};
  if (::fstat(::fileno(stream.get()), &status) == 0 && static_cast<std::uint64_t>(status.st_size) > max_bytes) {
    refuse_size(static_cast<std::uint64_t>(status.st_size));
  }
  std::string bytes;
  std::array<char, 65536> block{};
  for (std::size_t count = 1; count > 0;) {  // files of /proc and /sys have no size
    count = std::fread(block.data(), 1, block.size(), stream.get());
    bytes.append(block.data(), count);
    if (bytes.size() > max_bytes) {
      refuse_size(bytes.size());
    }
  }
  if (std::ferror(stream.get()) != 0) {
    refuse(file, errno);
  }
  return bytes;
}

}  // namespace depthgrid
