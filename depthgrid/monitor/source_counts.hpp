// What a running cell counts of each source.
#pragma once

#include <cstdint>

namespace depthgrid::monitor {

/// Of one camera, or of the joints, so far.
struct SourceCounts {
  std::int64_t taken = 0;    ///< images, or joint states, that were used
  std::int64_t skipped = 0;  ///< passed over by the source, since newer ones were there
  std::int64_t refused = 0;  ///< of another time, out of order, doubled, frozen, or not usable
  std::int64_t dropped = 0;  ///< there was no room for them
  std::int64_t opened = 0;
  std::int64_t failures = 0;
};

}  // namespace depthgrid::monitor
