#include "depthgrid/sensors/playback.hpp"

#include <cmath>

#include "depthgrid/core/error.hpp"
#include "depthgrid/sensors/clock.hpp"

namespace depthgrid::sensors {

Playback::Playback(double first_s, double last_s, bool repeat, Pace pace)
    : first_s_(first_s),
      round_s_(last_s - first_s + kPause_s),
      repeats_(repeat && pace == Pace::as_recorded),
      pace_(pace),
      begin_s_(clock_now_s()) {
  if (!(first_s <= last_s) || !std::isfinite(last_s - first_s)) {
    fail("playback: from ", first_s, " to ", last_s, " s, must not end before it begins");
  }
}

double Playback::clock_s(double recorded_s, std::int64_t round) const noexcept {
  return pace_ == Pace::as_recorded ? begin_s_ + recorded_s - first_s_ + static_cast<double>(round) * round_s_
                                    : recorded_s;
}

std::int64_t Playback::round_at(double clock_s) const noexcept {
  return repeats_ && clock_s > begin_s_ ? static_cast<std::int64_t>((clock_s - begin_s_) / round_s_) : 0;
}

}  // namespace depthgrid::sensors
