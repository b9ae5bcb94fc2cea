// The clock that all sources of a running cell share.
#pragma once

#include <cstdint>

namespace depthgrid::sensors {

/// Seconds of CLOCK_MONOTONIC: it never goes back, and does not stand for a time of day. It stands still while
/// the computer sleeps: it must not.
[[nodiscard]] double clock_now_s() noexcept;

/// The time in whole nanoseconds, as recordings and messages count: exact for numbers that seconds_of() gives. 0 for
/// what is not finite or beyond 200 years.
[[nodiscard]] std::int64_t nanoseconds_of(double time_s) noexcept;
[[nodiscard]] double seconds_of(std::int64_t time_ns) noexcept;

/// Sleeps until then, or until `longest_s` from now, whichever is first. False: it is not yet `time_s`.
bool wait_until(double time_s, double longest_s) noexcept;

}  // namespace depthgrid::sensors
