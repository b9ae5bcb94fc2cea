// The scan over the principal camera's pixels as the letter prints it: cases (i)-(iv) of section VI and VII. Internal.
//
// Known deviations from a bound that never over-estimates, kept on purpose (f = 525 px, rho = 0.4 m, 1 cm cells):
//  - the printed window is half of what the rho-sphere needs (surveillance_window.hpp);
//  - (5)-(7) clamp in pixel coordinates: up to 7 mm too far, in case (ii) up to 71 mm, since the obstacle is the whole
//    shadow behind d_o and not only its front;
//  - case (iii) orders cells by |j|, that is by depth, not by distance: off axis up to 0.19 m too far in an answer;
//  - d_o < d_start lets a cell that holds the surface itself count as free, so thin things vanish;
//  - case (iv) starts at the robot, not at the point, and ends at the first confirmed cell.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "depthgrid/grid/column_search.hpp"
#include "depthgrid/grid/depth_grid.hpp"
#include "depthgrid/grid/evaluation.hpp"
#include "depthgrid/grid/observation.hpp"
#include "depthgrid/grid/obstacle_set.hpp"
#include "depthgrid/grid/surveillance_window.hpp"

namespace depthgrid::grid {

/// Most secondary cameras of one evaluator.
inline constexpr std::size_t kMaxSecondaries = 31;

/// Scans `window` for one control point. `secondary_depths_m` are the dense images of the secondary cameras.
template <class Map>
class LetterScan {
  using Ray = decltype(std::declval<const Map&>().ray(0, 0, 0));

 public:
  LetterScan(const DepthGrid& grid, const Map& map, const Observation& principal,
             std::span<const float* const> secondary_depths_m, const EvaluationSettings& settings,
             const ControlPoint& point, ObstacleSet& obstacles, EvaluationCount& count) noexcept
      : grid_(grid),
        map_(map),
        removed_m_(principal.removed_m().data()),
        is_robot_(principal.is_robot().data()),
        width_px_(static_cast<std::size_t>(grid.principal().width_px)),
        beyond_m_(point.p.depth_m + settings.rho_m),
        secondary_depths_m_(secondary_depths_m),
        settings_(settings),
        point_(point),
        obstacles_(obstacles),
        count_(count),
        distance_(grid.principal(), point.p),
        squared_bound_m2_(settings.rho_m * settings.rho_m),
        cell_of_point_(grid.cell_of(point.p.depth_m)),
        cells_within_rho_(cells_within_rho(point.p.depth_m)) {}

  /// One pixel of interest: the case distinction of section VI.
  void pixel(int u, int v) noexcept {
    ++count_.pixels;
    const std::size_t index = static_cast<std::size_t>(v) * width_px_ + static_cast<std::size_t>(u);
    const double d_o = removed_m_[index];
    if (is_robot_[index] != 0) {
      robot_removed(u, v, d_o);  // (iv)
    } else if (d_o > beyond_m_ || d_o >= grid_.d_max_m()) {
      return;  // (i), and shadows that begin beyond the grid
    } else if (d_o >= point_.p.depth_m) {
      take(u, v, distance_.vector(u, v, d_o, d_o));  // (ii), (5)-(7)
    } else {
      behind_surface(u, v, d_o);  // (iii); without measurement d_o is 0: everything on the ray needs confirmation
    }
  }

 private:
  /// (iii): from the cell at the point's depth outwards in both directions until an obstacle is confirmed. Cells
  /// farther than rho in depth cannot give a distance below rho, so the printed lower end floor((d_o - d_p) / dd)
  /// is cut there.
  void behind_surface(int u, int v, double d_o) noexcept {
    ++count_.gray_pixels;
    begin_column(u, v);
    const int last = std::min(cell_of_point_ + cells_within_rho_, grid_.count() - 1);
    const int surface = cell_of_point_ + lower_end(d_o);
    const int first = std::max({surface, cell_of_point_ - cells_within_rho_ - 1, 0});
    const ColumnHit hit = search(cell_of_point_, first, last);
    if (hit.beyond || hit.before) {
      take_nearer(u, v, cell_of_point_ + (hit.beyond ? hit.j : -hit.j), cell_of_point_ + (hit.before ? -hit.j : hit.j));
    }
  }

  /// (iv): the robot excludes obstacles up to its far end d_r; the cells behind it need confirmation.
  void robot_removed(int u, int v, double d_r) noexcept {
    ++count_.gray_pixels;
    begin_column(u, v);
    const int robot = grid_.cell_of(d_r);
    const int last = std::min(robot + cells_within_rho(d_r), grid_.count() - 1);
    const int first = std::max(robot + 1, 0);
    const ColumnHit hit = first <= last ? search(first, first, last) : ColumnHit{};
    if (hit.beyond) {
      take(u, v, to_cell(u, v, first + hit.j));
    }
  }

  void begin_column(int u, int v) noexcept {
    for (std::size_t k = 0; k < secondary_depths_m_.size(); ++k) {
      rays_[k] = map_.ray(u, v, k);
    }
  }

  [[nodiscard]] ColumnHit search(int start, int first, int last) noexcept {
    const std::size_t cameras = secondary_depths_m_.size();
    const ColumnHit hit =
        search_outwards(std::span<const Ray>(rays_.data(), cameras), secondary_depths_m_, start, first, last);
    count_.cells += cells_visited(hit, start, first, last);
    return hit;
  }

  /// floor((d_o - d_p) / dd), a negative number.
  [[nodiscard]] int lower_end(double d_o) const noexcept {
    const DepthQuantisation& q = grid_.quantisation();
    if (q.growth == 0) {
      return static_cast<int>(std::floor((d_o - point_.p.depth_m) / q.step_m));
    }
    return grid_.cell_of(d_o) - cell_of_point_ - 1;
  }

  /// floor(rho / dd); with a growing step the cells between d_m and d_m + rho.
  [[nodiscard]] int cells_within_rho(double d_m) const noexcept {
    const DepthQuantisation& q = grid_.quantisation();
    if (q.growth == 0) {
      return static_cast<int>(std::min(std::floor(settings_.rho_m / q.step_m * (1 + 1e-12)), 1e9));
    }
    return grid_.cell_of(d_m + settings_.rho_m) - grid_.cell_of(d_m);
  }

  [[nodiscard]] Eigen::Vector3d to_cell(int u, int v, int n) const noexcept {
    return distance_.vector(u, v, grid_.boundary_m(n), grid_.boundary_m(n + 1));
  }

  /// Of two cells confirmed at the same |j| the nearer one stands for the pixel.
  void take_nearer(int u, int v, int n, int other) noexcept {
    const Eigen::Vector3d to_first = to_cell(u, v, n);
    const Eigen::Vector3d to_second = other == n ? to_first : to_cell(u, v, other);
    take(u, v, to_second.squaredNorm() < to_first.squaredNorm() ? to_second : to_first);
  }

  /// `to_obstacle` is the vector (v_x v_y v_z) of (7).
  void take(int u, int v, const Eigen::Vector3d& to_obstacle) noexcept {
    const double squared_m2 = to_obstacle.squaredNorm();
    if (!(squared_m2 < squared_bound_m2_)) {
      return;
    }
    const double distance_m = std::sqrt(squared_m2);
    const double inverse = distance_m > 0 ? 1.0 / distance_m : 0.0;
    if (distance_m < obstacles_.nearest_m()) {
      obstacles_.take_nearest({point_.p_camera + to_obstacle, distance_m, inverse * to_obstacle}, u, v);
    }
    if (settings_.collect == Collect::hybrid) {
      obstacles_.add_direction(inverse * to_obstacle);  // (10), (11)
    }
  }

  const DepthGrid& grid_;
  const Map& map_;
  const float* removed_m_;
  const std::uint8_t* is_robot_;
  std::size_t width_px_;
  double beyond_m_;  ///< d_p + rho
  std::span<const float* const> secondary_depths_m_;
  const EvaluationSettings& settings_;
  const ControlPoint& point_;
  ObstacleSet& obstacles_;
  EvaluationCount& count_;
  LetterDistance distance_;
  double squared_bound_m2_;
  int cell_of_point_;
  int cells_within_rho_;
  /// The current pixel's ray in every secondary camera.
  std::array<Ray, kMaxSecondaries> rays_;
};

}  // namespace depthgrid::grid
