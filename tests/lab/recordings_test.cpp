// The main claims of docs/recordings.md on a few frames of the recordings, where they are there.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "lab/measure/recording_folder.hpp"
#include "lab/recordings/ball_search.hpp"
#include "lab/recordings/ball_study.hpp"
#include "lab/recordings/ball_tables.hpp"
#include "lab/recordings/left_out_study.hpp"

namespace depthgrid::lab {
namespace {

/// The rig's calibration is good to 2-5 cm and the ball's place is known to about 2 cm.
constexpr double kRigAccuracy_m = 0.04;

/// Skips the test when the recording is absent.
class OnRecording : public ::testing::Test {
 protected:
  explicit OnRecording(const char* name) : folder(recording_folder(name)) {}
  void SetUp() override {
    if (!std::filesystem::exists(folder / "rig.json")) {
      GTEST_SKIP() << "the recording " << folder << " is absent; set DEPTHGRID_DATA to the folder that holds it";
    }
  }
  std::filesystem::path folder;
};

class Kinect3Ball : public OnRecording {
 protected:
  Kinect3Ball() : OnRecording("kinect3_ball") {}
};

class RedKitchen : public OnRecording {
 protected:
  RedKitchen() : OnRecording("redkitchen_poses") {}
};

double rate(const LeftOutFigures& f) { return static_cast<double>(f.violations) / static_cast<double>(f.readings); }

TEST_F(Kinect3Ball, DistancesAgreeWithTheBall) {
  files::Recording recording(folder);
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
    EXPECT_GT(area.known_free_letter_m3, 0.1 * area.gray_m3);
    EXPECT_LE(area.known_free_corrected_m3, area.known_free_letter_m3);
  }
}

TEST_F(Kinect3Ball, NoSearchWithTheSensorsMarginsLooksBeyondTheBall) {
  files::Recording recording(folder);
  const auto rows = study_ball_search(recording, load_ball_track(folder / "ball.json"), {4, 40, 76});
  std::size_t tested = 0;
  for (const BallSearchFigures& row : rows) {
    SCOPED_TRACE(row.setting + ", cameras: " + std::to_string(row.cameras));
    // What the rig is good for, without margins; with those of the sensor nothing at all.
    EXPECT_EQ(row.over_5cm, 0U) << row.largest_m;
    if (row.setting.find("Kinect") != std::string::npos) {
      EXPECT_EQ(row.over, 0U) << row.largest_m;
    } else {
      EXPECT_GT(row.at_ball, 10U);
    }
    tested += row.tested;
  }
  EXPECT_GT(tested, 1000U);
}

TEST_F(Kinect3Ball, WhatACameraMeasuresIsNotFreeToTheOthersBeyondTheMargins) {
  files::Recording recording(folder);
  for (const LeftOutRow& row : ball_leave_one_out(recording, {0, 32, 64}, 20)) {
    SCOPED_TRACE(row.setting + ", without " + row.left_out);
    const LeftOutFigures& f = row.figures;
    EXPECT_GT(f.readings, 500U);
    if (row.setting == "none, w = 1" && row.left_out == "cam2") {
      EXPECT_GT(rate(f), 0.10) << "the tilt between the cameras' floors is no longer seen";
    } else if (row.setting == "Kinect") {
      EXPECT_LT(rate(f), 0.01);
      EXPECT_GT(f.free_before, f.readings / 20);
    } else if (row.setting == "Kinect + calibration + time") {
      EXPECT_EQ(f.violations, 0U);
    }
  }
}

TEST_F(RedKitchen, WhatAMovingCameraMeasuresIsNotFreeToItsOwnPastBeyondTheMargins) {
  for (const LeftOutRow& row : kitchen_leave_one_out(48)) {
    SCOPED_TRACE(row.setting + ", " + row.left_out);
    const LeftOutFigures& f = row.figures;
    EXPECT_GT(f.readings, 500U);
    EXPECT_GT(f.free_before, f.readings / 20);
    if (row.setting == "none, w = 1") {
      EXPECT_GT(rate(f), 0.05);
    } else if (row.setting == "Kinect") {
      EXPECT_LT(rate(f), 0.01);
    } else if (row.setting == "Kinect + pose") {
      EXPECT_EQ(f.violations, 0U);
    }
  }
}

}  // namespace
}  // namespace depthgrid::lab
