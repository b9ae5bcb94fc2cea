// PNG images: what is written is what is read, and broken files are refused with one line that says why.
#include "depthgrid/files/png.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <functional>
#include <numeric>
#include <random>

#include "files/temporary_folder.hpp"
#include "support/random_run.hpp"

namespace depthgrid::files {
namespace {

using test::message_of;
using test::TemporaryFolder;

/// All values 0 ... 65535 as 256 x 256 pixels: wrong byte order or a lost bit cannot hide.
std::vector<std::uint16_t> all_values() {
  std::vector<std::uint16_t> pixels(65536);
  std::iota(pixels.begin(), pixels.end(), std::uint16_t{0});
  return pixels;
}

// 3 x 5 pixels, 16-bit gray, interlaced (Adam7); pixel (u, v) is 1000 v + 7 u. Made by hand with zlib and struct.
constexpr unsigned char kInterlaced[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00,
    0x00, 0x03, 0x00, 0x00, 0x00, 0x05, 0x10, 0x00, 0x00, 0x00, 0x01, 0x82, 0x8d, 0xe5, 0xab, 0x00, 0x00, 0x00,
    0x31, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x60, 0x60, 0x60, 0xe0, 0x5f, 0xc0, 0xc0, 0xc0, 0xc7, 0xc0,
    0xbf, 0x8e, 0x81, 0xfd, 0x02, 0xfb, 0x3d, 0x06, 0x06, 0x76, 0x06, 0xf6, 0xeb, 0x0c, 0xfc, 0xcb, 0x19, 0x98,
    0x5f, 0x30, 0xbf, 0x67, 0xfe, 0xc6, 0xc0, 0xbd, 0x83, 0x7b, 0x3f, 0xf7, 0x31, 0x00, 0x99, 0x0f, 0x0a, 0x06,
    0xac, 0x76, 0x2a, 0xfd, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82,
};

/// Width, height and the like of the header start at byte 16; its checksum is mended for the reader.
std::string with_header_field(std::string png, std::size_t at, std::string_view bytes) {
  png.replace(at, bytes.size(), bytes);
  std::uint32_t crc = 0xFFFFFFFFU;
  for (std::size_t k = 12; k < 29; ++k) {
    crc ^= static_cast<unsigned char>(png[k]);
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
    }
  }
  crc = ~crc;
  for (std::size_t k = 0; k < 4; ++k) {
    png[29 + k] = static_cast<char>((crc >> (24 - 8 * k)) & 0xFFU);
  }
  return png;
}

TEST(Png, GivesBackAll65536Values) {
  const TemporaryFolder folder;
  const std::vector<std::uint16_t> pixels = all_values();
  write_png_gray16(folder / "a.png", 256, 256, pixels);
  const Gray16Image image = read_png16(folder / "a.png");
  EXPECT_EQ(image.width_px, 256);
  EXPECT_EQ(image.height_px, 256);
  EXPECT_EQ(image.pixels, pixels);
}

TEST(Png, RandomSizesAndPixelsRoundTrip) {
  const test::RandomRun random_run = test::random_run(50);
  const auto seed = static_cast<unsigned>(random_run.seed);
  const TemporaryFolder folder;
  for (int run = 0; run < random_run.count; ++run) {
    std::mt19937 random(seed + static_cast<unsigned>(run));
    const int width = std::uniform_int_distribution<int>(1, 90)(random);
    const int height = std::uniform_int_distribution<int>(1, 70)(random);
    std::vector<std::uint16_t> pixels(static_cast<std::size_t>(width * height));
    for (std::uint16_t& pixel : pixels) {
      pixel = static_cast<std::uint16_t>(random());
    }
    write_png_gray16(folder / "a.png", width, height, pixels);
    const Gray16Image image = read_png16(folder / "a.png");
    ASSERT_TRUE(image.width_px == width && image.height_px == height && image.pixels == pixels)
        << "DEPTHGRID_TEST_SEED=" << seed + static_cast<unsigned>(run) << " DEPTHGRID_TEST_COUNT=1, size " << width
        << " x " << height;
  }
}

TEST(Png, ReadsInterlacedImages) {
  const TemporaryFolder folder;
  const auto file =
      folder.write("a.png", std::string_view(reinterpret_cast<const char*>(kInterlaced), sizeof(kInterlaced)));
  const Gray16Image image = read_png16(file);
  ASSERT_EQ(image.width_px, 3);
  ASSERT_EQ(image.height_px, 5);
  for (int v = 0; v < 5; ++v) {
    for (int u = 0; u < 3; ++u) {
      EXPECT_EQ(image.pixels[static_cast<std::size_t>(v * 3 + u)], 1000 * v + 7 * u) << u << ", " << v;
    }
  }
}

TEST(Png, ReadingAgainKeepsTheMemory) {
  const TemporaryFolder folder;
  write_png_gray16(folder / "a.png", 256, 256, all_values());
  Gray16Image image;
  read_png16(folder / "a.png", image);
  const std::uint16_t* memory = image.pixels.data();
  read_png16(folder / "a.png", image);
  EXPECT_EQ(image.pixels.data(), memory);
}

TEST(Png, WritesReplaceTheFileAndLeaveNothingBeside) {
  const TemporaryFolder folder;
  write_png_gray16(folder / "a.png", 256, 256, all_values());
  write_png_gray8(folder / "a.png", 2, 1, std::vector<std::uint8_t>{7, 200});
  write_png_rgb8(folder / "b.png", 1, 1, std::vector<std::uint8_t>{1, 2, 3});
  EXPECT_EQ(folder.entries(), 2U);
  EXPECT_EQ(test::read_bytes(folder / "a.png").substr(1, 3), "PNG");
}

TEST(Png, FailedWriteLeavesTheOldFile) {
  const TemporaryFolder folder;
  write_png_gray16(folder / "a.png", 256, 256, all_values());
  EXPECT_THROW(write_png_gray16(folder / "a.png", 3, 3, all_values()), Error);
  EXPECT_EQ(read_png16(folder / "a.png").pixels, all_values());
  EXPECT_EQ(folder.entries(), 1U);
}

/// One broken file (or call) and the whole message it must give; the folder is cut out of the message.
struct Broken {
  const char* name;
  std::function<void(const TemporaryFolder&)> action;
  const char* message;
};

void PrintTo(const Broken& broken, std::ostream* out) { *out << broken.name; }

void read_bytes_as_png(const TemporaryFolder& folder, std::string_view bytes) {
  read_png16(folder.write("a.png", bytes));
}

std::string valid_png(const TemporaryFolder& folder) {
  write_png_gray16(folder / "valid.png", 256, 256, all_values());
  return test::read_bytes(folder / "valid.png");
}

class BrokenPng : public ::testing::TestWithParam<Broken> {};

TEST_P(BrokenPng, IsRefusedWithItsReason) {
  const TemporaryFolder folder;
  EXPECT_EQ(message_of([&] { GetParam().action(folder); }, folder.path()), GetParam().message);
}

const Broken kBroken[] = {
    {"Absent", [](const TemporaryFolder& f) { read_png16(f / "a.png"); },
     "a.png: cannot be read: No such file or directory"},
    {"Folder", [](const TemporaryFolder& f) { read_png16(f.path() / "."); },
     ".: is a folder, needs to be a 16-bit grayscale PNG file"},
    {"Empty", [](const TemporaryFolder& f) { read_bytes_as_png(f, ""); },
     "a.png: is empty (0 bytes), needs to be a 16-bit grayscale PNG file"},
    {"Text", [](const TemporaryFolder& f) { read_bytes_as_png(f, "depth depth depth"); },
     "a.png: is no PNG file: its first bytes are not PNG's signature"},
    {"Jpeg", [](const TemporaryFolder& f) { read_bytes_as_png(f, "\xFF\xD8\xFF\xE0 JFIF"); },
     "a.png: is no PNG file but JPEG, depth images need to be 16-bit gray PNG: JPEG has lost the depths, record them "
     "anew"},
    {"Tiff", [](const TemporaryFolder& f) { read_bytes_as_png(f, std::string("II*\0\x08\0\0\0", 8)); },
     "a.png: is no PNG file but TIFF, depth images need to be 16-bit gray PNG: write the TIFF files' depths in units "
     "of "
     "metres_per_unit (millimetres: 0.001) as such, with OpenCV's imwrite, say"},
    {"CutInSignature", [](const TemporaryFolder& f) { read_bytes_as_png(f, valid_png(f).substr(0, 5)); },
     "a.png: broken PNG: the file ends too early (truncated)"},
    {"CutInHeader", [](const TemporaryFolder& f) { read_bytes_as_png(f, valid_png(f).substr(0, 20)); },
     "a.png: broken PNG: the file ends too early (truncated)"},
    {"CutInPixels",
     [](const TemporaryFolder& f) {
       const std::string png = valid_png(f);
       read_bytes_as_png(f, std::string_view(png).substr(0, png.size() / 2));
     },
     "a.png: broken PNG: the file ends too early (truncated)"},
    {"CutAtTheEnd",
     [](const TemporaryFolder& f) {
       const std::string png = valid_png(f);
       read_bytes_as_png(f, std::string_view(png).substr(0, png.size() - 6));
     },
     "a.png: broken PNG: the file ends too early (truncated)"},
    {"FlippedByte",
     [](const TemporaryFolder& f) {
       std::string png = valid_png(f);
       png[png.size() / 2] = static_cast<char>(png[png.size() / 2] ^ 0x55);
       read_bytes_as_png(f, png);
     },
     "a.png: broken PNG: IDAT: CRC error"},
    {"EightBitGray",
     [](const TemporaryFolder& f) {
       write_png_gray8(f / "a.png", 2, 1, std::vector<std::uint8_t>{1, 2});
       read_png16(f / "a.png");
     },
     "a.png: is a 8-bit gray PNG, depth images need to be 16-bit gray"},
    {"Colour",
     [](const TemporaryFolder& f) {
       write_png_rgb8(f / "a.png", 1, 1, std::vector<std::uint8_t>{1, 2, 3});
       read_png16(f / "a.png");
     },
     "a.png: is a 8-bit RGB PNG, depth images need to be 16-bit gray"},
    {"HugeSides",
     [](const TemporaryFolder& f) {
       const std::string png = valid_png(f);
       read_bytes_as_png(f, with_header_field(png, 16, std::string_view("\x7F\xFF\xFF\xFF\x00\x00\x00\x01", 8)));
     },
     "a.png: is 2147483647 x 1 pixels, a side must be at most 16384"},
    {"MorePixelsThanMemory",  // 261 kB would become half a gigabyte
     [](const TemporaryFolder& f) {
       const std::string png = valid_png(f);
       read_bytes_as_png(f, with_header_field(png, 16, std::string_view("\x00\x00\x40\x00\x00\x00\x40\x00", 8)) +
                                std::string(300000, '\0'));
     },
     "a.png: is 16384 x 16384 = 268435456 pixels, must have at most 16777216"},
    {"Pipe",
     [](const TemporaryFolder& f) {
       ASSERT_EQ(::mkfifo((f / "a.png").c_str(), 0600), 0);
       read_png16(f / "a.png");
     },
     "a.png: is a pipe, must be a regular file; copy what it gives into one"},
    {"Device", [](const TemporaryFolder&) { read_png16("/dev/zero"); },
     "/dev/zero: is a device, must be a regular file; copy what it gives into one"},
    {"LfsPointer",
     [](const TemporaryFolder& f) { read_bytes_as_png(f, "version https://git-lfs.github.com/spec/v1\n"); },
     "a.png: is no PNG file but text, probably a Git LFS pointer: run `git lfs pull` in its repository"},
    {"CompressedDepth", [](const TemporaryFolder& f) { read_bytes_as_png(f, std::string(12, '\0') + valid_png(f)); },
     "a.png: is no PNG file but the data of a ROS compressedDepth message: of a 16UC1 one take away the first 12 "
     "bytes, what follows is the PNG; a 32FC1 one holds inverse depths, have image_transport republish it as raw"},
    {"OtherSizeThanTheCamera",
     [](const TemporaryFolder& f) {
       Gray16Image image;
       (void)f.write("a.png", valid_png(f));
       read_png16(f / "a.png", PinholeCamera{640, 480, 500, 500, 320, 240}, "left", image);
     },
     "a.png: is 256 x 256 pixels, the calibration of camera 'left' is for 640 x 480"},
    {"ZeroWidth",
     [](const TemporaryFolder& f) {
       const std::string png = valid_png(f);
       read_bytes_as_png(f, with_header_field(png, 16, std::string_view("\x00\x00\x00\x00", 4)));
     },
     "a.png: broken PNG: Invalid IHDR data"},
    {"HeaderPromisesTooMuch",
     [](const TemporaryFolder& f) {
       const std::string png = valid_png(f);
       read_bytes_as_png(
           f, with_header_field(png, 16, std::string_view("\x00\x00\x08\x00\x00\x00\x08\x00", 8)).substr(0, 200));
     },
     "a.png: broken PNG: 200 bytes cannot hold the 2048 x 2048 pixels that its header promises (truncated)"},
    {"WriteOfTooFewValues",
     [](const TemporaryFolder& f) { write_png_rgb8(f / "a.png", 2, 2, std::vector<std::uint8_t>(4)); },
     "a.png: cannot be written: 4 values given, 2 x 2 pixels need 12"},
    {"WriteOfNoPixels", [](const TemporaryFolder& f) { write_png_gray16(f / "a.png", 0, 4, {}); },
     "a.png: cannot be written: size is 0 x 4 px, each side must be between 1 and 16384"},
    {"WriteIntoAbsentFolder",
     [](const TemporaryFolder& f) { write_png_gray8(f / "no/a.png", 1, 1, std::vector<std::uint8_t>(1)); },
     "no/a.png: cannot be written: No such file or directory"},
};

INSTANTIATE_TEST_SUITE_P(All, BrokenPng, ::testing::ValuesIn(kBroken),
                         [](const auto& broken) { return broken.param.name; });

}  // namespace
}  // namespace depthgrid::files
