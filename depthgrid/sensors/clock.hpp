// The clock that all sources of a running cell share.
#pragma once

namespace depthgrid::sensors {

/// Seconds of CLOCK_MONOTONIC: it never goes back, and does not stand for a time of day. It stands still while
/// the computer sleeps: it must not.
[[nodiscard]] double clock_now_s() noexcept;

/// Sleeps until then, or until `longest_s` from now, whichever is first. False: it is not yet `time_s`.
bool wait_until(double time_s, double longest_s) noexcept;

}  // namespace depthgrid::sensors
