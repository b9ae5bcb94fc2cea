// A hand near the end effector and a large plate farther away, on the other side: where the mean direction (11) leads.
#pragma once

#include <vector>

#include "lab/experiments/loop/avoidance_run.hpp"

namespace depthgrid::experiments {

struct PlateScene {
  std::vector<double> time_s;
  std::vector<double> hand_m;  ///< true distance from the moving links to the hand
  /// Part of the repulsive velocity that points from the end effector to what the method holds for nearest to it.
  std::vector<double> towards_nearest_m_s;
  double fastest_towards_nearest_m_s = 0;  ///< 0 where it never does
  /// The same towards the hand, while the hand is really nearer than half of rho.
  double fastest_towards_hand_m_s = 0;
  double smallest_m = 0;
  int contacts = 0;
};

[[nodiscard]] PlateScene plate_scene(Method method, const AvoidanceSettings& settings);

}  // namespace depthgrid::experiments
