// The main claims of docs/recordings.md on a few frames of the recording kinect3_ball, when it is there.
#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "recordings/ball_study.hpp"
#include "recordings/ball_tables.hpp"

namespace depthgrid::bench {
namespace {

/// The rig's calibration is good to 2-5 cm and the ball's place is known to about 2 cm.
constexpr double kRigAccuracy_m = 0.04;

TEST(Kinect3Ball, DistancesAgreeWithTheBall) {
  const auto folder = recording_folder("kinect3_ball");
  if (!std::filesystem::exists(folder / "rig.json")) {
    GTEST_SKIP() << "the recording " << folder << " is absent; set DEPTHGRID_DATA to the folder that holds it";
  }
  input::Recording recording(folder);
  auto settings = ball_settings();
  settings.resize(2);  // letter, and corrected without margins
  const auto study = study_ball(recording, load_ball_track(folder / "ball.json"), {4, 40, 76}, settings, {});
  ASSERT_EQ(study.frames, 3U);
  for (const auto& result : study.settings) {
    for (std::size_t cameras = 1; cameras <= 3; ++cameras) {
      const auto f = ball_figures(result, cameras);
      SCOPED_TRACE(result.setting.name + ", cameras: " + std::to_string(cameras));
      EXPECT_GT(f.at_ball, 20U);
      EXPECT_LT(std::abs(f.error_median_m), kRigAccuracy_m);
      EXPECT_LT(f.error_95_m, kTolerance_m);
      EXPECT_GT(f.tested, 100U);
      EXPECT_EQ(f.violations, 0U) << "worst: " << f.worst_excess_m << " m";
    }
  }
  for (const auto& [set, area] : study.gray) {
    EXPECT_GT(area.freed_letter_m3, 0.1 * area.gray_m3);
    EXPECT_LE(area.freed_corrected_m3, area.freed_letter_m3);
  }
}

}  // namespace
}  // namespace depthgrid::bench
