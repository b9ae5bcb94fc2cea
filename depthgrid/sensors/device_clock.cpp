#include "depthgrid/sensors/device_clock.hpp"

#include <algorithm>

#include "depthgrid/core/error.hpp"

namespace depthgrid::sensors {

double lag_or_refuse(const ArrivalTimes& times, std::string_view stamps) {
  constexpr double kRounding_s = 1e-9;  // of the sum of two decimal numbers
  const double lag_s = times.lag_s.value_or(0);
  if (!(lag_s + times.time_uncertainty_s >= kLongestArrival_s - kRounding_s)) {
    fail(stamps, ", up to ", kLongestArrival_s,
         " s after the exposure, so they look newer than they are: arrival_lag_s, the most that an image needs until "
         "it is stamped, and margins: {time_uncertainty_s} must be ",
         kLongestArrival_s, " together; the cell says ", lag_s, " and ", times.time_uncertainty_s);
  }
  return lag_s;
}

double DeviceClock::clock_s(double device_s, double arrival_s) noexcept {
  if (device_s < last_device_s_ || images_ == 0) {  // the device has begun anew
    images_ = 0;
    half_began_s_ = arrival_s;
    least_before_s_ = std::numeric_limits<double>::infinity();
    least_s_ = least_before_s_;
  }
  last_device_s_ = device_s;
  ++images_;
  if (arrival_s - half_began_s_ > kHalfWindow_s) {
    half_began_s_ = arrival_s;
    least_before_s_ = least_s_;
    least_s_ = std::numeric_limits<double>::infinity();
  }
  least_s_ = std::min(least_s_, arrival_s - device_s);
  return device_s + std::min(least_before_s_, least_s_) - lag_s_;
}

std::int64_t Unwrapped32::next(std::uint32_t value) noexcept {
  // The difference as a signed number: a step back stays one.
  whole_ = has_value_ ? whole_ + static_cast<std::int32_t>(value - last_) : static_cast<std::int64_t>(value);
  has_value_ = true;
  last_ = value;
  return whole_;
}

}  // namespace depthgrid::sensors
