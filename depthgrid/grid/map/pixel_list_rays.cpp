#include "depthgrid/grid/map/pixel_list_rays.hpp"

#include <algorithm>

namespace depthgrid::grid {

PixelListRays::PixelListRays(const DepthGrid& grid, const SecondaryCamera& secondary, const ClosedFormMap& closed_form,
                             std::size_t k)
    : grid_(grid), closed_form_(closed_form), k_(k), projector_(grid.principal(), secondary) {}

// The closed form rounds to single precision. Where that moves its pixel or d_start past the exact ones, the list gives
// way, so that it never denies what the closed form confirms.
bool PixelListRays::list(const ClosedFormMap::Ray& ray, int n) {
  const bool involved = projector_.project(grid_.boundary_m(n), grid_.boundary_m(n + 1), footprint_);
  CellPixel centre;
  if (!ray.pixel(n, centre)) {
    return involved;
  }
  footprint_.d_start_m = involved ? std::max(footprint_.d_start_m, centre.d_start_m) : centre.d_start_m;
  footprint_.include(centre.u_px, centre.v_px);
  return true;
}

RayExtent PixelListRays::count(int u, int v) {
  projector_.set_ray(u, v);
  const ClosedFormMap::Ray ray = closed_form_.ray(u, v, k_);
  RayExtent extent;
  for (int n = 0; n < grid_.count(); ++n) {
    if (list(ray, n)) {
      if (extent.n_count == 0) {
        extent.n_first = static_cast<std::uint16_t>(n);
      }
      extent.n_count = static_cast<std::uint16_t>(n - extent.n_first + 1);
      extent.row_count += footprint_.rows.size();
    }
  }
  return extent;
}

void PixelListRays::write(int u, int v, const PixelListMap::RayHeader& header, PixelListMap::Cell* cells,
                          PixelListMap::RowSpan* rows) {
  projector_.set_ray(u, v);
  const ClosedFormMap::Ray ray = closed_form_.ray(u, v, k_);
  std::uint32_t offset = 0;
  for (int i = 0; i < header.n_count; ++i) {
    PixelListMap::Cell& cell = cells[i];
    cell = {};
    cell.row_offset = offset;
    if (list(ray, header.n_first + i)) {
      cell.d_start_m = footprint_.d_start_m;
      cell.v_first_px = static_cast<std::uint16_t>(footprint_.v_first_px);
      cell.row_count = static_cast<std::uint16_t>(footprint_.rows.size());
      std::copy(footprint_.rows.begin(), footprint_.rows.end(), rows + offset);
      offset += cell.row_count;
    }
  }
}

}  // namespace depthgrid::grid
