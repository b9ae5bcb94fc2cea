#include "depthgrid/sensors/ros2_clock.hpp"

#include <cmath>

#include "depthgrid/sensors/system_clock.hpp"

namespace depthgrid::sensors {

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
