// What is asked about cubes: everything of one snapshot, relative to the lattice's origin, metres. Internal.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "depthgrid/memory/memory_store.hpp"
#include "depthgrid/memory/voxel_set.hpp"
#include "depthgrid/search/lattice.hpp"
#include "depthgrid/views/local_camera.hpp"

namespace depthgrid::search {

using views::LocalCamera;

struct CubeQuery {
  Lattice lattice;
  std::array<LocalCamera, views::kMaxCameras> cameras;
  std::size_t camera_count = 0;
  /// In which cameras are asked; the last to which cubes were known free is first. Decides about time only.
  std::array<std::uint8_t, views::kMaxCameras> order{};

  bool boxed = false;  ///< W is a box
  Eigen::Vector3d space_low = Eigen::Vector3d::Zero();
  Eigen::Vector3d space_high = Eigen::Vector3d::Zero();
  std::array<float, 3> box_low{};  ///< the same, rounded outwards
  std::array<float, 3> box_high{};
  int principal = -1;  ///< W is this camera's view between these depths
  views::FrustumSpace frustum;
  float d_min_m = 0;  ///< its depths, rounded outwards
  float d_max_m = 0;
  bool uncovered_ignored = false;  ///< what no camera covers does not count
  /// Where something may be by the memory: within this reach of the set. Null: no memory, or one that says nothing.
  const memory::VoxelSet* possible = nullptr;
  double possible_reach_m = 0;
  double slack_m = 0;  ///< how near to a camera's not known free set the nearest point of an answer has to lie
};

/// Everything of `snapshot`, and of `memory` where there is one, for as long as they are held.
void make_query(const views::Snapshot& snapshot, const memory::MemorySnapshot* memory, CubeQuery& query) noexcept;

/// The cubes that `cube` is split into: bit i is set unless child i (bits of i: x, y, z) lies
/// outside W, is known free to a camera or, by the memory, cannot be occupied. Never clears the bit of a child that
/// holds a point of the obstacle set. Depends on the cube alone, not on the order of the cameras.
[[nodiscard]] std::uint32_t open_children(CubeQuery& query, const Cube& cube) noexcept;

}  // namespace depthgrid::search
