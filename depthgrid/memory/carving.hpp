// What one camera has seen free cannot be occupied: it leaves the set of what may be. Internal.
#pragma once

#include <cstdint>

#include "depthgrid/memory/free_maxima.hpp"
#include "depthgrid/memory/possible_space.hpp"
#include "depthgrid/views/cube.hpp"
#include "depthgrid/views/local_camera.hpp"

namespace depthgrid::memory {

/// One camera's image as it carves, relative to the middle of the region.
struct Carver {
  views::LocalCamera camera;
  Eigen::Vector3d origin_world = Eigen::Vector3d::Zero();
  const FreeMaxima* maxima = nullptr;
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
/// The image must be in `maxima`.
[[nodiscard]] Carver make_carver(const views::Snapshot& snapshot, std::size_t camera, double late_s,
                                 const FreeMaxima& maxima, const PossibleSpace& space,
                                 double thinnest_hidden_m) noexcept;

/// Takes out every voxel whose ball is free to the camera, and no other: exactly, up to about 1e-9 m. Returns how many.
std::int64_t carve(const Carver& carver, VoxelSet& voxels) noexcept;

/// Of the eight children of a cube, which are wholly free, and which have to be split to know. Bit i: child i.
struct ChildrenSeen {
  std::uint32_t free = 0;
  std::uint32_t undecided = 0;
};

/// Children are boxes around the centres of voxels, half_m half a side, whose centres are offset_m from the parent's
/// along each axis. Only those in `asked`. What it decides is the same with every instruction set once cubes are split
/// down to voxels.
[[nodiscard]] ChildrenSeen look_at_children(const Carver& carver, const views::Cube& parent, float offset_m,
                                            float half_m, std::uint32_t asked) noexcept;

}  // namespace depthgrid::memory
