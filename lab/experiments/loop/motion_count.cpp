#include "lab/experiments/loop/motion_count.hpp"

#include <algorithm>

namespace depthgrid::experiments {

namespace {

constexpr double kSlowShare = 0.1;  // of the task's speed

}  // namespace

void MotionCount::take(double speed_m_s, double person_m, double object_m, RunSummary& summary) {
  summary.smallest_person_m = std::min(summary.smallest_person_m, person_m);
  summary.object_contacts += object_m <= 0 && object_before_m_ > 0 ? 1 : 0;
  object_before_m_ = object_m;
  if (speed_m_s < kSlowShare * task_speed_m_s_) {
    summary.stopped_s += period_s_;
    summary.false_stop_s += std::min(person_m, object_m) > rho_m_ ? period_s_ : 0.0;
  }
}

}  // namespace depthgrid::experiments
