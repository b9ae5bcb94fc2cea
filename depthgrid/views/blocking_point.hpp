// Whether a point lies in or beside what a camera has not seen free: what ends a search. Internal.
#pragma once

#include <Eigen/Core>

#include "depthgrid/views/local_camera.hpp"

namespace depthgrid::views {

/// Whether x, in front of the camera (z > 0), lies in its image. Metres, camera frame.
[[nodiscard]] bool projects_inside(const PinholeCamera& camera, const Eigen::Vector3d& x_camera) noexcept;

/// x lies in the camera's not known free set, or its pixel or one of the two beside it has some of that set within
/// slack and pose error at x. The double-precision form of what the cube split hints at.
[[nodiscard]] bool blocks(const LocalCamera& camera, const Eigen::Vector3d& x_local, double slack_m) noexcept;

}  // namespace depthgrid::views
