// The system's clock, which people set, beside the clock of a running cell.
#pragma once

namespace depthgrid::sensors {

/// Seconds by which the system's clock (since 1970) is ahead of clock_now_s(), never too few: stamps then look older
/// rather than newer. Both clocks are read each time.
[[nodiscard]] double system_ahead_s() noexcept;

/// A time of the system's clock on clock_now_s()'s.
[[nodiscard]] inline double clock_of_system_s(double since_1970_s) noexcept { return since_1970_s - system_ahead_s(); }

}  // namespace depthgrid::sensors
