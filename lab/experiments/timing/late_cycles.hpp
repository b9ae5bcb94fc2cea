// Why cycles on the real clock were late.
#pragma once

#include <cstddef>
#include <span>

#include "lab/experiments/timing/loop_clock.hpp"

namespace depthgrid::experiments {

/// Every cycle is in one of them. Late is a command that was not there when its period ended.
struct LateCycles {
  std::size_t in_time = 0;
  std::size_t after_overrun = 0;  ///< late: more than half the period had gone when the cycle before ended
  std::size_t woken_late = 0;     ///< of the others: begun more than half a period late
  std::size_t interrupted = 0;    ///< of the others: took less processor time than a period
  std::size_t computed = 0;       ///< of the others: took a period's processor time or more
};

/// `periods` in order and without a gap.
[[nodiscard]] LateCycles late_cycles(std::span<const PeriodTimes> periods, double period_s) noexcept;

}  // namespace depthgrid::experiments
