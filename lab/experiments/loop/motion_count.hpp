// Counts how often a run touches things and how long it stands.
#pragma once

#include <limits>

#include "lab/experiments/loop/run_summary.hpp"

namespace depthgrid::experiments {

/// One thread. Of one run.
class MotionCount {
 public:
  /// `task_speed_m_s`: of the end effector when nothing is near. `rho_m`: what is farther is no reason to stand.
  MotionCount(double period_s, double task_speed_m_s, double rho_m)
      : period_s_(period_s), task_speed_m_s_(task_speed_m_s), rho_m_(rho_m) {}

  /// Every period: the end effector's speed, and the true distances to the person and to objects, infinity where there
  /// is none. Adds to the smallest distance, to contacts with objects, and to the times stopped.
  void take(double speed_m_s, double person_m, double object_m, RunSummary& summary);

 private:
  double period_s_;
  double task_speed_m_s_;
  double rho_m_;
  double object_before_m_ = std::numeric_limits<double>::infinity();
};

}  // namespace depthgrid::experiments
