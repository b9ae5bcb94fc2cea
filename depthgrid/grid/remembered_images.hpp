// The images of a rig's cameras as a memory looks at them, beside the depth grid. Internal.
#pragma once

#include "depthgrid/core/proximity.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/grid/depth_grid.hpp"
#include "depthgrid/grid/evaluation.hpp"
#include "depthgrid/memory/memory_store.hpp"
#include "depthgrid/views/view_store.hpp"

namespace depthgrid::grid {

/// Threads: update() by one, past() by one and snapshots by any number meanwhile.
struct RememberedImages {
  /// Throws Error where the memory's settings or margins are not valid for the rig.
  RememberedImages(const Rig& rig, const GridMemory& memory, double rho_m);

  void update(std::size_t camera, const Frame& frame) noexcept;
  /// Of the cell that an answer's nearest point lies in or beside.
  [[nodiscard]] Past past(const Proximity& nearest, const DepthGrid& grid,
                          const Pose& T_world_principal) const noexcept;

  views::ViewStore images;
  memory::MemoryStore store;
};

}  // namespace depthgrid::grid
