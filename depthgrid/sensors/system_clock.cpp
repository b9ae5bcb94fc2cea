#include "depthgrid/sensors/system_clock.hpp"

#include <chrono>
#include <limits>

#include "depthgrid/sensors/clock.hpp"

namespace depthgrid::sensors {

double system_ahead_s() noexcept {
  // A thread may be put aside between the two clocks; the narrowest of a few tries counts, and of it the earlier
  // reading of ours.
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

}  // namespace depthgrid::sensors
