#include "depthgrid/search/axis_distance.hpp"

namespace depthgrid::search {

AxisToBox nearest(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& low,
                  const Eigen::Vector3d& high) noexcept {
  const Eigen::Vector3d along = b - a;
  const auto at = [&](double t) {
    AxisToBox result;
    result.on_axis = a + t * along;
    result.in_box = result.on_axis.cwiseMax(low).cwiseMin(high);
    result.distance_m = (result.in_box - result.on_axis).norm();
    return result;
  };
  if (along.squaredNorm() == 0) {
    return at(0);
  }
  // Half the derivative of the squared distance; continuous and never falling.
  const auto slope = [&](double t) {
    const Eigen::Vector3d p = a + t * along;
    return (p - p.cwiseMax(low).cwiseMin(high)).dot(along);
  };
  // The minimum lies between the last breakpoint where the slope is negative and the first where it is not.
  double before = 0;
  double slope_before = slope(0);
  if (slope_before >= 0) {
    return at(0);
  }
  double after = 1;
  double slope_after = slope(1);
  if (slope_after <= 0) {
    return at(1);
  }
  for (int i = 0; i < 3; ++i) {
    if (along(i) == 0) {
      continue;
    }
    for (const double border : {low(i), high(i)}) {
      const double t = (border - a(i)) / along(i);
      if (!(t > before && t < after)) {
        continue;
      }
      const double here = slope(t);
      (here < 0 ? before : after) = t;
      (here < 0 ? slope_before : slope_after) = here;
    }
  }
  return at(before + (after - before) * (-slope_before) / (slope_after - slope_before));
}

}  // namespace depthgrid::search
