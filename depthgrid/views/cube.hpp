// A cube of an octree over the space that cameras look at. Internal.
#pragma once

#include <cstdint>

namespace depthgrid::views {

/// A cube of the lattice, relative to its origin, metres.
struct Cube {
  float x, y, z;  ///< centre
  std::int32_t level;
};

}  // namespace depthgrid::views
