// sensor_msgs/msg/CompressedImage, and how image_transport's compressedDepth lies in it.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "depthgrid/messages/standard.hpp"

namespace depthgrid::messages {

/// - Memory: `data` is not owned. Of a message that was read it is a view of the bytes it was read from.
struct CompressedImage {
  Header header;
  std::string format;  ///< "16UC1; compressedDepth png", "jpeg", ...
  std::span<const std::byte> data;
};

/// A compressed depth image: 12 bytes, then a PNG. The two numbers are those of inverse depths; depths of 16 bits are
/// stored as they are.
struct CompressedDepth {
  float quantisation_a = 0;
  float quantisation_b = 0;
  std::span<const std::byte> png;  ///< 16-bit gray, millimetres
};

/// Whether the format names compressedDepth.
[[nodiscard]] bool is_compressed_depth(const CompressedImage& image) noexcept;

/// The parts of a compressedDepth message of 16UC1. Throws Error that names the format: for JPEG and other pictures,
/// for 32FC1, whose inverse depths are rounded, so that a reading may be farther than it was; for the format "rvl"; and
/// where there is no PNG after the 12 bytes.
[[nodiscard]] CompressedDepth compressed_depth(const CompressedImage& image);

/// The bytes of such a message's `data` from those of a PNG file.
[[nodiscard]] std::string compressed_depth_data(std::span<const std::byte> png);

}  // namespace depthgrid::messages
