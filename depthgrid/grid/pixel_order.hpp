// The order in which principal pixels are visited. Internal.
#pragma once

#include <algorithm>

#include "depthgrid/grid/obstacle_set.hpp"
#include "depthgrid/grid/surveillance_window.hpp"

namespace depthgrid::grid {

/// Every pixel of the window, row by row: needed when all obstacles count (equation (11)).
template <class Visit>
void visit_all(const PixelWindow& window, Visit&& visit) noexcept {
  for (int v = window.v_begin; v < window.v_end; ++v) {
    for (int u = window.u_begin; u < window.u_end; ++u) {
      visit(u, v);
    }
  }
}

/// The smart scan for the minimum only: square rings of pixels around the point's own pixel, outwards, within a window
/// that shrinks with the best distance so far. No pixel whose pyramid comes nearer than the nearest obstacle is left
/// out, so the minimum is that of visit_all().
template <class Visit>
void visit_rings(const PixelWindow& window, const PinholeCamera& camera, const ControlPoint& point,
                 const ObstacleSet& obstacles, Visit&& visit) noexcept {
  const int u0 = std::clamp(static_cast<int>(point.p.x_px), 0, camera.width_px - 1);
  const int v0 = std::clamp(static_cast<int>(point.p.y_px), 0, camera.height_px - 1);
  double best_m = -1;
  PixelWindow w;
  for (int ring = 0;; ++ring) {
    if (obstacles.nearest_m() != best_m) {
      best_m = obstacles.nearest_m();
      const PixelWindow reach = sphere_window(camera, point.p_camera, best_m);
      w = {std::max(window.u_begin, reach.u_begin), std::max(window.v_begin, reach.v_begin),
           std::min(window.u_end, reach.u_end), std::min(window.v_end, reach.v_end)};
    }
    if (w.empty() || ring > std::max({u0 - w.u_begin, w.u_end - 1 - u0, v0 - w.v_begin, w.v_end - 1 - v0})) {
      return;
    }
    const int u_begin = std::max(u0 - ring, w.u_begin);
    const int u_end = std::min(u0 + ring + 1, w.u_end);
    const int v_begin = std::max(v0 - ring + 1, w.v_begin);
    const int v_end = std::min(v0 + ring, w.v_end);
    for (const int v : {v0 - ring, v0 + ring}) {
      for (int u = u_begin; u < u_end && v >= w.v_begin && v < w.v_end; ++u) {
        visit(u, v);
      }
      if (ring == 0) {
        break;
      }
    }
    for (const int u : {u0 - ring, u0 + ring}) {
      for (int v = v_begin; v < v_end && u >= w.u_begin && u < w.u_end; ++v) {
        visit(u, v);
      }
    }
  }
}

}  // namespace depthgrid::grid
