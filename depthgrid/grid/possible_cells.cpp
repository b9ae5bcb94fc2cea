#include "depthgrid/grid/possible_cells.hpp"

#include <cmath>
#include <utility>

#include "depthgrid/memory/voxel_set.hpp"

namespace depthgrid::grid {

PossibleCells::PossibleCells(memory::MemorySnapshot memory, double t_ref_s, const Pose& T_world_principal) noexcept
    : memory_(std::move(memory)), reach_m_(memory_.reach_m(t_ref_s)), T_world_principal_(T_world_principal) {}

bool PossibleCells::may_hold(const PixelFrustum& cell) const noexcept {
  if (!std::isfinite(reach_m_)) {
    return true;
  }
  Eigen::AlignedBox3d box;
  for (int corner = 0; corner < 8; ++corner) {
    const double z_m = (corner & 1) != 0 ? cell.d2_m : cell.d1_m;
    const double x_m = ((corner & 2) != 0 ? cell.a1 : cell.a0) * z_m;
    const double y_m = ((corner & 4) != 0 ? cell.b1 : cell.b0) * z_m;
    box.extend(T_world_principal_ * Eigen::Vector3d(x_m, y_m, z_m));
  }
  return memory_.voxels().meets(box.min(), box.max(), reach_m_);
}

}  // namespace depthgrid::grid
