// What tests of sources share: they wait for what a thread or a device of theirs brings.
#pragma once

#include "depthgrid/sensors/clock.hpp"
#include "depthgrid/sensors/source.hpp"

namespace depthgrid::sensors {

/// The next that is not "nothing"; "nothing" after 20 s without.
[[nodiscard]] inline Reading wait_for_reading(DepthSource& source, DepthReading& reading) {
  const double end_s = clock_now_s() + 20;
  Reading found = Reading::nothing;
  while (found == Reading::nothing && clock_now_s() < end_s) {
    found = source.next(reading, 0.05);
  }
  return found;
}

}  // namespace depthgrid::sensors
