// The passes over a new image, with the widest instructions of the machine at hand. Internal.
//
// Row by row, so that every pass finds its rows in the nearest cache. D - m(D) grows with D (Reading::ascending says
// so), so the minimum over a neighbourhood may be taken of 16-bit values and converted afterwards: the same bits with
// half the bytes. Where the robot's exits come in, in images of floats, and for margins that do not ascend, all passes
// are done in single precision. All instruction sets give the same bits: no fused multiply-add anywhere.
#pragma once

#include "depthgrid/core/frame.hpp"
#include "depthgrid/views/preparation_rows.hpp"
#include "depthgrid/views/prepared_image.hpp"
#include "depthgrid/views/reading.hpp"

namespace depthgrid::views {

/// What is read.
struct NewImage {
  DepthView depth;     ///< with its stride
  RobotView robot;     ///< with its stride
  DepthView measured;  ///< as `depth`, but as the camera gave it: what differs is no reading, but what a hole counts as
  int radius_px = 0;   ///< w
  float pocket_m = 0;  ///< ignored beyond the robot's exit, rounded towards zero
  float blind_m = 0;   ///< where the blind zone ends, rounded up
};

/// Writes everything but the second interval's pyramids and the bands. Before, the island images and columns hold
/// "none" everywhere if there is a robot. Returns the rows that have islands.
PixelRange prepare(const Reading& reading, const NewImage& image, PreparationRows& rows,
                   PreparedImage& result) noexcept;

}  // namespace depthgrid::views
