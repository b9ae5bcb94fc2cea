// sensor_msgs/msg/Image: a picture of any kind, and the depth images among them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/messages/standard.hpp"

namespace depthgrid::messages {

/// - Memory: `data` is not owned. Of a message that was read it is a view of the bytes it was read from.
struct Image {
  Header header;  ///< middle of the exposure, where the driver says so; the optical frame
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string encoding;           ///< "16UC1", "32FC1", ...
  std::uint8_t is_bigendian = 0;  ///< of the pixels, whatever the message is
  std::uint32_t step = 0;         ///< bytes from row to row
  std::span<const std::byte> data;
};

/// Metres of one unit of 16UC1, as ROS has it (REP 118): millimetres.
inline constexpr double kMetresPerUnit = 0.001;

/// Whether the encoding is one of depth: 16UC1, mono16 (as older drivers call it) or 32FC1.
[[nodiscard]] bool is_depth(const Image& image) noexcept;

/// Memory for pixels that cannot be looked at where they lie. It may be used again.
struct DepthPixels {
  std::vector<std::uint16_t> units;
  std::vector<float> metres;
};

/// The depth of a message: on the message's own bytes where they lie at multiples of a pixel's size in the machine's
/// byte order, else on `pixels`, which the bytes are copied to; either must outlive the view. 16UC1 is in units of
/// `metres_per_unit`, 32FC1 in metres. Throws Error with value and rule for another encoding, a side of 0 or above
/// kLargestImageSide, rows that overlap, and fewer bytes than rows need.
[[nodiscard]] DepthView depth_view(const Image& image, DepthPixels& pixels, double metres_per_unit = kMetresPerUnit);

/// The way back: header and step are left to you. Images of 16 bits in millimetres are 16UC1, all others 32FC1 in
/// metres, so that no reading changes; what the rule calls no measurement by its value, not by near and far, is 0 or
/// NaN. Its data are in `pixels`. Throws nothing but std::bad_alloc, and not that where pixels had room before.
[[nodiscard]] Image image_of(const DepthView& view, const MeasurementRule& rule, DepthPixels& pixels);

}  // namespace depthgrid::messages
