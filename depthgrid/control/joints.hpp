// Joint vectors and Jacobians that need no heap: of any size up to the largest robot.
#pragma once

#include <Eigen/Core>

namespace depthgrid::control {

/// Most joints of a robot.
inline constexpr int kMaxJoints = 16;
/// Most rows of one task: three for a point, six for a pose.
inline constexpr int kMaxTaskRows = 6;

/// One number a joint: radians (metres for sliding joints), or these per second.
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::DontAlign, kMaxJoints, 1>;
/// 3 x n: velocity of a point of the robot in the world frame, m/s for every rad/s of each joint.
using PointJacobian = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::DontAlign, 3, kMaxJoints>;
/// m x n, m <= kMaxTaskRows.
using TaskJacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::DontAlign, kMaxTaskRows, kMaxJoints>;
/// One number a row of a task.
using TaskVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::DontAlign, kMaxTaskRows, 1>;

}  // namespace depthgrid::control
