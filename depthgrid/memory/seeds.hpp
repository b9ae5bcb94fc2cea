// A measured surface counts, whatever the memory says. Internal.
#pragma once

#include <cstdint>
#include <vector>

#include "depthgrid/memory/possible_space.hpp"
#include "depthgrid/memory/readings_outside.hpp"
#include "depthgrid/views/view_store.hpp"

namespace depthgrid::memory {

/// Share of the readings that a voxel could have which make it count.
inline constexpr double kSeedShare = 0.3;
/// And how many it has to have at least: single pixels err.
inline constexpr int kFewestReadings = 2;

/// What put_back() writes into, allocated once. The capacity of `readings` bounds how many count.
struct SeedScratch {
  std::vector<std::uint64_t> readings;
  DepthImage row_m;                    ///< as wide as the widest image
  std::vector<ReadingOutside> in_row;  ///< as many as it has pixels
};

struct Seeded {
  std::int64_t voxels = 0;      ///< put back
  std::int64_t impossible = 0;  ///< of these, how many hold a surface that the memory had not within its reach
  Eigen::Vector3d impossible_at_world = Eigen::Vector3d::Zero();  ///< the middle of one of them
};

/// Which readings of an image are looked at: every n-th row and column, so that the voxel of the region that is
/// farthest from the camera could have four of them and more.
[[nodiscard]] int seed_stride_px(const PinholeCamera& camera, const Pose& T_world_camera,
                                 const VoxelSet& voxels) noexcept;

/// Puts voxels back that are not in the set but hold enough of one image's readings: at least kFewestReadings and
/// kSeedShare of what a square of a voxel's side that faces the camera would have. Not where one of these readings lies
/// in what the image shows free (the robot), or where another camera of the snapshot frees the whole voxel, its age
/// counted. What is impossible about it is an assumption that was broken: v_max, a clock, a calibration, or something
/// that was dropped. `scratch`: its capacity bounds how many readings count; not allocated here.
[[nodiscard]] Seeded put_back(const views::Snapshot& snapshot, std::size_t camera, double thinnest_hidden_m,
                              PossibleSpace& space, SeedScratch& scratch) noexcept;

}  // namespace depthgrid::memory
