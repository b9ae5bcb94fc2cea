// Time that this thread has spent computing, which other programs do not stretch as they do the time on the wall.
#pragma once

#include <ctime>

namespace depthgrid::experiments {

/// Seconds since some fixed moment.
[[nodiscard]] inline double processor_time_s() noexcept {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace depthgrid::experiments
