#include "depthgrid/sensors/ros2_clock.hpp"

#include <chrono>
#include <cmath>
#include <limits>

#include "depthgrid/sensors/clock.hpp"

namespace depthgrid::sensors {
namespace {

/// Seconds by which the system's clock is ahead, never too few: stamps then look older rather than newer. A thread may
/// be put aside between the two clocks; the narrowest of a few tries counts, and of it the earlier reading of ours.
double system_ahead_s() noexcept {
  constexpr int kTries = 5;
  constexpr double kNarrow_s = 20e-6;
  double narrowest_s = std::numeric_limits<double>::infinity();
  double ahead_s = 0;
  for (int n = 0; n < kTries && narrowest_s > kNarrow_s; ++n) {
    const double before_s = clock_now_s();
    const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
    const double gap_s = clock_now_s() - before_s;
    if (gap_s < narrowest_s) {
      narrowest_s = gap_s;
      ahead_s = std::chrono::duration<double>(since_1970).count() - before_s;
    }
  }
  return ahead_s;
}

}  // namespace

double clock_time_s(const messages::Time& stamp) noexcept { return messages::seconds(stamp) - system_ahead_s(); }

messages::Time stamp_of(double time_s) noexcept {
  constexpr double kLast_s = 2147483647;
  const double since_1970_s = time_s + system_ahead_s();
  if (!(since_1970_s >= 0 && since_1970_s < kLast_s)) {
    return {};
  }
  const double whole_s = std::floor(since_1970_s);
  return {.sec = static_cast<std::int32_t>(whole_s),
          .nanosec = static_cast<std::uint32_t>((since_1970_s - whole_s) * 1e9)};
}

}  // namespace depthgrid::sensors
