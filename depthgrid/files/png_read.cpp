#include <png.h>

#include <array>
#include <bit>
#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/core/whole_file.hpp"
#include "depthgrid/files/image_kind.hpp"
#include "depthgrid/files/png.hpp"

namespace depthgrid::files {
namespace {

constexpr std::size_t kSignatureBytes = 8;

/// libpng reports errors by longjmp. Functions that call setjmp below therefore hold only trivial objects, and all
/// that must be released lives here, outside of their reach.
struct Reader {
  InputStream stream;
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::array<char, 160> message{};

  Reader() = default;
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() {
    if (png != nullptr) {
      png_destroy_read_struct(&png, &info, nullptr);
    }
  }
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
  auto* reader = static_cast<Reader*>(png_get_error_ptr(png));
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): bounded, and it ends the text
  static_cast<void>(std::snprintf(reader->message.data(), reader->message.size(), "%s", message));
  png_longjmp(png, 1);
}

void on_warning(png_structp /*png*/, png_const_charp /*message*/) {}  // a library does not print

void read_bytes(png_structp png, png_bytep bytes, std::size_t count) {
  auto* reader = static_cast<Reader*>(png_get_io_ptr(png));
  if (std::fread(bytes, 1, count, reader->stream.get()) != count) {
    png_error(png, "the file ends too early (truncated)");
  }
}

bool read_header(Reader& reader) noexcept {
  if (setjmp(png_jmpbuf(reader.png)) != 0) {  // NOLINT(cert-err52-cpp): libpng's own way of reporting errors
    return false;
  }
  png_set_read_fn(reader.png, &reader, read_bytes);
  png_set_sig_bytes(reader.png, kSignatureBytes);
  // Sizes are checked below, with a message of our own; libpng's limit would hide the value.
  png_set_user_limits(reader.png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  // Texts, colour profiles and the like say nothing about depth, and a broken length of theirs would have libpng take
  // up to 2 GiB of memory before it finds that the file is shorter: all are skipped as they come.
  png_set_keep_unknown_chunks(reader.png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
  png_read_info(reader.png, reader.info);
  return true;
}

bool read_pixels(Reader& reader, std::uint16_t* pixels, std::size_t width, std::size_t height) noexcept {
  if (setjmp(png_jmpbuf(reader.png)) != 0) {  // NOLINT(cert-err52-cpp): libpng's own way of reporting errors
    return false;
  }
  if constexpr (std::endian::native == std::endian::little) {
    png_set_swap(reader.png);
  }
  const int passes = png_set_interlace_handling(reader.png);
  png_start_read_image(reader.png);
  for (int pass = 0; pass < passes; ++pass) {
    for (std::size_t row = 0; row < height; ++row) {
      png_read_row(reader.png, reinterpret_cast<png_bytep>(pixels + row * width), nullptr);
    }
  }
  png_read_end(reader.png, nullptr);
  return true;
}

std::string colour_name(int type) {
  switch (type) {
    case PNG_COLOR_TYPE_GRAY:
      return "gray";
    case PNG_COLOR_TYPE_GRAY_ALPHA:
      return "gray with alpha";
    case PNG_COLOR_TYPE_PALETTE:
      return "palette";
    case PNG_COLOR_TYPE_RGB:
      return "RGB";
    case PNG_COLOR_TYPE_RGB_ALPHA:
      return "RGB with alpha";
    default:
      return "unknown";
  }
}

/// Whether the signature follows the 12 bytes of a header: the data of a ROS message, written to a file as they came.
/// `signature`: the file's first bytes, read already.
bool is_compressed_depth(std::FILE* stream, std::string_view signature) {
  constexpr std::size_t kHeaderBytes = 12;
  std::array<char, kHeaderBytes> rest{};
  const std::size_t count = std::fread(rest.data(), 1, rest.size(), stream);
  std::string begin(signature);
  begin.append(rest.data(), count);
  return begin.size() == kHeaderBytes + kSignatureBytes &&
         png_sig_cmp(reinterpret_cast<png_const_bytep>(begin.data()) + kHeaderBytes, 0, kSignatureBytes) == 0;
}

/// What is read, from a file or from memory.
struct Source {
  InputStream stream;
  std::string name;     ///< in messages
  std::uint64_t bytes;  ///< its size
};

Source open_file(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    fail(file.string(), ": is a folder, needs to be a 16-bit grayscale PNG file");
  }
  InputStream stream = open_regular_file(file);
  std::error_code error;
  const std::uint64_t bytes = std::filesystem::file_size(file, error);
  return {std::move(stream), file.string(), error ? std::numeric_limits<std::uint64_t>::max() : bytes};
}

/// `png` must outlive it.
Source open_memory(std::span<const std::byte> png, const std::string& name) {
  if (png.empty()) {
    fail(name, ": is empty (0 bytes), needs to be a 16-bit grayscale PNG");
  }
  // Opened for reading, so that nothing is written to it.
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): fmemopen() serves writing, too
  auto* const begin = const_cast<std::byte*>(png.data());
  InputStream stream(::fmemopen(begin, png.size(), "rb"));
  if (stream == nullptr) {
    fail(name, ": cannot be read: ", std::generic_category().message(errno));
  }
  return {std::move(stream), name, png.size()};
}

/// Up to where libpng begins.
void begin_png(Reader& reader, Source source) {
  const std::string file = std::move(source.name);
  reader.stream = std::move(source.stream);
  std::array<png_byte, kSignatureBytes> signature{};
  const std::size_t count = std::fread(signature.data(), 1, signature.size(), reader.stream.get());
  if (count == 0) {
    fail(file, ": is empty (0 bytes), needs to be a 16-bit grayscale PNG file");
  }
  if (std::string_view(reinterpret_cast<const char*>(signature.data()), count) == "version ") {
    fail(file, ": is no PNG file but text, probably a Git LFS pointer: run `git lfs pull` in its repository");
  }
  if (png_sig_cmp(signature.data(), 0, count) != 0) {
    const std::string_view kind = image_kind_of_bytes({reinterpret_cast<const char*>(signature.data()), count});
    if (!kind.empty()) {
      fail(file, ": is no PNG file but ", kind, ", ", way_to_png(kind));
    }
    if (is_compressed_depth(reader.stream.get(), {reinterpret_cast<const char*>(signature.data()), count})) {
      fail(file,
           ": is no PNG file but the data of a ROS compressedDepth message: of a 16UC1 one take away the first 12 "
           "bytes, "
           "what follows is the PNG; a 32FC1 one holds inverse depths, have image_transport republish it as raw");
    }
    fail(file, ": is no PNG file: its first bytes are not PNG's signature");
  }
  if (count < kSignatureBytes) {
    fail(file, ": broken PNG: the file ends too early (truncated)");
  }
  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, on_error, on_warning);
  reader.info = reader.png != nullptr ? png_create_info_struct(reader.png) : nullptr;
  if (reader.info == nullptr) {
    fail(file, ": cannot be read: libpng could not be started (out of memory?)");
  }
}

/// Deflate packs at most 1032 bytes into one, so that a header alone cannot make us allocate an image.
void check_header(const std::string& file, std::uint64_t file_bytes, std::uint64_t image_bytes, png_uint_32 width,
                  png_uint_32 height) {
  constexpr std::uint64_t kLargestRatio = 1032;
  if (image_bytes / kLargestRatio > file_bytes) {
    fail(file, ": broken PNG: ", file_bytes, " bytes cannot hold the ", width, " x ", height,
         " pixels that its header promises (truncated)");
  }
}

struct PngSize {
  int width_px = 0;
  int height_px = 0;
};

/// `expected`: the camera's size, 0 x 0: any.
void read_png(Source source, const PngSize& expected, const std::string& expected_by, Gray16Image& image) {
  const std::string file = source.name;
  const std::uint64_t file_bytes = source.bytes;
  Reader reader;
  begin_png(reader, std::move(source));
  if (!read_header(reader)) {
    fail(file, ": broken PNG: ", reader.message.data());
  }
  const png_uint_32 width = png_get_image_width(reader.png, reader.info);
  const png_uint_32 height = png_get_image_height(reader.png, reader.info);
  const int bits = png_get_bit_depth(reader.png, reader.info);
  const int colour = png_get_color_type(reader.png, reader.info);
  if (colour != PNG_COLOR_TYPE_GRAY || bits != 16) {
    fail(file, ": is a ", bits, "-bit ", colour_name(colour), " PNG, depth images need to be 16-bit gray");
  }
  if (width > png_uint_32{kLargestImageSide} || height > png_uint_32{kLargestImageSide}) {
    fail(file, ": is ", width, " x ", height, " pixels, a side must be at most ", kLargestImageSide);
  }
  if (expected.width_px != 0 && (width != static_cast<png_uint_32>(expected.width_px) ||
                                 height != static_cast<png_uint_32>(expected.height_px))) {
    fail(file, ": is ", width, " x ", height, " pixels, the calibration of ", expected_by, " is for ",
         expected.width_px, " x ", expected.height_px);
  }
  const std::uint64_t count = std::uint64_t{width} * height;
  if (count > kLargestImagePixels) {
    fail(file, ": is ", width, " x ", height, " = ", count, " pixels, must have at most ", kLargestImagePixels);
  }
  check_header(file, file_bytes, count * sizeof(std::uint16_t), width, height);
  image.pixels.resize(count);
  image.width_px = static_cast<int>(width);
  image.height_px = static_cast<int>(height);
  if (!read_pixels(reader, image.pixels.data(), width, height)) {
    fail(file, ": broken PNG: ", reader.message.data());
  }
}

}  // namespace

void read_png16(const std::filesystem::path& file, Gray16Image& image) { read_png(open_file(file), {}, {}, image); }

void read_png16(const std::filesystem::path& file, const PinholeCamera& camera, const std::string& id,
                Gray16Image& image) {
  read_png(open_file(file), {camera.width_px, camera.height_px}, "camera '" + id + "'", image);
}

void read_png16(std::span<const std::byte> png, const std::string& name, const PinholeCamera& camera,
                const std::string& id, Gray16Image& image) {
  read_png(open_memory(png, name), {camera.width_px, camera.height_px}, "camera '" + id + "'", image);
}

Gray16Image read_png16(const std::filesystem::path& file) {
  Gray16Image image;
  read_png16(file, image);
  return image;
}

}  // namespace depthgrid::files
