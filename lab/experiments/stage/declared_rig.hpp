// What is declared of a sensor for the search with a memory: smallest obstacle, second view, exposure, padding.
#pragma once

#include <string_view>

#include "depthgrid/core/rig.hpp"

namespace depthgrid::experiments {

inline constexpr double kSimulatedHalfExposure_s = 0.008;  ///< declared; the simulated exposure takes no time

/// The rig with the recommended smallest obstacle of each camera's sensor, its second view (images are the sensor's
/// own), and an exposure of 16 ms. Throws Error when a camera names no sensor model or has no margins.
[[nodiscard]] Rig with_declarations(Rig rig);

/// Around the robot where the sensor's margin is in the test, metres. A voxel beside a link is ruled out only with a
/// ball of 0.87 of its side and half an exposure's motion, 4 cm, around it, and a hole counts as nearer by half the
/// smallest obstacle: 5 cm. Twice that for a D4xx, whose holes are everywhere. With less, what may be there creeps
/// along the links.
[[nodiscard]] double thin_padding_m(std::string_view sensor);

}  // namespace depthgrid::experiments
