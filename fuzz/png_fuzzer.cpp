// libFuzzer target: any bytes as a depth image, with the checksums of its chunks made right, so that the fuzzer gets
// past them. Either they are refused with an Error of one line that prints, or they give an image of the size that the
// header says.
#include <sys/mman.h>
#include <unistd.h>
#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/files/png.hpp"

namespace {

void require(bool condition) {
  if (!condition) {
    std::abort();
  }
}

std::uint32_t big_endian(const char* bytes) {
  std::uint32_t value = 0;
  for (int k = 0; k < 4; ++k) {
    value = (value << 8U) | static_cast<unsigned char>(bytes[k]);
  }
  return value;
}

void fit_checksums(std::string& png) {
  for (std::size_t chunk = 8; chunk + 12 <= png.size();) {
    const std::size_t length = big_endian(png.data() + chunk);
    if (length > png.size() - chunk - 12) {
      return;
    }
    const auto crc =
        static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(png.data() + chunk + 4), length + 4));
    for (std::size_t k = 0; k < 4; ++k) {
      png[chunk + 8 + length + k] = static_cast<char>(crc >> (24 - 8 * k));
    }
    chunk += 12 + length;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const int kFile = ::memfd_create("fuzz.png", 0);
  static const std::string kPath = "/proc/self/fd/" + std::to_string(kFile);
  std::string png(reinterpret_cast<const char*>(data), size);
  fit_checksums(png);
  require(kFile >= 0 && ::ftruncate(kFile, 0) == 0);
  require(::pwrite(kFile, png.data(), png.size(), 0) == static_cast<ssize_t>(png.size()));
  depthgrid::files::Gray16Image image;
  try {
    depthgrid::files::read_png16(kPath, image);
    require(image.width_px > 0 && image.height_px > 0 && image.pixels.size() <= depthgrid::files::kLargestImagePixels);
  } catch (const depthgrid::Error& error) {
    require(depthgrid::is_printable(error.what()));
  }
  require(image.pixels.size() == static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.height_px));
  return 0;
}
