// Which device of the simulated cell fails when, and how: planned ahead, so that devices, which are processes, and
// whoever checks the answers afterwards know the same.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace depthgrid::lab {

enum class DeviceFault : std::uint8_t {
  drop,        ///< nothing is sent
  delay,       ///< each message comes later than messages count
  freeze,      ///< the same pixels with new times
  reorder,     ///< every second message comes after the next
  duplicate,   ///< each message comes twice
  black,       ///< no pixel has a reading
  wrong_size,  ///< images are half as high; joint states lack joints
  fast_clock,  ///< an hour ahead
  slow_clock,  ///< an hour behind
  unplug,      ///< the device leaves the network, and comes back
  restart,     ///< it leaves, and comes back at once
  network,     ///< nothing of any device arrives
};
inline constexpr std::array kDeviceFaults{DeviceFault::drop,       DeviceFault::delay,      DeviceFault::freeze,
                                          DeviceFault::reorder,    DeviceFault::duplicate,  DeviceFault::black,
                                          DeviceFault::wrong_size, DeviceFault::fast_clock, DeviceFault::slow_clock,
                                          DeviceFault::unplug,     DeviceFault::restart,    DeviceFault::network};

/// "drop", "wrong size", ...
[[nodiscard]] std::string_view to_string(DeviceFault fault) noexcept;

/// What is exposed from begin_s until before end_s, seconds of the cell's time, is sent as the fault has it.
struct PlannedFault {
  std::string device;
  DeviceFault fault = DeviceFault::drop;
  double begin_s = 0;
  double end_s = 0;
};

/// Nothing but messages that do not count: not sent, too late, of another time, or pixels that were sent before.
[[nodiscard]] bool hides(DeviceFault fault) noexcept;

inline constexpr std::string_view kJointsDevice = "joints";

/// Faults of each camera and of the joints, each by itself, so that they come together in all combinations; and some of
/// the whole network. Between two of one device lie at least 3 s. Joints do not freeze or go black: a robot that says
/// that it stands where it stood is believed. The same seed gives the same plan.
[[nodiscard]] std::vector<PlannedFault> random_faults(const std::vector<std::string>& cameras, double seconds,
                                                      std::uint64_t seed);

struct DayPlan {
  double begin_s = 0;  ///< the clock's time (CLOCK_MONOTONIC) at which the cell's is 0
  double seconds = 0;  ///< of the cell's time
  double image_rate_hz = 15;
  double joint_rate_hz = 200;
  std::vector<PlannedFault> faults{};
};

void write_plan(const std::filesystem::path& file, const DayPlan& plan);
/// Throws Error that names the file.
[[nodiscard]] DayPlan read_plan(const std::filesystem::path& file);

}  // namespace depthgrid::lab
