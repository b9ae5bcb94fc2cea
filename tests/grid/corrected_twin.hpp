// The corrected evaluation, slow and obvious.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "depthgrid/core/pixel_frustum.hpp"
#include "depthgrid/grid/cell_carver.hpp"
#include "depthgrid/grid/depth_grid.hpp"
#include "depthgrid/grid/evaluation.hpp"
#include "depthgrid/grid/observation.hpp"
#include "reference/random_problem.hpp"

namespace depthgrid::grid {

using reference::RandomProblem;

inline Eigen::Vector3d in_principal(const RandomProblem& problem, const Eigen::Vector3d& p_world) {
  return problem.rig.cameras[problem.principal].T_world_camera.inverse() * p_world;
}

inline std::vector<Observation> observe(const RandomProblem& problem, const SensorMargin* margin) {
  std::vector<Observation> observations;
  for (std::size_t k = 0; k < problem.rig.cameras.size(); ++k) {
    observations.emplace_back(problem.rig.cameras[k], margin);
    EXPECT_TRUE(observations.back().update(problem.frames[k]));
  }
  return observations;
}

inline DepthQuantisation quantisation_of(const RandomProblem& problem, double growth = 0.0) {
  return {problem.d_min_m, problem.step_m, growth, problem.cell_count};
}

/// Every cell of every pixel, each with its exact distance; only those that may_hold() anything.
inline double corrected_twin(const RandomProblem& problem, const DepthGrid& grid,
                             const std::vector<Observation>& observations, const EvaluationSettings& settings,
                             const Eigen::Vector3d& p_camera,
                             const std::function<bool(const PixelFrustum&)>& may_hold = {}) {
  const auto& cameras = problem.rig.cameras;
  const RigCamera& principal = cameras[problem.principal];
  const bool margin = settings.pose.translation_m > 0 || settings.pose.rotation_rad > 0 || settings.pose.time_m > 0;
  std::vector<CellCarver> carvers;
  for (const RigCamera& camera : cameras) {
    carvers.emplace_back(camera.intrinsics, camera.T_world_camera.inverse() * principal.T_world_camera,
                         camera.rule.near_m, settings.pose);
  }
  double best_m = settings.rho_m;
  for (int v = 0; v < grid.principal().height_px; ++v) {
    for (int u = 0; u < grid.principal().width_px; ++u) {
      const double g = observations[problem.principal].free_m().at(u, v);
      for (int n = 0; n < grid.count(); ++n) {
        PixelFrustum cell = grid.cell(u, v, n);
        if (!margin && g > principal.rule.near_m) {
          // The principal camera frees near .. g on its own rays, to the point.
          if (cell.d1_m >= principal.rule.near_m) {
            cell.d1_m = std::max(cell.d1_m, g);
          }
          if (cell.d2_m <= cell.d1_m) {
            continue;
          }
        }
        bool known_free = false;
        for (std::size_t k = 0; k < cameras.size() && !known_free; ++k) {
          if (k != problem.principal || margin) {
            known_free = carvers[k].frees(carvers[k].edges(cell), cell.d1_m, cell.d2_m, observations[k].free_m());
          }
        }
        const double cell_m = known_free ? best_m : nearest_point(cell, p_camera).distance_m;
        if (cell_m < best_m && (!may_hold || may_hold(cell))) {
          best_m = cell_m;
        }
      }
    }
  }
  return best_m;
}

}  // namespace depthgrid::grid
