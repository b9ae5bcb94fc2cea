#include "depthgrid/grid/map/one_pixel_map.hpp"

#include <utility>

#include "depthgrid/core/error.hpp"

namespace depthgrid::grid {
namespace {

bool well_formed(const OnePixelMap::Cell& cell, unsigned width_px, unsigned height_px) noexcept {
  if (cell.u_px == OnePixelMap::kNotInvolved) {
    return cell.v_px == OnePixelMap::kNotInvolved;
  }
  return cell.u_px < width_px && cell.v_px < height_px && cell.d_start_m > 0;
}

}  // namespace

OnePixelMap::OnePixelMap(MapCalibration calibration, std::span<const Cell> cells, std::shared_ptr<const void> owner)
    : calibration_(std::move(calibration)), cells_(cells), owner_(std::move(owner)) {
  validate(calibration_, "one-pixel map");
  const std::uint64_t cells_a_camera = cell_count(calibration_);
  if (cells.size() != cells_a_camera * calibration_.secondaries.size()) {
    fail("one-pixel map: table has ", cells.size(), " cells, the calibration asks for ",
         cells_a_camera * calibration_.secondaries.size());
  }
  const Cell* cell = cells.data();
  for (std::size_t k = 0; k < calibration_.secondaries.size(); ++k) {
    const PinholeCamera& camera = calibration_.secondaries[k].camera;
    const auto width_px = static_cast<unsigned>(camera.width_px);
    const auto height_px = static_cast<unsigned>(camera.height_px);
    for (const Cell* end = cell + cells_a_camera; cell != end; ++cell) {
      if (!well_formed(*cell, width_px, height_px)) {
        fail("one-pixel map: cell ", cell - cells.data(), " names pixel (", cell->u_px, ", ", cell->v_px,
             ") with d_start ", cell->d_start_m, " m, must lie in the ", width_px, " x ", height_px,
             " image of secondary camera ", k, " with d_start above 0");
      }
    }
    widths_px_.push_back(camera.width_px);
  }
  principal_width_ = static_cast<std::size_t>(calibration_.principal.width_px);
  principal_height_ = static_cast<std::size_t>(calibration_.principal.height_px);
  depth_count_ = static_cast<std::size_t>(calibration_.quantisation.count);
}

}  // namespace depthgrid::grid
