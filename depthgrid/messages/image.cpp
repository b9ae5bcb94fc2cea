#include "depthgrid/messages/image.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/core/usable_frame.hpp"

namespace depthgrid::messages {
namespace {

bool is_16_bit(const Image& image) noexcept { return image.encoding == "16UC1" || image.encoding == "mono16"; }

/// The message's own pixels, row by row without padding.
template <class Pixel>
void copy_pixels(const Image& image, bool swap, std::vector<Pixel>& pixels) {
  pixels.resize(std::size_t{image.width} * image.height);
  const std::size_t row_bytes = image.width * sizeof(Pixel);
  for (std::size_t row = 0; row < image.height; ++row) {
    std::memcpy(pixels.data() + row * image.width, image.data.data() + row * image.step, row_bytes);
  }
  if (swap) {
    for (Pixel& pixel : pixels) {
      auto raw = std::bit_cast<std::array<std::byte, sizeof(Pixel)>>(pixel);
      std::reverse(raw.begin(), raw.end());
      pixel = std::bit_cast<Pixel>(raw);
    }
  }
}

void check_layout(const Image& image, std::size_t pixel_bytes) {
  const auto largest = static_cast<std::uint32_t>(kLargestImageSide);
  if (image.width < 1 || image.height < 1 || image.width > largest || image.height > largest) {
    fail("the image is ", image.width, " x ", image.height, " pixels, a side must be from 1 to ", largest);
  }
  if (image.step < image.width * pixel_bytes) {
    fail("the image's step is ", image.step, " bytes, ", image.width, " pixels of ", image.encoding, " need ",
         image.width * pixel_bytes);
  }
  const std::size_t needed = std::size_t{image.step} * (image.height - 1) + image.width * pixel_bytes;
  if (image.data.size() < needed) {
    fail("the image has ", image.data.size(), " bytes, ", image.width, " x ", image.height, " pixels of ",
         image.encoding, " with a step of ", image.step, " need ", needed);
  }
}

}  // namespace

bool is_depth(const Image& image) noexcept { return is_16_bit(image) || image.encoding == "32FC1"; }

DepthView depth_view(const Image& image, DepthPixels& pixels, double metres_per_unit) {
  if (!is_depth(image)) {
    fail("the image's encoding is '", printable_excerpt(image.encoding),
         "', a depth image needs 16UC1, mono16 or 32FC1");
  }
  const std::size_t pixel_bytes = is_16_bit(image) ? sizeof(std::uint16_t) : sizeof(float);
  check_layout(image, pixel_bytes);
  const bool swap = (image.is_bigendian != 0) != (std::endian::native == std::endian::big);
  const auto address = reinterpret_cast<std::uintptr_t>(image.data.data());
  const int width_px = static_cast<int>(image.width);
  const int height_px = static_cast<int>(image.height);
  if (!swap && address % pixel_bytes == 0 && image.step % pixel_bytes == 0) {
    return {.data = image.data.data(),
            .format = is_16_bit(image) ? DepthFormat::uint16_units : DepthFormat::float32_metres,
            .width_px = width_px,
            .height_px = height_px,
            .stride_bytes = static_cast<std::ptrdiff_t>(image.step),
            .metres_per_unit = metres_per_unit};
  }
  if (is_16_bit(image)) {
    copy_pixels(image, swap, pixels.units);
    return depthgrid::depth_view(pixels.units, width_px, height_px, metres_per_unit);
  }
  copy_pixels(image, swap, pixels.metres);
  return depthgrid::depth_view(pixels.metres, width_px, height_px);
}

namespace {

/// All pixels without padding; `raw` says whether the view's own bytes are taken.
template <class Pixel, class Value>
void fill_pixels(const DepthView& view, bool raw, const Value& value, std::vector<Pixel>& pixels) {
  const std::ptrdiff_t stride = view.stride_bytes != 0 ? view.stride_bytes : row_bytes(view.format, view.width_px);
  const auto width = static_cast<std::size_t>(view.width_px);
  pixels.resize(width * static_cast<std::size_t>(view.height_px));
  for (int v = 0; v < view.height_px; ++v) {
    Pixel* const row = pixels.data() + static_cast<std::size_t>(v) * width;
    if (raw) {
      std::memcpy(row, static_cast<const std::byte*>(view.data) + v * stride, width * sizeof(Pixel));
      continue;
    }
    for (int u = 0; u < view.width_px; ++u) {
      row[u] = value(u, v);
    }
  }
}

}  // namespace

Image image_of(const DepthView& view, const MeasurementRule& rule, DepthPixels& pixels) {
  Image image;
  image.width = static_cast<std::uint32_t>(view.width_px);
  image.height = static_cast<std::uint32_t>(view.height_px);
  MeasurementRule values;
  values.invalid_units = rule.invalid_units;
  const bool is_float = view.format == DepthFormat::float32_metres;
  if (!is_float && view.metres_per_unit == kMetresPerUnit) {
    const auto unit = [&](int u, int v) {
      const auto* row = static_cast<const std::byte*>(view.data) + v * with_stride(view).stride_bytes;
      return measured_depth_m(view, values, u, v) ? reinterpret_cast<const std::uint16_t*>(row)[u] : std::uint16_t{0};
    };
    fill_pixels(view, values.invalid_units.empty(), unit, pixels.units);
    image.encoding = "16UC1";
    image.step = image.width * static_cast<std::uint32_t>(sizeof(std::uint16_t));
    image.data = std::as_bytes(std::span(pixels.units));
    return image;
  }
  const auto metres = [&](int u, int v) {
    return measured_depth_m(view, values, u, v).value_or(std::numeric_limits<float>::quiet_NaN());
  };
  fill_pixels(view, is_float, metres, pixels.metres);
  image.encoding = "32FC1";
  image.step = image.width * static_cast<std::uint32_t>(sizeof(float));
  image.data = std::as_bytes(std::span(pixels.metres));
  return image;
}

}  // namespace depthgrid::messages
