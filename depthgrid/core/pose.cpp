#include "depthgrid/core/pose.hpp"

#include <Eigen/SVD>
#include <cmath>

#include "depthgrid/core/error.hpp"

namespace depthgrid {

Pose pose_from_matrix(const Eigen::Matrix4d& matrix, const char* name) {
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      if (!std::isfinite(matrix(row, column))) {
        fail(name, ": entry (", row, ", ", column, ") is ", matrix(row, column), ", must be a finite number");
      }
    }
  }
  const Eigen::RowVector4d last(0, 0, 0, 1);
  if (matrix.row(3) != last) {
    fail(name, ": last row is (", matrix.row(3), "), must be (0 0 0 1); is the matrix transposed?");
  }
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  const double deviation = (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(deviation <= kRotationTolerance)) {
    constexpr double kRounding = 0.01;
    const double scale = std::cbrt(std::abs(rotation.determinant()));
    const Eigen::Matrix3d turn = scale > 0 ? Eigen::Matrix3d(rotation / scale) : rotation;
    const bool scaled = (turn.transpose() * turn - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < kRounding &&
                        std::abs(scale - 1) > kRounding;
    std::ostringstream hint;
    if (scaled) {
      hint << "; it is scaled by " << scale << ": divide its nine numbers by that";
    }
    fail(name, ": rotation deviates from orthonormal by ", deviation, ", must be at most ", kRotationTolerance,
         scaled ? hint.str() : "; with too few digits, or not a rotation?");
  }
  if (rotation.determinant() < 0) {
    fail(name, ": rotation has determinant ", rotation.determinant(),
         ", must be +1 (right-handed frames): one axis is turned round; where y is up in camera and world (ICL-NUIM), "
         "change "
         "the signs of the second row and of the second column, and of y in all points");
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(rotation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Pose pose = Pose::Identity();
  pose.linear() = svd.matrixU() * svd.matrixV().transpose();
  pose.translation() = matrix.topRightCorner<3, 1>();
  return pose;
}

Pose look_at(const Eigen::Vector3d& position_world, const Eigen::Vector3d& target_world,
             const Eigen::Vector3d& up_world) {
  const Eigen::Vector3d view = target_world - position_world;
  const Eigen::Vector3d side = view.cross(up_world);
  if (!(side.norm() > 1e-9 * view.norm() * up_world.norm()) || !(view.norm() > 0)) {
    fail("look_at: viewing direction (", view.transpose(), ") must be non-zero and not parallel to up (",
         up_world.transpose(), ")");
  }
  Pose pose = Pose::Identity();
  pose.linear().col(2) = view.normalized();
  pose.linear().col(0) = side.normalized();
  pose.linear().col(1) = pose.linear().col(2).cross(pose.linear().col(0));
  pose.translation() = position_world;
  return pose;
}

}  // namespace depthgrid
