// A rig with smaller or larger images.
#pragma once

#include "depthgrid/core/rig.hpp"

namespace depthgrid::experiments {

/// The same rig with images of another width, 4:3, and the same view. A camera with a sensor model gets that model's
/// margins for its new focal length, and only those: a stereo camera's grow as the focal length shrinks. `width_px` is
/// a multiple of 4. Throws Error on an unknown sensor.
[[nodiscard]] Rig with_width(Rig rig, int width_px);

}  // namespace depthgrid::experiments
