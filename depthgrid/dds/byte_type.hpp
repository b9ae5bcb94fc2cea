// A DDS type of which this program knows the name only: messages go through as the bytes they are. Internal.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

struct ddsi_serdata;
struct ddsi_sertype;

namespace depthgrid::dds {

/// A new type of this DDS name ("sensor_msgs::msg::dds_::Image_"), without key. Creating a topic takes it over.
[[nodiscard]] ddsi_sertype* make_byte_type(const std::string& dds_name);

/// A message of a type made here, to be written: a copy of the bytes, the four of the encoding in front among them.
[[nodiscard]] ddsi_serdata* make_byte_message(const ddsi_sertype* type, std::span<const std::byte> bytes);

/// The bytes of a message that came in.
void copy_bytes(const ddsi_serdata* message, std::vector<std::byte>& bytes);

}  // namespace depthgrid::dds
