#include "depthgrid/sensors/clock.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

namespace depthgrid::sensors {

using Steady = std::chrono::steady_clock;

namespace {
constexpr std::int64_t kSecond_ns = 1'000'000'000;
}

double clock_now_s() noexcept { return std::chrono::duration<double>(Steady::now().time_since_epoch()).count(); }

std::int64_t nanoseconds_of(double time_s) noexcept {
  constexpr double kLongest_s = 6e9;
  if (!(std::abs(time_s) < kLongest_s)) {
    return 0;
  }
  const double whole_s = std::floor(time_s);  // the difference is exact
  return static_cast<std::int64_t>(whole_s) * kSecond_ns + std::llround((time_s - whole_s) * 1e9);
}

double seconds_of(std::int64_t time_ns) noexcept {
  const std::int64_t whole_s = time_ns / kSecond_ns;
  return static_cast<double>(whole_s) + static_cast<double>(time_ns % kSecond_ns) * 1e-9;
}

bool wait_until(double time_s, double longest_s) noexcept {
  const double wait_s = std::min(time_s - clock_now_s(), longest_s);
  if (wait_s > 0) {
    std::this_thread::sleep_for(std::chrono::duration<double>(wait_s));
  }
  return clock_now_s() >= time_s;
}

}  // namespace depthgrid::sensors
