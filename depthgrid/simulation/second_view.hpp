// What the second eye of a depth sensor cannot see: a pattern projector or the other imager of a stereo pair.
#pragma once

#include <cstdint>
#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/depth_image.hpp"

namespace depthgrid::simulation {

/// Sets hidden[pixel] to 1 where a second view, `baseline_m` to the right of the camera and otherwise like it, does not
/// see the surface that the camera sees: its image ends there (a band of fx b / z pixels at the left edge), or
/// something nearer stands before it (a strip of fx b (1 / z_near - 1 / z_far) pixels left of a left edge, never wider
/// than what casts it). Judged from the camera's own ideal image: what only the second view sees casts no shadow.
/// `hidden` has one element a pixel. Widths are exact to a pixel; shadows narrower than 1.5 pixels are left out.
void mark_hidden_from_second_view(const PinholeCamera& camera, const DepthImage& ideal_m, double baseline_m,
                                  std::vector<std::uint8_t>& hidden);

}  // namespace depthgrid::simulation
