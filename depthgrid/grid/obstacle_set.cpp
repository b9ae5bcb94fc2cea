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
  const Eigen::Vector3d mean = direction_sum_ / weight_sum_;
  const Eigen::Vector3d led = n + b * (mean - mean.dot(n) * n);
  const double length = led.norm();
  return length > 0 ? (led / length).eval() : n;
}

}  // namespace depthgrid::grid
