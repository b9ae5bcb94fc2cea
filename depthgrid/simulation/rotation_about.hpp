// The matrix of a rotation about an axis, for the bodies of the cell. Internal.
#pragma once

#include <Eigen/Geometry>

namespace depthgrid::simulation {

/// `axis` is a unit vector.
inline Eigen::Matrix3d about(double angle_rad, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(angle_rad, axis).toRotationMatrix();
}

}  // namespace depthgrid::simulation
