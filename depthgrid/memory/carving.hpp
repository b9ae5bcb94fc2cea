// What one camera has seen free cannot be occupied: it leaves the set of what may be. Internal.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "depthgrid/memory/blocking_pixels.hpp"
#include "depthgrid/memory/depth_planes.hpp"
#include "depthgrid/memory/possible_space.hpp"
#include "depthgrid/views/local_camera.hpp"

namespace depthgrid::memory {

/// One camera's image as it carves, relative to the middle of the region.
struct Carver {
  views::LocalCamera camera;
  Eigen::Vector3d origin_world = Eigen::Vector3d::Zero();
  const DepthPlanes* planes = nullptr;
  /// Of the ball around a voxel's centre that has to be free: reach_m + the camera's pose error in it.
  double reach_m = 0;
  float least_radius_m = 0;  ///< no such ball is smaller

  /// The ball's radius, around a point in the camera's frame.
  [[nodiscard]] double radius_m(const Eigen::Vector3d& p_camera) const noexcept {
    return reach_m + camera.pose_margin.translation_m + camera.pose_margin.time_m +
           camera.pose_margin.rotation_rad * (p_camera.norm() + reach_m);
  }
};

/// How far around a voxel's centre everything has to be seen free before nothing can be left that the voxel stands for:
/// half its diagonal and what is pending, less half the smallest hidden thing.
[[nodiscard]] double reach_around_centre_m(const PossibleSpace& space, double thinnest_hidden_m) noexcept;

/// Of a snapshot that has to be held. `late_s`: how long before the space's time the image was exposed, 0 or more.
/// The image must be in `planes`.
[[nodiscard]] Carver make_carver(const views::Snapshot& snapshot, std::size_t camera, double late_s,
                                 const DepthPlanes& planes, const PossibleSpace& space,
                                 double thinnest_hidden_m) noexcept;

/// Takes out every voxel whose ball is free to the camera, and no other: exactly, up to about 1e-9 m. Returns how many.
/// `blocking`: of this camera and this region.
std::int64_t carve(const Carver& carver, BlockingPixels& blocking, VoxelSet& voxels) noexcept;

/// A row of blocks of voxels along x, and the middle of the first, relative to the carver's origin.
struct BlockRow {
  float x_m, y_m, z_m;
  float voxel_m;
  std::size_t count;
  Block* voxels;           ///< of each block; what is free is taken out
  Block* open;             ///< written: which of those that are left need the exact test
  std::int16_t* blocking;  ///< see BlockingPixels, of the first block on
};

/// Takes out what is free as far as single precision tells. Returns how many voxels. What is free after the exact test
/// of those that are left open is the same with every instruction set.
std::int64_t see_row(const Carver& carver, const BlockRow& row) noexcept;

}  // namespace depthgrid::memory
