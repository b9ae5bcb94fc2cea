// Which pixels a ball may meet in one camera's image: all that need an exact test, and few others. Internal.
#pragma once

#include "depthgrid/views/local_camera.hpp"

namespace depthgrid::views {

/// Pixels, inclusive.
struct Window {
  int u0, v0, u1, v1;
};

/// A ball in a camera's frame, metres; the window holds all pixels of the image that it projects to.
struct ScannedBall {
  float x_m, y_m, z_m;
  float radius_m;  ///< a little more than the ball's: covers single precision
  Window window;
};

/// Most columns or rows of a window that can be scanned.
inline constexpr int kMaxScanned = 256;

/// Whether scan() takes this window in this camera's image.
[[nodiscard]] bool can_scan(const LocalCamera& camera, const Window& window) noexcept;

/// Asks meets(context, u, v) about every pixel whose not known free depths the ball may meet, in no certain order,
/// until one answers true. Returns whether one did. The ball has to lie beyond the camera's blind zone. Which pixels
/// are asked about is up to the instruction set; the answer is not if meets() is exact.
[[nodiscard]] bool scan(const LocalCamera& camera, const ScannedBall& ball,
                        bool (*meets)(const void* context, int u, int v), const void* context) noexcept;

}  // namespace depthgrid::views
