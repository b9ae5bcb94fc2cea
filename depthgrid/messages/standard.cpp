#include "depthgrid/messages/standard.hpp"

#include <cmath>
#include <limits>

#include "depthgrid/core/error.hpp"

namespace depthgrid::messages {

Time time_of(double time_s) {
  constexpr double kNanoseconds = 1e9;
  double whole = std::floor(time_s);
  double nanosec = std::round((time_s - whole) * kNanoseconds);  // the difference is exact
  if (nanosec >= kNanoseconds) {
    whole += 1;
    nanosec = 0;
  }
  if (!(whole >= std::numeric_limits<std::int32_t>::min() && whole <= std::numeric_limits<std::int32_t>::max())) {
    fail("a message cannot hold the time ", time_s, " s, must be a number from -2^31 to 2^31 - 1");
  }
  return {.sec = static_cast<std::int32_t>(whole), .nanosec = static_cast<std::uint32_t>(nanosec)};
}

}  // namespace depthgrid::messages
