// The real distance from points to everything but the robot.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "depthgrid/simulation/workcell.hpp"
#include "lab/workcell/cell_truth.hpp"

namespace depthgrid::experiments {

/// Asks workcell::CellTruth: exact to 1e-5 m, from the shapes and not from any image. One thread.
class PointTruth {
 public:
  /// Bodies of kind robot are left out. Throws Error when the cell is invalid.
  PointTruth(const simulation::Workcell& cell, std::size_t points);

  /// The cell has the bodies of the constructor. One distance a point (metres, world frame), 0 inside a body; `to` is
  /// the kind of the nearest body.
  struct Nearest {
    double distance_m = 0;
    simulation::BodyKind to = simulation::BodyKind::room;
  };
  [[nodiscard]] std::vector<Nearest> distances(const simulation::Workcell& cell,
                                               std::span<const Eigen::Vector3d> points_world);

 private:
  void take(const simulation::Workcell& cell, std::span<const Eigen::Vector3d> points_world);

  simulation::Workcell probed_;  ///< the cell's bodies without the robot, then a small ball at each point
  std::size_t points_;
  workcell::CellTruth truth_;
};

}  // namespace depthgrid::experiments
