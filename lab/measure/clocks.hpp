// Clocks of measurements. Processor time is what a thread has spent computing: other programs do not stretch it as they
// do the time on the wall.
#pragma once

#include <chrono>
#include <ctime>

namespace depthgrid::lab {

[[nodiscard]] inline double clock_s(clockid_t clock) noexcept {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Seconds since some fixed moment: of this thread, of all threads of the process.
[[nodiscard]] inline double processor_time_s() noexcept { return clock_s(CLOCK_THREAD_CPUTIME_ID); }
[[nodiscard]] inline double process_time_s() noexcept { return clock_s(CLOCK_PROCESS_CPUTIME_ID); }

/// Processor time of a call.
template <class Call>
[[nodiscard]] double timed_s(Call&& call) {
  const double start_s = processor_time_s();
  call();
  return processor_time_s() - start_s;
}

/// Wall clock since construction.
class Stopwatch {
 public:
  [[nodiscard]] double elapsed_s() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace depthgrid::lab
