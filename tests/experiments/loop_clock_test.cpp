// The loop on the real clock in small: every period is done and every frame taken. How long they take is not asserted.
#include "depthgrid/experiments/loop_clock.hpp"

#include <gtest/gtest.h>

#include <algorithm>

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
  const FreeRun free = run_free(recording, Method::search, LoopParts::nine_points, settings, 3, 10, {});
  ASSERT_EQ(free.cycle_s.size(), 30U);
  EXPECT_GT(*std::min_element(free.cycle_s.begin(), free.cycle_s.end()), 0);
  const PacedRun paced =
      run_paced(recording, LoopParts::link_capsules, settings, 0.4, {.nodes = 0, .time_s = 0.001}, [](double) {});
  EXPECT_EQ(paced.periods.size(), 200U);
  EXPECT_EQ(paced.frame_s.size(), 12U);
  EXPECT_EQ(paced.answered, 200 * 6);
}

}  // namespace
}  // namespace depthgrid::experiments
