// What the world calls a message: names, definition and hash of its type.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace depthgrid::messages {

/// All static strings.
struct MessageType {
  std::string_view name;        ///< ROS 2: "sensor_msgs/msg/Image"
  std::string_view dds_name;    ///< on DDS: "sensor_msgs::msg::dds_::Image_"
  std::string_view hash;        ///< of the description, as ROS 2 compares types since Iron (REP 2016): "RIHS01_..."
  std::string_view definition;  ///< "ros2msg": the text of the .msg file, then those of the types within it
};

/// All that this room reads and writes.
[[nodiscard]] std::span<const MessageType> message_types() noexcept;

/// By its ROS 2 name. Throws Error that lists the names there are.
[[nodiscard]] const MessageType& message_type(std::string_view name);

}  // namespace depthgrid::messages
