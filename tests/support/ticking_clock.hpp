// A steady clock that goes on by one tick whenever it is read, so that a limit of time can be tested without waiting.
//
//   test::TickingClock clock(std::chrono::milliseconds(1));
//   search.distances(snapshot, capsules, answers, {.time_s = 0.01});
//   EXPECT_EQ(clock.reads(), 11);  // the beginning, and ten ticks
//
// Linking a test that uses this replaces clock_gettime in that program, which std::chrono::steady_clock reads. What
// other threads read, and other clocks, stay what they are.
#pragma once

#include <chrono>
#include <cstdint>

namespace depthgrid::test {

/// For the thread that makes it, as long as it lives; one at a time.
class TickingClock {
 public:
  explicit TickingClock(std::chrono::nanoseconds tick) noexcept;
  ~TickingClock();
  TickingClock(const TickingClock&) = delete;
  TickingClock& operator=(const TickingClock&) = delete;
  TickingClock(TickingClock&&) = delete;
  TickingClock& operator=(TickingClock&&) = delete;

  /// By this thread since construction. A test expects a number above zero, so that it fails where nothing is replaced.
  [[nodiscard]] std::int64_t reads() const noexcept;
};

}  // namespace depthgrid::test
