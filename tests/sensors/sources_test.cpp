#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/files/png.hpp"
#include "depthgrid/files/rig_file.hpp"
#include "depthgrid/robot/kuka_lwr4.hpp"
#include "depthgrid/sensors/clock.hpp"
#include "depthgrid/sensors/playback.hpp"
#include "depthgrid/sensors/recorded_camera.hpp"
#include "depthgrid/sensors/recorded_joints.hpp"
#include "depthgrid/sensors/simulated_camera.hpp"
#include "depthgrid/sensors/simulated_joints.hpp"
#include "files/temporary_folder.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::sensors {
namespace {

using ::testing::HasSubstr;

constexpr int kFrames = 5;
constexpr double kRate_hz = 50;

/// Camera "left": frame i is i + 1 metres away everywhere.
void write_recording(const test::TemporaryFolder& folder, bool with_rate = true) {
  files::RigFile file;
  file.rig.name = "short";
  RigCamera camera;
  camera.id = "left";
  camera.intrinsics = {16, 12, 15.0, 15.0, 8.0, 6.0};
  file.rig.cameras.push_back(camera);
  file.depth_files.emplace_back("left_%03d.png");
  file.frame_count = kFrames;
  if (with_rate) {
    file.rate_hz = kRate_hz;
  }
  files::save_rig(file, folder / "rig.json");
  for (int i = 0; i < kFrames; ++i) {
    const std::vector<std::uint16_t> wall(16 * 12, static_cast<std::uint16_t>(1000 * (i + 1)));
    files::write_png_gray16(folder / files::depth_file_name("left_%03d.png", i), 16, 12, wall);
  }
}

std::uint16_t first_pixel(const DepthView& depth) {
  std::uint16_t value = 0;
  std::memcpy(&value, depth.data, sizeof value);
  return value;
}

TEST(RecordedCamera, AsFastAsAskedEveryImageComesWithItsOwnTime) {
  const test::TemporaryFolder folder;
  write_recording(folder);
  const RecordedSpan span = recorded_span(folder.path(), "left");
  EXPECT_NEAR(span.last_s - span.first_s, (kFrames - 1) / kRate_hz, 1e-12);
  const auto playback = std::make_shared<const Playback>(span.first_s, span.last_s, true, Pace::as_fast_as_asked);
  RecordedCamera camera(folder.path(), "left", playback);
  DepthReading reading;
  EXPECT_EQ(camera.next(reading, 0), Reading::failed) << "not open yet";
  camera.open();
  EXPECT_EQ(camera.info().serial, "left");
  EXPECT_EQ(camera.info().intrinsics->width_px, 16);
  for (int i = 0; i < kFrames; ++i) {
    ASSERT_EQ(camera.next(reading, 0), Reading::got);
    EXPECT_NEAR(reading.time_s, i / kRate_hz, 1e-12);
    EXPECT_EQ(first_pixel(reading.depth), 1000 * (i + 1));
    EXPECT_EQ(reading.skipped, 0);
  }
  EXPECT_EQ(camera.next(reading, 0), Reading::ended);
  EXPECT_EQ(camera.next(reading, 0), Reading::ended);
}

TEST(RecordedCamera, AsRecordedNoImageComesBeforeItsTimeAndLateOnesArePassedOver) {
  const test::TemporaryFolder folder;
  write_recording(folder);
  const auto playback = std::make_shared<const Playback>(0, (kFrames - 1) / kRate_hz, false);
  RecordedCamera camera(folder.path(), "left", playback);
  camera.open();
  DepthReading reading;
  (void)wait_until(playback->clock_s(2.2 / kRate_hz, 0), 1);
  ASSERT_EQ(camera.next(reading, 1), Reading::got);
  EXPECT_GE(reading.skipped, 2);
  std::int64_t images = 1 + reading.skipped;
  while (camera.next(reading, 1) == Reading::got) {
    EXPECT_LE(reading.time_s, clock_now_s());
    images += 1 + reading.skipped;
  }
  EXPECT_EQ(images, kFrames);
}

TEST(RecordedCamera, ARecordingThatRepeatsGoesOnWithLaterTimes) {
  const test::TemporaryFolder folder;
  write_recording(folder);
  const double length_s = (kFrames - 1) / kRate_hz;
  const auto playback = std::make_shared<const Playback>(0, length_s, true);
  RecordedCamera camera(folder.path(), "left", playback);
  camera.open();
  DepthReading reading;
  double last_s = 0;
  double largest_gap_s = 0;
  bool came_back = false;
  while (!came_back) {
    const Reading result = camera.next(reading, 1);
    ASSERT_EQ(result, Reading::got);
    EXPECT_GT(reading.time_s, last_s);
    largest_gap_s = last_s > 0 ? std::max(largest_gap_s, reading.time_s - last_s) : 0;
    came_back = last_s > playback->clock_s(length_s, 0) - 1e-9;
    last_s = reading.time_s;
  }
  EXPECT_NEAR(largest_gap_s, Playback::kPause_s, 0.1) << "the end says nothing of the beginning";
}

TEST(RecordedCamera, WhatCannotBePlayedIsRefused) {
  const test::TemporaryFolder folder;
  write_recording(folder, false);
  EXPECT_THAT(test::thrown_message([&] { (void)recorded_span(folder.path(), "left"); }), HasSubstr("says no times"));
  EXPECT_THAT(test::thrown_message([&] { (void)recorded_span(folder.path(), "right"); }), HasSubstr("right"));
  EXPECT_THROW(Playback(1, 0, false), Error);
}

TEST(RecordedCamera, AFileThatIsGoneFailsWithItsName) {
  const test::TemporaryFolder folder;
  write_recording(folder);
  const auto playback = std::make_shared<const Playback>(0, 1, false, Pace::as_fast_as_asked);
  RecordedCamera camera(folder.path(), "left", playback);
  camera.open();
  DepthReading reading;
  ASSERT_EQ(camera.next(reading, 0), Reading::got);
  std::filesystem::remove(folder / "left_001.png");
  EXPECT_EQ(camera.next(reading, 0), Reading::failed);
  EXPECT_THAT(std::string(camera.reason()), HasSubstr("left_001.png"));
  EXPECT_EQ(camera.next(reading, 0), Reading::got) << "the next one is there";
}

TEST(RecordedJoints, RowsComeInOrderInRadians) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("joints.csv", "time_s,a [deg],b\n10.00,180,0.5\n10.01,90,0.6\n10.02,0,0.7\n");
  const auto playback = std::make_shared<const Playback>(10, 10.02, false, Pace::as_fast_as_asked);
  RecordedJoints joints(file, {"a", "b"}, playback);
  joints.open();
  JointReading reading;
  ASSERT_EQ(joints.next(reading, 0), Reading::got);
  EXPECT_NEAR(reading.q[0], 3.14159265358979, 1e-12);
  EXPECT_EQ(reading.q[1], 0.5);
  EXPECT_EQ(reading.time_s, 10.0);
  ASSERT_EQ(joints.next(reading, 0), Reading::got);
  ASSERT_EQ(joints.next(reading, 0), Reading::got);
  EXPECT_EQ(reading.q[1], 0.7);
  EXPECT_EQ(joints.next(reading, 0), Reading::ended);
  RecordedJoints others(file, {"a", "c"}, playback);
  EXPECT_THAT(test::thrown_message([&] { others.open(); }), HasSubstr("no column for joint c"));
}

std::shared_ptr<const SimulatedCell> cell_with_robot() {
  SimulatedCellSettings settings;
  settings.robot = robot::PlacedRobot{robot::kuka_lwr4(), Pose::Identity()};
  return std::make_shared<const SimulatedCell>(settings);
}

RigCamera camera_at(const Eigen::Vector3d& place, const char* sensor) {
  RigCamera camera;
  camera.id = "camera";
  camera.intrinsics = {80, 60, 60.0, 60.0, 40.0, 30.0};
  camera.T_world_camera = look_at(place, {0, 0, 0.4});
  camera.sensor = sensor;
  return camera;
}

TEST(SimulatedCamera, ImagesAreOfTheirTimeAndNoneComesTwice) {
  const auto cell = cell_with_robot();
  const RigCamera camera = camera_at({2.3, -1.6, 1.4}, "kinect_v1");
  SimulatedCamera source(cell, camera, 50, 1);
  source.open();
  DepthReading reading;
  double last_s = 0;
  std::vector<std::uint16_t> before;
  for (int i = 0; i < 6; ++i) {
    Reading result = Reading::nothing;
    while (result == Reading::nothing) {
      result = source.next(reading, 0.1);
    }
    ASSERT_EQ(result, Reading::got);
    EXPECT_GT(reading.time_s, last_s);
    EXPECT_LE(reading.time_s, clock_now_s());
    last_s = reading.time_s;
    const auto* pixels = static_cast<const std::uint16_t*>(reading.depth.data);
    const std::vector<std::uint16_t> now(pixels, pixels + 80 * 60);
    EXPECT_NE(now, before) << "noise differs from image to image";
    before = now;
    EXPECT_GT(std::count_if(now.begin(), now.end(), [](std::uint16_t unit) { return unit > 500; }), 1000);
  }
}

TEST(SimulatedCamera, LateImagesArePassedOverAndCounted) {
  SimulatedCamera source(cell_with_robot(), camera_at({2.3, -1.6, 1.4}, ""), 100, 0);
  source.open();
  DepthReading reading;
  ASSERT_NE(source.next(reading, 0.1), Reading::failed);
  (void)wait_until(clock_now_s() + 0.1, 1);
  const double asked_s = clock_now_s();
  ASSERT_EQ(source.next(reading, 0.1), Reading::got);
  EXPECT_GE(reading.skipped, 5);
  EXPECT_GT(reading.time_s, asked_s - 0.011) << "the newest, not the oldest";
}

TEST(SimulatedCell, TheArmStaysWithinItsLimitsAndNobodyJumps) {
  const auto cell = cell_with_robot();
  const robot::RobotModel model = robot::kuka_lwr4();
  std::vector<double> q(7);
  std::vector<double> before(7);
  constexpr double kStep_s = 0.01;
  for (double time_s = 0; time_s < 20; time_s += kStep_s) {
    cell->joints_at(time_s, q);
    for (std::size_t i = 0; i < q.size(); ++i) {
      EXPECT_GE(q[i], model.joints()[i].lower);
      EXPECT_LE(q[i], model.joints()[i].upper);
      if (time_s > 0) {
        EXPECT_LE(std::abs(q[i] - before[i]), model.joints()[i].max_speed * kStep_s);
      }
    }
    before = q;
  }
}

TEST(SimulatedJoints, StatesAreOfNowAndAscend) {
  const auto cell = cell_with_robot();
  SimulatedJoints joints(cell, 200);
  joints.open();
  JointReading reading;
  double last_s = 0;
  for (int i = 0; i < 20; ++i) {
    while (joints.next(reading, 0.05) == Reading::nothing) {
    }
    EXPECT_GT(reading.time_s, last_s);
    last_s = reading.time_s;
    std::vector<double> q(7);
    cell->joints_at(reading.time_s - cell->begin_s(), q);
    EXPECT_EQ(std::vector<double>(reading.q.begin(), reading.q.end()), q);
  }
  EXPECT_THROW(SimulatedJoints(std::make_shared<const SimulatedCell>(SimulatedCellSettings{}), 100), Error);
}

}  // namespace
}  // namespace depthgrid::sensors
