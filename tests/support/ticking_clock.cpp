#include "support/ticking_clock.hpp"

#include <sys/syscall.h>
#include <time.h>  // NOLINT(modernize-deprecated-headers): clock_gettime is of POSIX
#include <unistd.h>

namespace {

thread_local std::int64_t tick_ns = 0;  // 0: the true clock
thread_local std::int64_t reads_of_this_thread = 0;
constexpr std::int64_t kBegin_ns = 1'000'000'000;

}  // namespace

// libstdc++ calls it by its name, so that of the program comes first.
extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
  if (clock != CLOCK_MONOTONIC || tick_ns == 0) {
    return static_cast<int>(syscall(SYS_clock_gettime, clock, time));
  }
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  const std::int64_t now_ns = kBegin_ns + reads_of_this_thread++ * tick_ns;
  time->tv_sec = now_ns / kSecond_ns;
  time->tv_nsec = now_ns % kSecond_ns;
  return 0;
}

namespace depthgrid::test {

TickingClock::TickingClock(std::chrono::nanoseconds tick) noexcept {
  reads_of_this_thread = 0;
  tick_ns = tick.count();
}

TickingClock::~TickingClock() { tick_ns = 0; }

// NOLINTNEXTLINE(readability-convert-member-functions-to-static): of this clock
std::int64_t TickingClock::reads() const noexcept { return reads_of_this_thread; }

}  // namespace depthgrid::test
