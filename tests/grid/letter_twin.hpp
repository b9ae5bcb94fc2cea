// The slow twin of the letter's scan: every pixel, every cell, nothing cut short but what the letter itself cuts.
#pragma once

#include <cmath>
#include <vector>

#include "depthgrid/grid/closed_form_map.hpp"
#include "depthgrid/grid/depth_grid.hpp"
#include "depthgrid/grid/evaluation.hpp"
#include "depthgrid/grid/observation.hpp"

namespace depthgrid::grid::twin {

struct Answer {
  double nearest_m = 0;
  Eigen::Vector3d mean_direction_camera = Eigen::Vector3d::Zero();
  std::int64_t count = 0;
};

/// The letter, word for word, for a grid of fixed step.
inline Answer letter(const DepthGrid& grid, const ClosedFormMap& map, const std::vector<Observation>& cameras,
                     std::size_t principal, const EvaluationSettings& settings, const Eigen::Vector3d& p_camera) {
  const PinholeCamera& camera = grid.principal();
  const DepthPoint p = project(camera, p_camera);
  const double rho = settings.rho_m;
  const double step = grid.quantisation().step_m;
  const bool all = settings.window == Window::whole_image || p.depth_m <= rho;
  const double x_s = all ? 0 : rho * camera.fx_px / (p.depth_m - rho);  // (8)
  const double y_s = all ? 0 : rho * camera.fy_px / (p.depth_m - rho);
  Answer answer{rho, Eigen::Vector3d::Zero(), 0};
  const auto confirmed = [&](int u, int v, int n) {
    std::size_t secondary = 0;
    for (std::size_t k = 0; k < cameras.size(); ++k) {
      if (k == principal) {
        continue;
      }
      CellPixel pixel;
      if (map.ray(u, v, secondary++).pixel(n, pixel) &&
          cameras[k].removed_m().at(pixel.u_px, pixel.v_px) >= pixel.d_start_m) {
        return false;
      }
    }
    return true;
  };
  const auto take = [&](int u, int v, double d1, double d2) {
    const NearestPoint obstacle = nearest_point_letter(camera, u, v, d1, d2, p);
    if (obstacle.distance_m < rho) {
      answer.nearest_m = std::min(answer.nearest_m, obstacle.distance_m);
      answer.mean_direction_camera += obstacle.direction_camera;
      ++answer.count;
    }
  };
  const auto is_cell = [&](int n) { return n >= 0 && n < grid.count(); };
  for (int v = 0; v < camera.height_px; ++v) {
    for (int u = 0; u < camera.width_px; ++u) {
      const bool inside = u + 1 > p.x_px - x_s / 2 && u <= p.x_px + x_s / 2 && v + 1 > p.y_px - y_s / 2 &&
                          v <= p.y_px + y_s / 2;  // (9)
      if (!all && !inside) {
        continue;
      }
      const double d_o = cameras[principal].removed_m().at(u, v);
      const int cell_p = static_cast<int>(std::floor((p.depth_m - grid.d_min_m()) / step));
      if (cameras[principal].is_robot()[cameras[principal].removed_m().index(u, v)] != 0) {  // (iv)
        const int cell_r = static_cast<int>(std::floor((d_o - grid.d_min_m()) / step));
        for (int n = cell_r + 1; n <= cell_r + static_cast<int>(std::floor(rho / step + 1e-9)); ++n) {
          if (is_cell(n) && confirmed(u, v, n)) {
            take(u, v, grid.boundary_m(n), grid.boundary_m(n + 1));
            break;
          }
        }
      } else if (d_o > p.depth_m + rho || d_o >= grid.d_max_m()) {  // (i)
        continue;
      } else if (d_o >= p.depth_m) {  // (ii)
        take(u, v, d_o, d_o);
      } else {  // (iii)
        const int lowest = static_cast<int>(std::floor((d_o - p.depth_m) / step));
        const int highest = static_cast<int>(std::floor(rho / step + 1e-9));
        for (int j = 0; j <= highest || -j >= lowest; ++j) {
          std::vector<int> found;
          if (j <= highest && is_cell(cell_p + j) && confirmed(u, v, cell_p + j)) {
            found.push_back(cell_p + j);
          }
          if (j > 0 && -j >= lowest && is_cell(cell_p - j) && confirmed(u, v, cell_p - j)) {
            found.push_back(cell_p - j);
          }
          // Of two at the same |j| the nearer stands for the pixel.
          const auto distance = [&](int n) {
            return nearest_point_letter(camera, u, v, grid.boundary_m(n), grid.boundary_m(n + 1), p).distance_m;
          };
          if (found.size() == 2 && distance(found[1]) < distance(found[0])) {
            found[0] = found[1];
          }
          if (!found.empty()) {
            take(u, v, grid.boundary_m(found[0]), grid.boundary_m(found[0] + 1));
            break;
          }
        }
      }
    }
  }
  if (answer.count > 0) {
    answer.mean_direction_camera /= static_cast<double>(answer.count);
  }
  return answer;
}

}  // namespace depthgrid::grid::twin
