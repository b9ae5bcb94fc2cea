// Reading and writing of PNG images. The PNG library itself is not visible from here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "depthgrid/core/camera.hpp"

namespace depthgrid::files {

/// A 16-bit gray image: row-major, no padding, pixel (u, v) at v * width_px + u.
struct Gray16Image {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint16_t> pixels;
};

/// Most pixels of an image that is read: 4096 x 4096, several times what depth cameras have.
inline constexpr std::uint64_t kLargestImagePixels = std::uint64_t{1} << 24U;

/// Reads a 16-bit grayscale PNG (interlaced or not) in the machine's byte order. Any other colour type or bit depth is
/// refused, because a depth image that went through 8 bits or colours is no depth image any more. Throws Error with one
/// line that names the file and the offending value: absent, empty, no PNG, truncated, corrupt, wrong type, a side of
/// more than kLargestImageSide pixels, more than kLargestImagePixels, no regular file. All of these but truncated and
/// corrupt pixels are refused by the header, before memory is taken.
Gray16Image read_png16(const std::filesystem::path& file);

/// The same into `image`, whose memory is used again: nothing is allocated for pixels when the size stays the same.
/// On an error the contents of `image` are unspecified, its size and its number of pixels still agree.
void read_png16(const std::filesystem::path& file, Gray16Image& image);

/// An image of the camera called `id`: any other size is refused by the header, too.
void read_png16(const std::filesystem::path& file, const PinholeCamera& camera, const std::string& id,
                Gray16Image& image);

/// The same of a PNG in memory, called `name` in messages.
void read_png16(std::span<const std::byte> png, const std::string& name, const PinholeCamera& camera,
                const std::string& id, Gray16Image& image);

/// Write width_px x height_px images, row-major without padding: 16-bit gray, 8-bit gray, 8-bit RGB (three bytes a
/// pixel, so 3 * width_px * height_px values). The image is written beside its place under a temporary name and then
/// renamed, so that `file` is never half-written. Throw Error when the number of values does not fit the size, a side
/// is outside [1, kLargestImageSide] or the file cannot be written. Calls for different files may run concurrently.
void write_png_gray16(const std::filesystem::path& file, int width_px, int height_px,
                      std::span<const std::uint16_t> pixels);
void write_png_gray8(const std::filesystem::path& file, int width_px, int height_px,
                     std::span<const std::uint8_t> pixels);
void write_png_rgb8(const std::filesystem::path& file, int width_px, int height_px,
                    std::span<const std::uint8_t> pixels);

}  // namespace depthgrid::files
