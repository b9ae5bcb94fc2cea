#include "lab/experiments/timing/late_cycles.hpp"

namespace depthgrid::experiments {

LateCycles late_cycles(std::span<const PeriodTimes> periods, double period_s) noexcept {
  LateCycles result;
  double overrun_s = 0;  // of the cycle before
  for (const PeriodTimes& times : periods) {
    const double end_s = times.late_s + times.took_s;
    if (end_s <= period_s) {
      ++result.in_time;
    } else if (overrun_s > 0.5 * period_s) {
      ++result.after_overrun;
    } else if (times.late_s > 0.5 * period_s) {
      ++result.woken_late;
    } else if (times.processor_s < period_s) {
      ++result.interrupted;
    } else {
      ++result.computed;
    }
    overrun_s = end_s - period_s;
  }
  return result;
}

}  // namespace depthgrid::experiments
