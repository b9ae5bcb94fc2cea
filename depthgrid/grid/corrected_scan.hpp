// The scan over the principal camera's pixels with the letter's errors mended: for each pixel the nearest cell, by
// exact distance, that no camera has seen free. Its obstacle set contains the exact one, so it never over-estimates.
// Internal.
#pragma once

#include <array>
#include <span>

#include "depthgrid/grid/cell_carver.hpp"
#include "depthgrid/grid/depth_grid.hpp"
#include "depthgrid/grid/evaluation.hpp"
#include "depthgrid/grid/observation.hpp"
#include "depthgrid/grid/obstacle_set.hpp"
#include "depthgrid/grid/possible_cells.hpp"

namespace depthgrid::grid {

/// A camera and its newest free depth.
struct CarvingCamera {
  const CellCarver* carver;
  const DepthImage* free_m;
};

class CorrectedScan {
 public:
  /// `cameras` are the cameras that may free cells: all secondary ones, and the principal one too where it has a pose
  /// margin (without one, its own free depth ends exactly at g on each of its rays). principal_near_m: its blind zone.
  /// `possible`: what may hold anything by a memory; null without one.
  CorrectedScan(const DepthGrid& grid, const DepthImage& principal_free_m, double principal_near_m,
                bool principal_has_margin, std::span<const CarvingCamera> cameras, const PossibleCells* possible,
                const EvaluationSettings& settings, const ControlPoint& point, ObstacleSet& obstacles,
                EvaluationCount& count) noexcept
      : grid_(grid),
        principal_free_m_(principal_free_m),
        principal_near_m_(principal_near_m),
        principal_has_margin_(principal_has_margin),
        cameras_(cameras),
        possible_(possible),
        settings_(settings),
        point_(point),
        obstacles_(obstacles),
        count_(count) {}

  /// Finds the nearest obstacle of one principal pixel.
  void pixel(int u, int v) noexcept;

 private:
  struct Column {
    PixelFrustum pixel;  ///< slopes of the principal pixel
    std::array<CellCarver::Edges, 32> edges;
    bool has_edges = false;
  };

  /// The distance beyond which nothing matters any more.
  [[nodiscard]] double bound_m() const noexcept {
    return settings_.collect == Collect::hybrid ? settings_.rho_m : obstacles_.nearest_m();
  }
  /// Nearest cell between the depths d1_m and d2_m that no camera frees; true and `nearest` when within the bound.
  bool nearest_obstacle(Column& column, double d1_m, double d2_m, NearestPoint& nearest) noexcept;
  bool known_free(Column& column, double d1_m, double d2_m) noexcept;

  const DepthGrid& grid_;
  const DepthImage& principal_free_m_;
  double principal_near_m_;
  bool principal_has_margin_;
  std::span<const CarvingCamera> cameras_;
  const PossibleCells* possible_;
  const EvaluationSettings& settings_;
  const ControlPoint& point_;
  ObstacleSet& obstacles_;
  EvaluationCount& count_;
};

}  // namespace depthgrid::grid
