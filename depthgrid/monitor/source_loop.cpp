#include "depthgrid/monitor/source_loop.hpp"

#include <algorithm>

#include "depthgrid/sensors/clock.hpp"

namespace depthgrid::monitor {

double Backoff::next_s() noexcept {
  const double now_s = wait_s_;
  wait_s_ = std::min(2 * wait_s_, kLongest_s);
  return now_s;
}

void wait_s(double seconds, const std::stop_token& stop) noexcept {
  const double end_s = sensors::clock_now_s() + seconds;
  while (!stop.stop_requested() && !sensors::wait_until(end_s, kSourceSlice_s)) {
  }
}

}  // namespace depthgrid::monitor
