// Map storage with one pixel a cell: the pixel of a secondary camera that contains the projection of the cell's centre.
//
// The letter lists all pixels that a cell projects on and then uses one; this table holds just that one, in eight
// bytes a cell and secondary camera.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "depthgrid/grid/closed_form_map.hpp"
#include "depthgrid/grid/map/map_calibration.hpp"

namespace depthgrid::grid {

/// Immutable and cheap to copy: copies share the table. Its answers are those of ClosedFormMap, bit for bit.
class OnePixelMap {
 public:
  /// As it lies in memory and in map files. kNotInvolved never leaves this class.
  struct Cell {
    std::uint16_t u_px = 0;
    std::uint16_t v_px = 0;
    float d_start_m = 0;
  };
  static constexpr std::uint16_t kNotInvolved = 0xFFFF;  ///< u_px and v_px of a cell that the camera does not monitor

  /// One principal pixel seen from one secondary camera.
  class Ray {
   public:
    /// As ClosedFormMap::Ray::pixel().
    [[nodiscard]] bool pixel(int n, CellPixel& result) const noexcept {
      const Cell& cell = cells_[n];
      if (cell.u_px == kNotInvolved) {
        return false;
      }
      result = {cell.u_px, cell.v_px, cell.d_start_m};
      return true;
    }

    /// The letter's confirmation by this camera; `depth_m` is its dense depth image (0 = no measurement).
    [[nodiscard]] Confirmation confirm(int n, const float* depth_m) const noexcept {
      const Cell& cell = cells_[n];
      if (cell.u_px == kNotInvolved) {
        return Confirmation::not_involved;
      }
      return grid::confirm(depth_m[static_cast<int>(cell.v_px) * width_px_ + static_cast<int>(cell.u_px)],
                           cell.d_start_m);
    }

   private:
    friend class OnePixelMap;
    const Cell* cells_ = nullptr;
    int width_px_ = 0;
  };

  /// `cells` in the order [camera][v][u][n]; `owner` keeps them alive. Throws Error when their number does not fit the
  /// calibration or a cell names a pixel outside its camera's image, so that no content can lead a look-up astray.
  OnePixelMap(MapCalibration calibration, std::span<const Cell> cells, std::shared_ptr<const void> owner);

  [[nodiscard]] std::size_t camera_count() const noexcept { return widths_px_.size(); }
  /// (u, v) is a pixel of the principal camera, k < camera_count(). The ray refers to this map.
  [[nodiscard]] Ray ray(int u, int v, std::size_t k) const noexcept {
    Ray ray;
    ray.cells_ = cells_.data() + ((k * principal_height_ + static_cast<std::size_t>(v)) * principal_width_ +
                                  static_cast<std::size_t>(u)) *
                                     depth_count_;
    ray.width_px_ = widths_px_[k];
    return ray;
  }

  [[nodiscard]] const MapCalibration& calibration() const noexcept { return calibration_; }
  [[nodiscard]] std::span<const Cell> cells() const noexcept { return cells_; }

 private:
  MapCalibration calibration_;
  std::span<const Cell> cells_;
  std::shared_ptr<const void> owner_;
  std::vector<int> widths_px_;  ///< of the secondary images
  std::size_t principal_width_ = 0, principal_height_ = 0, depth_count_ = 0;
};

}  // namespace depthgrid::grid
