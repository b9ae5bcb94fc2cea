// What is known of the pixels of an octree cube's children before they are looked up. Internal.
#pragma once

#include <cstdint>

#include "depthgrid/views/cube.hpp"
#include "depthgrid/views/local_camera.hpp"

namespace depthgrid::views {

struct PixelBounds {
  /// Pixels between the first and the last that any child projects to, at most.
  std::uint32_t widest_px = 0;
  bool islands = false;  ///< whether there may be some of the robot's islands among them
};

/// Of all children of this cube, half_m half a side. In scalar arithmetic from the parent alone, because what it
/// decides must not depend on how many children an instruction set looks at at once.
[[nodiscard]] PixelBounds pixel_bounds(const LocalCamera& camera, const Cube& parent, float half_m) noexcept;

}  // namespace depthgrid::views
