// What else is known of a pixel without a reading. Internal.
#pragma once

#include <cstddef>

namespace depthgrid::views {

/// A pixel counts as no less than `least` and no more than `most`, whatever a hole there may say: values of the image's
/// own format, which a float holds exactly.
struct HoleBounds {
  std::size_t pixel = 0;  ///< row by row
  float least = 0;
  float most = 0;
};

}  // namespace depthgrid::views
