// Map storage with full pixel lists: every pixel of a secondary camera on which any part of a cell projects.
//
// The projection of a cell is convex, so its pixels are one span in each image row: a list is a first row and a span
// (four bytes) a row, which takes about a third of the pixels written out one by one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "depthgrid/grid/closed_form_map.hpp"
#include "depthgrid/grid/map/map_calibration.hpp"

namespace depthgrid::grid {

/// Immutable and cheap to copy: copies share the table.
///
/// A camera confirms a cell when ANY pixel of the cell's list confirms it. The list contains the pixel of the closed
/// form wherever there is one, and d_start is never smaller than there: so wherever the closed form confirms, this
/// storage does too. It is also involved where the cell's centre projects outside the image but a part inside.
class PixelListMap {
 public:
  /// The cells of one ray that the camera monitors: n_first .. n_first + n_count - 1.
  struct RayHeader {
    std::uint64_t cell_begin = 0;  ///< index of the first of them
    std::uint64_t row_begin = 0;   ///< index of their first span
    std::uint16_t n_first = 0;
    std::uint16_t n_count = 0;
    std::uint32_t unused = 0;  ///< 0
  };
  struct Cell {
    float d_start_m = 0;
    std::uint32_t row_offset = 0;  ///< first span, counted from the ray's row_begin
    std::uint16_t v_first_px = 0;
    std::uint16_t row_count = 0;  ///< 0: not involved
  };
  /// Pixels u_first .. u_last of one image row, both included.
  struct RowSpan {
    std::uint16_t u_first_px = 0;
    std::uint16_t u_last_px = 0;
  };
  /// The table: rays in the order [camera][v][u], their cells by n, their spans by row, without gaps.
  struct Tables {
    std::span<const RayHeader> rays;
    std::span<const Cell> cells;
    std::span<const RowSpan> rows;
  };
  /// The pixels of one cell.
  struct List {
    int v_first_px = 0;
    float d_start_m = 0;
    std::span<const RowSpan> rows;
  };

  /// One principal pixel seen from one secondary camera.
  class Ray {
   public:
    /// The cell's pixels. False when the camera is not involved.
    [[nodiscard]] bool pixels(int n, List& result) const noexcept {
      const auto i = static_cast<unsigned>(n - n_first_);
      if (i >= n_count_ || cells_[i].row_count == 0) {
        return false;
      }
      const Cell& cell = cells_[i];
      result = {cell.v_first_px, cell.d_start_m, {rows_ + cell.row_offset, cell.row_count}};
      return true;
    }

    /// The letter's confirmation by this camera, by any pixel of the list; `depth_m` is its dense depth image (0 = no
    /// measurement).
    [[nodiscard]] Confirmation confirm(int n, const float* depth_m) const noexcept {
      List list;
      if (!pixels(n, list)) {
        return Confirmation::not_involved;
      }
      const float* row_m = depth_m + static_cast<std::ptrdiff_t>(list.v_first_px) * width_px_;
      for (const RowSpan& span : list.rows) {
        for (int u = span.u_first_px; u <= span.u_last_px; ++u) {
          if (grid::confirm(row_m[u], list.d_start_m) == Confirmation::confirmed) {
            return Confirmation::confirmed;
          }
        }
        row_m += width_px_;
      }
      return Confirmation::denied;
    }

   private:
    friend class PixelListMap;
    const Cell* cells_ = nullptr;
    const RowSpan* rows_ = nullptr;
    int n_first_ = 0;
    unsigned n_count_ = 0;
    int width_px_ = 0;
  };

  /// `owner` keeps the tables alive. Throws Error when they do not fit the calibration or each other, or a span leaves
  /// its camera's image, so that no content can lead a look-up astray.
  PixelListMap(MapCalibration calibration, const Tables& tables, std::shared_ptr<const void> owner);

  [[nodiscard]] std::size_t camera_count() const noexcept { return widths_px_.size(); }
  /// (u, v) is a pixel of the principal camera, k < camera_count(). The ray refers to this map.
  [[nodiscard]] Ray ray(int u, int v, std::size_t k) const noexcept {
    const RayHeader& header = tables_.rays[(k * principal_height_ + static_cast<std::size_t>(v)) * principal_width_ +
                                           static_cast<std::size_t>(u)];
    Ray ray;
    ray.cells_ = tables_.cells.data() + header.cell_begin;
    ray.rows_ = tables_.rows.data() + header.row_begin;
    ray.n_first_ = header.n_first;
    ray.n_count_ = header.n_count;
    ray.width_px_ = widths_px_[k];
    return ray;
  }

  [[nodiscard]] const MapCalibration& calibration() const noexcept { return calibration_; }
  [[nodiscard]] const Tables& tables() const noexcept { return tables_; }

 private:
  MapCalibration calibration_;
  Tables tables_;
  std::shared_ptr<const void> owner_;
  std::vector<int> widths_px_;  ///< of the secondary images
  std::size_t principal_width_ = 0, principal_height_ = 0;
};

}  // namespace depthgrid::grid
