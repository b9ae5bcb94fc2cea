// The loop on the real clock in small: every period is done and every frame taken. How long they take is not asserted.
#include "lab/experiments/timing/loop_clock.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "lab/experiments/timing/late_cycles.hpp"

namespace depthgrid::experiments {
namespace {

TEST(LoopOnTheClock, DoesEveryPeriodAndTakesEveryFrame) {
  AvoidanceSettings settings;
  settings.width_px = 96;
  const LoopRecording recording(settings, 0.5, 1);
  EXPECT_EQ(recording.frames(), 15U);
  // There and back: the last period of the way there is the first of the way back.
  EXPECT_EQ(recording.joints(249), recording.joints(250));
  EXPECT_EQ(recording.joints(0), recording.joints(500));
  const FreeRun free = run_free(recording, Method::search, LoopParts::nine_points, settings, 3, 40, {});
  ASSERT_EQ(free.cycle_s.size(), 120U);
  EXPECT_GT(*std::min_element(free.cycle_s.begin(), free.cycle_s.end()), 0);
  const PacedRun paced =
      run_paced(recording, LoopParts::link_capsules, settings, 0.4, {.time_s = 0.001}, [](double) {});
  EXPECT_EQ(paced.periods.size(), 200U);
  EXPECT_EQ(paced.frame_s.size(), 12U);
  EXPECT_EQ(paced.answered, 200 * 6);
  EXPECT_EQ(paced.failed_cycles, 0);
  EXPECT_EQ(paced.failed_frames, 0);
  // What the caller's progress throws ends both threads.
  EXPECT_THROW((void)run_paced(recording, LoopParts::nine_points, settings, 10, {},
                               [](double) { throw std::runtime_error("enough"); }),
               std::runtime_error);
}

TEST(LateCycles, AreInOneClassEach) {
  const std::vector<PeriodTimes> periods{
      {.late_s = 0.0001, .took_s = 0.001, .processor_s = 0.001},    // in time
      {.late_s = 0.0001, .took_s = 0.005, .processor_s = 0.005},    // computed
      {.late_s = 0.0031, .took_s = 0.001, .processor_s = 0.001},    // after it
      {.late_s = 0.0021, .took_s = 0.0005, .processor_s = 0.0005},  // still: the one before lasted 2.1 ms too long
      {.late_s = 0.0006, .took_s = 0.001, .processor_s = 0.001},    // in time again
      {.late_s = 0.0015, .took_s = 0.001, .processor_s = 0.001},    // woken late
      {.late_s = 0.0005, .took_s = 0.003, .processor_s = 0.001},    // interrupted
  };
  const LateCycles late = late_cycles(periods, 0.002);
  EXPECT_EQ(late.in_time, 2U);
  EXPECT_EQ(late.computed, 1U);
  EXPECT_EQ(late.after_overrun, 2U);
  EXPECT_EQ(late.woken_late, 1U);
  EXPECT_EQ(late.interrupted, 1U);
}

}  // namespace
}  // namespace depthgrid::experiments
