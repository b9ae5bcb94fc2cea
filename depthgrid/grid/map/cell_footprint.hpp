// All pixels of a secondary camera on which any part of a cell projects.
#pragma once

#include <array>
#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/grid/closed_form_map.hpp"
#include "depthgrid/grid/map/pixel_list_map.hpp"

namespace depthgrid::grid {

/// A cell with a corner nearer than this to the secondary camera's plane z = 0, or behind it, has no projection.
inline constexpr double kNearestCornerM = 1e-6;

/// The pixels of one cell: one span in each of the image rows from v_first_px on, none of them empty.
struct CellFootprint {
  int v_first_px = 0;
  float d_start_m = 0;  ///< smallest depth of the cell's corners
  std::vector<PixelListMap::RowSpan> rows;

  /// Makes pixel (u_px, v_px), which lies in the image, one of the footprint's pixels.
  void include(int u_px, int v_px);
};

/// Projects the cells of one principal camera's rays into one secondary camera, in double precision. One object a
/// thread.
///
/// The projection of a cell in front of the camera is the convex hull of its eight projected corners, and the hull's
/// border consists of projections of the cell's twelve edges: so the extent of the hull in a row of pixels is the
/// extent of those edges in it, and no hull needs to be formed.
class CellProjector {
 public:
  CellProjector(const PinholeCamera& principal, const SecondaryCamera& secondary);

  /// Takes the ray of principal pixel (u, v).
  void set_ray(int u, int v) noexcept;

  /// The pixels that the cell between the two depths of the principal camera touches, clipped to the image. A pixel
  /// whose border comes within 1e-7 px of the cell counts as touched, so that rounding can lose none. False, with the
  /// footprint empty, when there is none or the cell reaches behind the secondary camera.
  bool project(double front_m, double back_m, CellFootprint& footprint);

 private:
  struct Face {
    double depth_m = -1;  ///< of the principal camera; the face that is kept
    double nearest_m = 0;
    std::array<double, 4> x_px{};
    std::array<double, 4> y_px{};
  };
  struct Extent {
    double low_px;
    double high_px;
  };

  [[nodiscard]] Face face(double depth_m) const noexcept;
  void add_edge(double x0, double y0, double x1, double y1, int v_low, int v_high, double slack_px) noexcept;

  PinholeCamera principal_;
  PinholeCamera camera_;
  Pose T_secondary_principal_;
  std::array<Eigen::Vector3d, 4> corner_;  ///< T's rotation times the rays of the pixel's corners, in order around it
  Face last_;                              ///< far face of the last cell: the near face of the next one
  std::vector<Extent> extents_;
};

}  // namespace depthgrid::grid
