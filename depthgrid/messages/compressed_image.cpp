#include "depthgrid/messages/compressed_image.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"

namespace depthgrid::messages {
namespace {

constexpr std::size_t kConfigBytes = 12;  ///< kind (int32) and the two numbers of the quantisation (float)
constexpr std::array<std::uint8_t, 8> kPngSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};

/// Little endian, as all machines that write this are.
float float_at(std::span<const std::byte> bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < sizeof value; ++i) {
    value |= std::to_integer<std::uint32_t>(bytes[at + i]) << (8U * i);
  }
  return std::bit_cast<float>(value);
}

bool is_png(std::span<const std::byte> bytes) {
  return bytes.size() >= kPngSignature.size() &&
         std::equal(kPngSignature.begin(), kPngSignature.end(), bytes.begin(),
                    [](std::uint8_t a, std::byte b) { return std::byte{a} == b; });
}

}  // namespace

bool is_compressed_depth(const CompressedImage& image) noexcept {
  return image.format.find("compressedDepth") != std::string::npos;
}

CompressedDepth compressed_depth(const CompressedImage& image) {
  const std::string shown = "the image's format is '" + printable_excerpt(image.format) + "'";
  if (!is_compressed_depth(image)) {
    fail(shown, ", depth needs '16UC1; compressedDepth': other pictures have lost the depths");
  }
  if (image.format.rfind("32FC1", 0) == 0) {
    fail(shown, ": its inverse depths are rounded, so a reading may be farther than it was; record the raw topic");
  }
  if (image.format.rfind("16UC1", 0) != 0 && image.format.rfind("mono16", 0) != 0) {
    fail(shown, ", must begin with 16UC1");
  }
  if (image.format.ends_with("rvl")) {
    fail(shown, ", only 'png' is read; set the publisher's format to png, or record the raw topic");
  }
  if (image.data.size() < kConfigBytes || !is_png(image.data.subspan(kConfigBytes))) {
    fail(shown, ", but its ", image.data.size(), " bytes hold no PNG after the first ", kConfigBytes);
  }
  return {.quantisation_a = float_at(image.data, 4),
          .quantisation_b = float_at(image.data, 8),
          .png = image.data.subspan(kConfigBytes)};
}

std::string compressed_depth_data(std::span<const std::byte> png) {
  std::string data(kConfigBytes, '\0');  // kind 0; no quantisation for 16 bits
  data.append(reinterpret_cast<const char*>(png.data()), png.size());
  return data;
}

}  // namespace depthgrid::messages
