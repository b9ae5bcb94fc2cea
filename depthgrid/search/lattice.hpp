// The cubes that the space of interest is divided into. Internal.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "depthgrid/views/cube.hpp"
#include "depthgrid/views/view_store.hpp"

namespace depthgrid::search {

using views::Cube;

/// An octree over W that is the same for every question to a snapshot. The root, level 0, holds all of W around its
/// middle; each level halves the side. Sides have few binary digits, so that centres are exact and cubes leave no gaps.
struct Lattice {
  static constexpr std::size_t kLevels = 32;

  explicit Lattice(const views::Snapshot& snapshot) noexcept;
  Lattice() = default;

  [[nodiscard]] float half_side_m(int level) const noexcept { return half_m[static_cast<std::size_t>(level)]; }

  Eigen::Vector3d origin_world = Eigen::Vector3d::Zero();
  double extent_m = 0;  ///< nothing of the root is farther from the origin
  std::array<float, kLevels> half_m{};
  int leaf_level = 0;   ///< cubes of this level are not split any further
  int last_level = 0;   ///< but where the border of a frustum W runs through one it is split down to this level
  int exact_level = 0;  ///< from this level on a ball is tested too, not only a box, because of the cameras' pose error
  double largest_rate = 0;  ///< of the cameras' pose error with range
};

}  // namespace depthgrid::search
