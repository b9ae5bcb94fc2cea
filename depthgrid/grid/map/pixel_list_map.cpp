#include "depthgrid/grid/map/pixel_list_map.hpp"

#include <utility>

#include "depthgrid/core/error.hpp"

namespace depthgrid::grid {
namespace {

// Walks the tables once. Cells and spans must follow each other without a gap, so the walk is linear whatever they
// hold.
class Checker {
 public:
  explicit Checker(const PixelListMap::Tables& tables) : tables_(tables) {}

  void ray(const PixelListMap::RayHeader& header, int depth_count, const PinholeCamera& camera, std::size_t k) {
    if (header.cell_begin != cell_ || header.row_begin != row_ || header.unused != 0) {
      fail("pixel-list map: a ray begins at cell ", header.cell_begin, " and span ", header.row_begin,
           ", must follow the ray before it at cell ", cell_, " and span ", row_);
    }
    if (header.n_first + header.n_count > depth_count || header.n_count > tables_.cells.size() - cell_) {
      fail("pixel-list map: a ray has cells ", header.n_first, " to ", header.n_first + header.n_count, " of ",
           depth_count, " with ", tables_.cells.size() - cell_, " left in the table, must lie within both");
    }
    for (const std::uint64_t end = cell_ + header.n_count; cell_ != end; ++cell_) {
      cell(tables_.cells[cell_], header, camera, k);
    }
  }

  void finish() const {
    if (cell_ != tables_.cells.size() || row_ != tables_.rows.size()) {
      fail("pixel-list map: rays use ", cell_, " cells and ", row_, " spans, the tables have ", tables_.cells.size(),
           " and ", tables_.rows.size());
    }
  }

 private:
  void cell(const PixelListMap::Cell& cell, const PixelListMap::RayHeader& header, const PinholeCamera& camera,
            std::size_t k) {
    if (header.row_begin + cell.row_offset != row_ || cell.row_count > tables_.rows.size() - row_) {
      fail("pixel-list map: cell ", cell_, " has ", cell.row_count, " spans from ", header.row_begin + cell.row_offset,
           " on, must begin at ", row_, " and end within the table of ", tables_.rows.size());
    }
    if (cell.row_count == 0) {
      return;
    }
    if (cell.v_first_px + cell.row_count > camera.height_px || !(cell.d_start_m > 0)) {
      fail("pixel-list map: cell ", cell_, " covers rows ", cell.v_first_px, " to ", cell.v_first_px + cell.row_count,
           " with d_start ", cell.d_start_m, " m, must lie in the ", camera.height_px, " rows of secondary camera ", k,
           " with d_start above 0");
    }
    for (const std::uint64_t end = row_ + cell.row_count; row_ != end; ++row_) {
      const PixelListMap::RowSpan& span = tables_.rows[row_];
      if (span.u_first_px > span.u_last_px || span.u_last_px >= camera.width_px) {
        fail("pixel-list map: cell ", cell_, " has pixels ", span.u_first_px, " to ", span.u_last_px,
             " of a row, must be in order and below the width ", camera.width_px, " of secondary camera ", k);
      }
    }
  }

  const PixelListMap::Tables& tables_;
  std::uint64_t cell_ = 0;
  std::uint64_t row_ = 0;
};

}  // namespace

PixelListMap::PixelListMap(MapCalibration calibration, const Tables& tables, std::shared_ptr<const void> owner)
    : calibration_(std::move(calibration)), tables_(tables), owner_(std::move(owner)) {
  validate(calibration_, "pixel-list map");
  const std::uint64_t rays = ray_count(calibration_);
  if (tables.rays.size() != rays * calibration_.secondaries.size()) {
    fail("pixel-list map: table has ", tables.rays.size(), " rays, the calibration asks for ",
         rays * calibration_.secondaries.size());
  }
  Checker checker(tables_);
  for (std::size_t k = 0; k < calibration_.secondaries.size(); ++k) {
    const PinholeCamera& camera = calibration_.secondaries[k].camera;
    for (const RayHeader& header : tables.rays.subspan(k * rays, rays)) {
      checker.ray(header, calibration_.quantisation.count, camera, k);
    }
    widths_px_.push_back(camera.width_px);
  }
  checker.finish();
  principal_width_ = static_cast<std::size_t>(calibration_.principal.width_px);
  principal_height_ = static_cast<std::size_t>(calibration_.principal.height_px);
}

}  // namespace depthgrid::grid
