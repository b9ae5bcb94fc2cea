// builtin_interfaces and std_msgs: what other messages begin with.
#pragma once

#include <cstdint>
#include <string>

namespace depthgrid::messages {

/// builtin_interfaces/msg/Time: since the epoch of the sender's clock.
struct Time {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
};

/// builtin_interfaces/msg/Duration.
struct Duration {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
};

/// std_msgs/msg/Header.
struct Header {
  Time stamp;
  std::string frame_id;
};

/// std_msgs/msg/String.
struct Text {
  std::string data;
};

/// std_msgs/msg/ColorRGBA: 0 to 1.
struct Color {
  float r = 0;
  float g = 0;
  float b = 0;
  float a = 0;
};

/// As a number, as the library counts time: to the quarter of a microsecond for the times of our days.
[[nodiscard]] constexpr double seconds(const Time& time) noexcept { return time.sec + time.nanosec * 1e-9; }

/// Nanoseconds, exactly, as recordings count them.
[[nodiscard]] constexpr std::int64_t nanoseconds(const Time& time) noexcept {
  return std::int64_t{time.sec} * 1'000'000'000 + time.nanosec;
}

/// The way back. Beyond what the message holds it is the nearest time that it does.
[[nodiscard]] Time time_of_nanoseconds(std::int64_t time_ns) noexcept;

/// The nearest nanosecond; seconds() gives back the same number, to a nanosecond where it is below 4 million. Throws
/// Error for numbers that are not finite or beyond what the message holds (to 2038, from 1901).
[[nodiscard]] Time time_of(double time_s);

}  // namespace depthgrid::messages
