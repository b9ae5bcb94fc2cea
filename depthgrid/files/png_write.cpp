#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <string>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/core/file_replacement.hpp"
#include "depthgrid/files/png.hpp"

namespace depthgrid::files {
namespace {

struct Layout {
  int width_px;
  int height_px;
  int bits;
  int colour;
  std::size_t row_bytes;
};

/// As for reading: what must be released lives outside of the functions that call setjmp.
struct Writer {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::array<char, 160> message{};

  Writer() = default;
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() {
    if (png != nullptr) {
      png_destroy_write_struct(&png, &info);
    }
  }
};

[[noreturn]] void on_write_error(png_structp png, png_const_charp message) {
  auto* writer = static_cast<Writer*>(png_get_error_ptr(png));
  // Into a fixed buffer: nothing may be constructed across the jump.
  const std::size_t length = std::min(std::strlen(message), writer->message.size() - 1);
  std::copy_n(message, length, writer->message.begin());
  writer->message[length] = '\0';
  png_longjmp(png, 1);
}

void on_write_warning(png_structp /*png*/, png_const_charp /*message*/) {}

bool write_image(Writer& writer, std::FILE* stream, const Layout& layout, const png_byte* pixels) noexcept {
  if (setjmp(png_jmpbuf(writer.png)) != 0) {  // NOLINT(cert-err52-cpp): libpng's own way of reporting errors
    return false;
  }
  png_init_io(writer.png, stream);
  png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(layout.width_px),
               static_cast<png_uint_32>(layout.height_px), layout.bits, layout.colour, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(writer.png, writer.info);
  if (layout.bits == 16 && std::endian::native == std::endian::little) {
    png_set_swap(writer.png);
  }
  for (int row = 0; row < layout.height_px; ++row) {
    png_write_row(writer.png, pixels + static_cast<std::size_t>(row) * layout.row_bytes);
  }
  png_write_end(writer.png, nullptr);
  return true;
}

/// `values` is the number of array elements given, `channels` how many a pixel has.
void write_png(const std::filesystem::path& file, const Layout& layout, std::size_t values, std::size_t channels,
               const void* pixels) {
  if (layout.width_px < 1 || layout.height_px < 1 || layout.width_px > kLargestImageSide ||
      layout.height_px > kLargestImageSide) {
    fail(file.string(), ": cannot be written: size is ", layout.width_px, " x ", layout.height_px,
         " px, each side must be between 1 and ", kLargestImageSide);
  }
  const std::size_t needed =
      static_cast<std::size_t>(layout.width_px) * static_cast<std::size_t>(layout.height_px) * channels;
  if (values != needed) {
    fail(file.string(), ": cannot be written: ", values, " values given, ", layout.width_px, " x ", layout.height_px,
         " pixels need ", needed);
  }
  FileReplacement target(file);
  Writer writer;
  writer.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &writer, on_write_error, on_write_warning);
  writer.info = writer.png != nullptr ? png_create_info_struct(writer.png) : nullptr;
  if (writer.info == nullptr) {
    fail(file.string(), ": cannot be written: libpng could not be started (out of memory?)");
  }
  if (!write_image(writer, target.stream(), layout, static_cast<const png_byte*>(pixels))) {
    fail(file.string(), ": cannot be written: ", writer.message.data());
  }
  target.commit();
}

}  // namespace

void write_png_gray16(const std::filesystem::path& file, int width_px, int height_px,
                      std::span<const std::uint16_t> pixels) {
  write_png(file, {width_px, height_px, 16, PNG_COLOR_TYPE_GRAY, static_cast<std::size_t>(width_px) * 2}, pixels.size(),
            1, pixels.data());
}

void write_png_gray8(const std::filesystem::path& file, int width_px, int height_px,
                     std::span<const std::uint8_t> pixels) {
  write_png(file, {width_px, height_px, 8, PNG_COLOR_TYPE_GRAY, static_cast<std::size_t>(width_px)}, pixels.size(), 1,
            pixels.data());
}

void write_png_rgb8(const std::filesystem::path& file, int width_px, int height_px,
                    std::span<const std::uint8_t> pixels) {
  write_png(file, {width_px, height_px, 8, PNG_COLOR_TYPE_RGB, static_cast<std::size_t>(width_px) * 3}, pixels.size(),
            3, pixels.data());
}

}  // namespace depthgrid::files
