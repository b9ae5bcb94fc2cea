#include "depthgrid/sensors/clock.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

namespace depthgrid::sensors {

using Steady = std::chrono::steady_clock;

double clock_now_s() noexcept { return std::chrono::duration<double>(Steady::now().time_since_epoch()).count(); }

bool wait_until(double time_s, double longest_s) noexcept {
  const double wait_s = std::min(time_s - clock_now_s(), longest_s);
  if (wait_s > 0) {
    std::this_thread::sleep_for(std::chrono::duration<double>(wait_s));
  }
  return clock_now_s() >= time_s;
}

}  // namespace depthgrid::sensors
