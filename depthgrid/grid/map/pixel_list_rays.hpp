// The full pixel lists of one ray: what the builder counts, then writes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "depthgrid/grid/closed_form_map.hpp"
#include "depthgrid/grid/depth_grid.hpp"
#include "depthgrid/grid/map/cell_footprint.hpp"
#include "depthgrid/grid/map/pixel_list_map.hpp"

namespace depthgrid::grid {

/// Cells from the first to the last that a camera monitors on one ray, and their spans.
struct RayExtent {
  std::uint16_t n_first = 0;
  std::uint16_t n_count = 0;
  std::uint64_t row_count = 0;
};

/// Makes the lists of one secondary camera, ray by ray. One object a thread. The arguments of the constructor must
/// outlive it.
class PixelListRays {
 public:
  /// `k` is the camera's index in `closed_form`.
  PixelListRays(const DepthGrid& grid, const SecondaryCamera& secondary, const ClosedFormMap& closed_form,
                std::size_t k);

  [[nodiscard]] RayExtent count(int u, int v);

  /// Writes cells and spans of the ray; `header` has n_first and n_count as count() gave them.
  void write(int u, int v, const PixelListMap::RayHeader& header, PixelListMap::Cell* cells,
             PixelListMap::RowSpan* rows);

 private:
  bool list(const ClosedFormMap::Ray& ray, int n);

  const DepthGrid& grid_;
  const ClosedFormMap& closed_form_;
  std::size_t k_;
  CellProjector projector_;
  CellFootprint footprint_;
};

}  // namespace depthgrid::grid
