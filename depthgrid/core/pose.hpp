// Rigid transforms. T_A_B maps coordinates in frame B to frame A: p_A = T_A_B * p_B. Metres.
#pragma once

#include <Eigen/Geometry>

// Otherwise Eigen's objects would differ in layout between a program and the library: crashes instead of answers. What
// lies on the heap differs with -mavx all the same, so no installed header owns a matrix there without
// Eigen::DontAlign.
static_assert(EIGEN_MAX_ALIGN_BYTES == 16,
              "depthgrid is built with EIGEN_MAX_ALIGN_BYTES=16: compile with -DEIGEN_MAX_ALIGN_BYTES=16 as well, or "
              "without -mavx and -march=native (CMake's target depthgrid::core sets it)");
static_assert(alignof(Eigen::Isometry3d) == 16 && sizeof(Eigen::Isometry3d) == 128,
              "depthgrid is built with Eigen's own alignment of fixed sizes: compile without EIGEN_DONT_ALIGN, "
              "EIGEN_DONT_VECTORIZE and EIGEN_MAX_STATIC_ALIGN_BYTES");
static_assert(Eigen::Matrix4d::IsRowMajor == 0,
              "depthgrid is built with columns first: compile without EIGEN_DEFAULT_TO_ROW_MAJOR");

namespace depthgrid {

using Pose = Eigen::Isometry3d;

/// The largest deviation of any entry of R^T R from the identity that is still repaired.
inline constexpr double kRotationTolerance = 1e-3;

/// Builds T_A_B from a 4x4 homogeneous matrix in metres. The rotation is replaced by the nearest
/// orthonormal one if it deviates by at most kRotationTolerance. `name` is used in messages only.
/// Throws Error on a non-finite entry, a last row other than (0 0 0 1), a worse deviation or a reflection.
Pose pose_from_matrix(const Eigen::Matrix4d& matrix, const char* name = "pose");

/// Camera pose T_world_camera (x right, y down, z forward) of a camera at `position_world` that looks
/// at `target_world`, with the image's up direction as near to `up_world` as possible. Metres.
/// Throws Error when the viewing direction vanishes or is parallel to `up_world`.
Pose look_at(const Eigen::Vector3d& position_world, const Eigen::Vector3d& target_world,
             const Eigen::Vector3d& up_world = Eigen::Vector3d::UnitZ());

}  // namespace depthgrid
