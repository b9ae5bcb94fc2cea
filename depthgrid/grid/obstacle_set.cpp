#include "depthgrid/grid/obstacle_set.hpp"

namespace depthgrid::grid {

Eigen::Vector3d ObstacleSet::mean_direction() const noexcept {
  return count_ == 0 ? Eigen::Vector3d::Zero().eval() : (direction_sum_ / static_cast<double>(count_)).eval();
}

Eigen::Vector3d ObstacleSet::led_direction(double b) const noexcept {
  if (!found_) {
    return Eigen::Vector3d::Zero();
  }
  const Eigen::Vector3d& n = nearest_.direction_camera;
  if (!(weight_sum_ > 0)) {
    return n;
  }
  return depthgrid::led_direction(n, direction_sum_ / weight_sum_, b);
}

}  // namespace depthgrid::grid
