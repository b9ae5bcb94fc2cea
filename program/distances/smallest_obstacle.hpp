// Which size of obstacles the search assumes, camera by camera, and who says so.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "depthgrid/core/rig.hpp"

namespace depthgrid::program {

/// Declares `margins`' smallest obstacles, one a camera of the rig: `own_m` (--smallest-obstacle), else what they say
/// already (the rig file), else what the sensor model recommends (`sensor`: --sensor, else the rig file's), else 0.
/// Returns the line that tells the user.
[[nodiscard]] std::string declare_smallest_obstacles(std::optional<double> own_m,
                                                     const std::optional<std::string>& sensor, const Rig& rig,
                                                     std::vector<CameraMargins>& margins);

}  // namespace depthgrid::program
