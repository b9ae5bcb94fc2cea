// A picture that explains the blind layer: what is known free around a link, and a hand inside the layer and outside.
#pragma once

#include "lab/experiments/blind_layer/hand_beside.hpp"
#include "report/canvas.hpp"

namespace depthgrid::experiments {

/// Four sections through the last link: two paddings, a hand within the layer and one outside. `side_px`: questions
/// along each side of a section.
[[nodiscard]] report::Canvas draw_blind_layer(HandBeside& scene, int side_px);

}  // namespace depthgrid::experiments
