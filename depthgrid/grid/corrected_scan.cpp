#include "depthgrid/grid/corrected_scan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depthgrid::grid {

void CorrectedScan::pixel(int u, int v) noexcept {
  ++count_.pixels;
  const double d_min = grid_.d_min_m();
  const double d_max = grid_.d_max_m();
  const double g = principal_free_m_.at(u, v);
  Column column;
  column.pixel = pixel_frustum(grid_.principal(), u, v, d_min, d_max);
  NearestPoint nearest{};
  NearestPoint other{};
  bool found = false;
  if (principal_has_margin_ || !(g > principal_near_m_)) {
    found = nearest_obstacle(column, d_min, d_max, nearest);
  } else {
    // The principal camera frees near .. g on this ray: what is left is its blind zone and the shadow behind g.
    found = nearest_obstacle(column, std::max(d_min, g), d_max, nearest);
    if (nearest_obstacle(column, d_min, std::min(principal_near_m_, d_max), other) &&
        (!found || other.distance_m < nearest.distance_m)) {
      nearest = other;
      found = true;
    }
  }
  if (!found) {
    return;
  }
  obstacles_.take_nearest(nearest, u, v);
  if (settings_.collect == Collect::hybrid) {
    obstacles_.add_weighted_direction(nearest);
  }
}

bool CorrectedScan::nearest_obstacle(Column& column, double d1_m, double d2_m, NearestPoint& nearest) noexcept {
  if (!(d1_m < d2_m)) {
    return false;
  }
  const auto cell = [&](int n) {
    PixelFrustum part = column.pixel;
    part.d1_m = std::max(d1_m, grid_.boundary_m(n));
    part.d2_m = std::min(d2_m, grid_.boundary_m(n + 1));
    return part;
  };
  PixelFrustum whole = column.pixel;
  whole.d1_m = d1_m;
  whole.d2_m = d2_m;
  const double bound = bound_m();
  nearest = nearest_point(whole, point_.p_camera);
  if (!(nearest.distance_m < bound)) {
    return false;
  }
  const int first = std::clamp(grid_.cell_of(d1_m), 0, grid_.count() - 1);
  int last = std::clamp(grid_.cell_of(d2_m), 0, grid_.count() - 1);
  if (grid_.boundary_m(last) >= d2_m && last > first) {
    --last;
  }
  const int start = std::clamp(grid_.cell_of(nearest.point_camera.z()), first, last);
  if (nearest.point_camera.z() > d1_m + 1e-9) {
    ++count_.gray_pixels;  // the surface, if there is one, is not what is nearest: the other cameras decide
  }

  // Distance along the ray is convex, so from the nearest cell outwards it grows in both directions: always the nearer
  // of the two ends is next.
  int up = start;
  int down = start - 1;
  double up_m2 = nearest.distance_m * nearest.distance_m;
  const auto beyond = std::numeric_limits<double>::infinity();
  double down_m2 = down >= first ? squared_distance(cell(down), point_.p_camera) : beyond;
  while (std::min(up_m2, down_m2) < bound * bound) {
    const bool take_up = up_m2 <= down_m2;
    const int n = take_up ? up : down;
    const PixelFrustum part = cell(n);
    ++count_.cells;
    if (!known_free(column, part.d1_m, part.d2_m)) {
      nearest = nearest_point(part, point_.p_camera);
      return nearest.distance_m < bound;
    }
    if (take_up) {
      up_m2 = ++up <= last ? squared_distance(cell(up), point_.p_camera) : beyond;
    } else {
      down_m2 = --down >= first ? squared_distance(cell(down), point_.p_camera) : beyond;
    }
  }
  return false;
}

bool CorrectedScan::known_free(Column& column, double d1_m, double d2_m) noexcept {
  if (possible_ != nullptr) {
    PixelFrustum cell = column.pixel;
    cell.d1_m = d1_m;
    cell.d2_m = d2_m;
    if (!possible_->may_hold(cell)) {
      return true;
    }
  }
  if (!column.has_edges) {
    for (std::size_t k = 0; k < cameras_.size(); ++k) {
      column.edges[k] = cameras_[k].carver->edges(column.pixel);
    }
    column.has_edges = true;
  }
  for (std::size_t k = 0; k < cameras_.size(); ++k) {
    if (cameras_[k].carver->frees(column.edges[k], d1_m, d2_m, *cameras_[k].free_m)) {
      return true;
    }
  }
  return false;
}

}  // namespace depthgrid::grid
