// Time stamps of ROS 2 on the clock of a running cell.
#pragma once

#include "depthgrid/messages/standard.hpp"

namespace depthgrid::sensors {

/// A stamp of the system's clock (since 1970) on clock_now_s()'s. Both clocks are read each time, so that it
/// is right again with the first message after the system's is set; one that was under way then is off by as much. A
/// stamp never looks newer than it is by the time between the two readings. Another computer's stamps are as wrong as
/// its clock: chrony or PTP keep them together.
[[nodiscard]] double clock_time_s(const messages::Time& stamp) noexcept;

/// The way back: a time of clock_now_s() as a stamp. NaN and times that no stamp holds become 0.
[[nodiscard]] messages::Time stamp_of(double time_s) noexcept;

}  // namespace depthgrid::sensors
