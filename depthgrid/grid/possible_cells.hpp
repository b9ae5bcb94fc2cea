// Which cells of the depth grid may hold anything by a memory. Internal.
#pragma once

#include "depthgrid/core/pixel_frustum.hpp"
#include "depthgrid/core/pose.hpp"
#include "depthgrid/memory/memory_store.hpp"

namespace depthgrid::grid {

/// One state of a memory, asked about cells in the principal camera's frame at one time.
class PossibleCells {
 public:
  /// At the time t_ref_s, of the images that the grid's cells are freed by. Without a time the memory says nothing.
  PossibleCells(memory::MemorySnapshot memory, double t_ref_s, const Pose& T_world_principal) noexcept;

  /// False only if nothing can be in the cell: its box along the world's axes is out of the memory's reach.
  [[nodiscard]] bool may_hold(const PixelFrustum& cell) const noexcept;

 private:
  memory::MemorySnapshot memory_;
  double reach_m_;
  const Pose& T_world_principal_;
};

}  // namespace depthgrid::grid
