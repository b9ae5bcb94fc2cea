#include "depthgrid/messages/standard.hpp"

#include <algorithm>
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

Time time_of_nanoseconds(std::int64_t time_ns) noexcept {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  const std::int64_t part_ns = ((time_ns % kSecond_ns) + kSecond_ns) % kSecond_ns;
  const std::int64_t whole = (time_ns - part_ns) / kSecond_ns;
  using Limits = std::numeric_limits<std::int32_t>;
  return {.sec = static_cast<std::int32_t>(std::clamp<std::int64_t>(whole, Limits::min(), Limits::max())),
          .nanosec = static_cast<std::uint32_t>(part_ns)};
}

}  // namespace depthgrid::messages
