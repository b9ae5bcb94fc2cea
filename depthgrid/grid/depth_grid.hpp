// The depth grid of the letter's section III: the principal camera's pixels times a quantised depth.
#pragma once

#include <vector>

#include "depthgrid/core/camera.hpp"
#include "depthgrid/core/pixel_frustum.hpp"

namespace depthgrid::grid {

/// Depth cells: cell n spans boundary(n) .. boundary(n + 1). With growth = 0 all cells are step_m deep (equation (4));
/// otherwise a cell at depth d is step_m + growth (d - d_min_m) deep, the linear growth that the letter suggests.
struct DepthQuantisation {
  double d_min_m = 0.2882;
  double step_m = 0.01;
  double growth = 0.0;
  int count = 343;
};

/// Throws Error unless d_min_m >= 0, step_m > 0, 0 <= growth <= 1, 1 <= count <= 65535 and all boundaries are finite.
void validate(const DepthQuantisation& quantisation);

/// Immutable after construction, so safe to share between threads.
class DepthGrid {
 public:
  /// Throws Error as validate() of both arguments.
  DepthGrid(const PinholeCamera& principal, const DepthQuantisation& quantisation);

  [[nodiscard]] const PinholeCamera& principal() const noexcept { return principal_; }
  [[nodiscard]] const DepthQuantisation& quantisation() const noexcept { return quantisation_; }
  [[nodiscard]] int count() const noexcept { return quantisation_.count; }
  [[nodiscard]] double d_min_m() const noexcept { return boundaries_m_.front(); }
  [[nodiscard]] double d_max_m() const noexcept { return boundaries_m_.back(); }
  /// Depth at which cell n begins; n in [0, count()].
  [[nodiscard]] double boundary_m(int n) const noexcept { return boundaries_m_[static_cast<std::size_t>(n)]; }

  /// Equation (4), r(d): the cell that contains depth d_m. Below the grid the result is negative, beyond it at least
  /// count(): callers clip. d_m must be finite. Consistent with boundary_m(): boundary(r) <= d < boundary(r + 1).
  [[nodiscard]] int cell_of(double d_m) const noexcept;

  /// The cell as a convex set in the principal camera's frame.
  [[nodiscard]] PixelFrustum cell(int u, int v, int n) const noexcept {
    return pixel_frustum(principal_, u, v, boundary_m(n), boundary_m(n + 1));
  }

 private:
  PinholeCamera principal_;
  DepthQuantisation quantisation_;
  std::vector<double> boundaries_m_;
};

}  // namespace depthgrid::grid
