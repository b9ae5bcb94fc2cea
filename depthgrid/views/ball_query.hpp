// Exact: does a ball meet what one camera has not seen free? Internal.
#pragma once

#include <Eigen/Core>

#include "depthgrid/views/local_camera.hpp"

namespace depthgrid::views {

/// True when the closed ball of radius_m around p_camera meets the camera's not known free set less the robot's
/// islands, within `clip`: everything outside the view (unless clip.to_view), the blind zone, and each pixel's frustum
/// from its free depth on. Exact in double precision up to about 1e-9 m, on the side of `true`.
[[nodiscard]] bool meets_not_known_free(const LocalCamera& camera, const Clip& clip, const Eigen::Vector3d& p_camera,
                                        double radius_m) noexcept;

/// False only if the camera covers no point of the ball: its view from the end of the blind zone on, whatever it
/// measured.
[[nodiscard]] bool covers_some(const LocalCamera& camera, const Eigen::Vector3d& p_camera, double radius_m) noexcept;

}  // namespace depthgrid::views
