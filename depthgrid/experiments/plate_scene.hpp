// A hand near the end effector and a large plate farther away, on the other side: where the mean direction (11) leads.
#pragma once

#include <vector>

#include "depthgrid/experiments/avoidance_run.hpp"

namespace depthgrid::experiments {

struct PlateScene {
  std::vector<double> time_s;
  std::vector<double> hand_m;            ///< true distance from the moving links to the hand
  std::vector<double> towards_hand_m_s;  ///< part of the repulsive velocity that points from the end effector to it
  double fastest_towards_m_s = 0;        ///< while the hand is nearer than half of rho; 0 where it never does
  double smallest_m = 0;
  int contacts = 0;
};

[[nodiscard]] PlateScene plate_scene(Method method, const AvoidanceSettings& settings);

}  // namespace depthgrid::experiments
