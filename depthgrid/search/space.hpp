// W, the space of interest: membership and distance to its border. Internal.
#pragma once

#include <Eigen/Core>

#include "depthgrid/views/view_store.hpp"

namespace depthgrid::search {

/// Nearest point of W's border from inside, and its distance; negative for a point outside W (then not a distance).
struct Border {
  double distance_m = 0;
  Eigen::Vector3d point_world;
};

/// From the point p to the border of the snapshot's W. World frame, metres.
[[nodiscard]] Border border_of_space(const views::Snapshot& snapshot, const Eigen::Vector3d& p_world) noexcept;

}  // namespace depthgrid::search
