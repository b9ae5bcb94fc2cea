// One camera as one query sees it: relative to the query's origin, in the precision that each test needs. Internal.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/views/prepared_image.hpp"
#include "depthgrid/views/view_store.hpp"

namespace depthgrid::views {

/// What of space counts when a camera is asked whether it frees a set.
struct Clip {
  bool to_view = false;  ///< outside the image nothing counts; with it the depths below apply
  double d_min_m = 0;    ///< what is nearer does not count
  double d_max_m = 0;    ///< what is farther does not count
  float low_m = 0;       ///< d_min_m rounded down, but a little above 0
  float high_m = 0;      ///< d_max_m rounded up
};

/// The image itself (index 0) or a level of its pyramid, as a rectangle of pixels is looked up in it: at its first
/// pixel and `back` texels before its last, both shifted.
struct Texels {
  std::uint32_t offset = 0;  ///< into the pyramid; 0 for the image
  std::int32_t width = 0;
  std::int32_t shift = 0;
  std::int32_t back = 0;
};

/// Where a camera's view begins to count, however near it looks: by so little that even a ray that leaves nearly along
/// the camera's plane stands still, and by so much that its slope is a number.
inline constexpr float kFirstDepth_m = 1e-12F;

struct LocalCamera {
  static constexpr std::size_t kMaxTexels = 16;
  // Single precision: what the cube split reads. x_camera = rotation x_local + offset.
  std::array<float, 9> rotation{};  ///< row by row
  std::array<float, 9> absolute_rotation{};
  std::array<float, 3> offset_m{};
  float guard_m = 0;   ///< more than the rounding of x_camera for any cube of the query
  float guard_px = 0;  ///< more than the rounding of a projection inside the image
  float fx = 0, fy = 0, cx = 0, cy = 0;
  float width = 0, height = 0;
  float blind_m = 0;           ///< nothing up to this depth is free (a little above the blind zone's end)
  float pose_error_m = 0;      ///< e at the camera's centre
  float pose_error_per_m = 0;  ///< growth of e with the range
  const float* free_m = nullptr;
  const float* minima_m = nullptr;
  std::array<Texels, kMaxTexels> texels{};
  const PyramidLevel* levels = nullptr;
  int level_count = 0;
  int width_px = 0;
  bool has_pose_error = false;
  bool has_islands = false;
  /// What counts at all: the view between two depths where that is W. Only without pose error: with it a point near the
  /// border of the view is not known free, whatever counts beyond the border.
  Clip space;
  /// What the camera covers, as far as it counts.
  Clip coverage;

  // Double precision: what the exact tests read.
  Eigen::Matrix3d R_camera_world = Eigen::Matrix3d::Identity();
  Eigen::Vector3d offset_camera_m = Eigen::Vector3d::Zero();  ///< the query's origin in the camera frame
  PinholeCamera pinhole;
  double near_m = 0;
  PoseMargin pose_margin;
  const PreparedImage* image = nullptr;

  [[nodiscard]] Eigen::Vector3d to_camera(const Eigen::Vector3d& x_local) const noexcept {
    return R_camera_world * x_local + offset_camera_m;
  }
  /// e at a point, metres.
  [[nodiscard]] double pose_error(const Eigen::Vector3d& x_camera) const noexcept {
    return pose_margin.translation_m + pose_margin.time_m + pose_margin.rotation_rad * x_camera.norm();
  }
};

/// Everything of `snapshot` relative to origin_world, for points within extent_m of it.
void make_local(const Snapshot& snapshot, std::size_t camera, const Eigen::Vector3d& origin_world, double extent_m,
                LocalCamera& local) noexcept;

}  // namespace depthgrid::views
