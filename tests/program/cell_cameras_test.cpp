// Cells whose cameras have drivers, with libraries of the tests' own in place of the makers'.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "program/command.hpp"

namespace depthgrid::test {
namespace {

using ::testing::HasSubstr;

constexpr const char* kFakeRealSense = "LD_LIBRARY_PATH='" FAKE_REALSENSE_FOLDER "' ";

std::string device_cell(const std::string& camera) {
  return R"(name: devices
smallest_obstacle_m: 0
cameras:
  - name: left
    intrinsics: {width_px: 640, height_px: 480, fx_px: 385, fy_px: 386, cx_px: 319.5, cy_px: 239.5}
    pose: {position_m: [0, 0, 0], quaternion_xyzw: [0, 0, 0, 1]}
    sensor: realsense_d435
    margins: {translation_m: 0.005, rotation_deg: 0.1, time_uncertainty_s: 0.005}
    )" + camera +
         R"(
space: {low_m: [-0.5, -0.5, 0.5], high_m: [0.9, 0.5, 1.9]}
policies: {unobserved: ignored, outside: ignored, robot_pockets: obstacle}
v_max_m_s: 0
memory: none
ask: {rate_hz: 100, points: [{name: hand, at_m: [0.2, 0, 1.2], radius_m: 0.05}], rho_m: 0.3}
outputs: {jsonl: answers.jsonl}
)";
}

TEST(CellCameras, ARealSenseIsCheckedAndRuns) {
  const TemporaryFolder folder;
  (void)folder.write("cell.yaml", device_cell("source: realsense"));
  const CommandResult check = run_command("cell check cell.yaml", folder, kFakeRealSense);
  EXPECT_EQ(check.exit_code, 0) << check.err << check.out;
  EXPECT_THAT(check.out, HasSubstr("left: Intel RealSense D435 (941322070001), 640 x 480 pixels, image of "));
  EXPECT_THAT(check.out, HasSubstr("by the clock of the device, as librealsense2 converts it to this computer's"));
  EXPECT_THAT(check.out, HasSubstr("    intrinsics: {width_px: 640, height_px: 480, fx_px: 385.000, fy_px: 386.000, "
                                   "cx_px: 319.500, cy_px: 239.500}, 1.000 mm a unit\n"
                                   "    preset 3, emitter 1, emitter on and off 0, global time 1, laser power 150\n"));
  const CommandResult run = run_command("run cell.yaml --seconds 3", folder, kFakeRealSense);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("left: open: Intel RealSense D435; preset 3, emitter 1"));
  EXPECT_THAT(run.out, ::testing::ContainsRegex("\n  left: [1-9][0-9]* images"));
}

TEST(CellCameras, AUnitThatIsNoMillimetreIsStated) {
  const TemporaryFolder folder;
  const std::string tenths = kFakeRealSense + std::string("FAKE_REALSENSE_UNIT=0.0001 ");
  (void)folder.write("cell.yaml", device_cell("source: realsense"));
  const CommandResult check = run_command("cell check cell.yaml", folder, tenths);
  EXPECT_EQ(check.exit_code, 1);
  EXPECT_THAT(check.out,
              HasSubstr("left: gives depth in units of 0.0001 m, the cell says 0.001: metres_per_unit: 0.0001"));
  (void)folder.write("cell.yaml", device_cell("source: realsense\n    metres_per_unit: 0.0001"));
  EXPECT_EQ(run_command("cell check cell.yaml", folder, tenths).exit_code, 0);
  const CommandResult run = run_command("run cell.yaml --seconds 3", folder, tenths);
  EXPECT_THAT(run.out, ::testing::ContainsRegex("\n  left: [1-9][0-9]* images"));
  EXPECT_EQ(run_command("cell new new.yaml", folder, tenths).exit_code, 0);
  EXPECT_THAT(read_bytes(folder / "new.yaml"), HasSubstr("\n    metres_per_unit: 0.0001\n"));
}

TEST(CellCameras, OtherIntrinsicsThanTheCamerasAreFoundByCheck) {
  const TemporaryFolder folder;
  std::string text = device_cell("source: realsense");
  text.replace(text.find("fx_px: 385"), 10, "fx_px: 420");
  (void)folder.write("cell.yaml", text);
  const CommandResult check = run_command("cell check cell.yaml", folder, kFakeRealSense);
  EXPECT_EQ(check.exit_code, 1);
  EXPECT_THAT(check.out, HasSubstr("left: says fx 385, fy 386, cx 320, cy 240 px, the cell says 420"));
}

TEST(CellCameras, OneOfSeveralHasToBeNamed) {
  const TemporaryFolder folder;
  (void)folder.write("cell.yaml", device_cell("source: realsense"));
  const std::string two = kFakeRealSense + std::string("FAKE_REALSENSE_SERIALS='111 222' ");
  const CommandResult check = run_command("cell check cell.yaml", folder, two);
  EXPECT_EQ(check.exit_code, 1);
  EXPECT_THAT(check.out, HasSubstr("failed: 2 RealSense are connected, serial: says which one: 111 ("));
  (void)folder.write("cell.yaml", device_cell("serial: '222'\n    source: realsense"));
  EXPECT_EQ(run_command("cell check cell.yaml", folder, two).exit_code, 0);
}

TEST(CellCameras, ARecordingOfARealSenseIsPlayed) {
  const TemporaryFolder folder;
  (void)folder.write("short.bag", "fakebag 20\n");
  (void)folder.write("cell.yaml", device_cell("source: realsense\n    recording: short.bag\n    repeat: true"));
  const CommandResult run = run_command("run cell.yaml --seconds 1.5", folder, kFakeRealSense);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("left: open: Intel RealSense D435, recording short.bag"));
  EXPECT_THAT(run.out, ::testing::ContainsRegex("\n  left: [1-9][0-9]* images"));
}

TEST(CellCameras, ANewFileHoldsThoseThatAreFound) {
  const TemporaryFolder folder;
  const CommandResult made =
      run_command("cell new cell.yaml", folder, kFakeRealSense + std::string("FAKE_REALSENSE_SERIALS='111 222' "));
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_THAT(made.out, HasSubstr("found realsense: Intel RealSense D435 (111)\n"
                                  "found realsense: Intel RealSense D435 (222)\n"));
  const std::string text = read_bytes(folder / "cell.yaml");
  EXPECT_THAT(text, HasSubstr("  - name: camera2  # Intel RealSense D435\n    source: realsense\n    serial: \"222\"\n"
                              "    intrinsics: {width_px: 640, height_px: 480, fx_px: 385.000, fy_px: 386.000, "
                              "cx_px: 319.500, cy_px: 239.500}   # the camera's own\n"));
  for (const char* command : {"cell check cell.yaml", "run cell.yaml --seconds 0.1"}) {
    EXPECT_THAT(run_command(command, folder, kFakeRealSense).err,
                HasSubstr("pose.position_m: 'measure' must be a finite number"));
  }
  for (int camera = 0; camera < 2; ++camera) {
    edit(folder, "cell.yaml", "position_m: [measure, measure, measure]", "position_m: [1.8, 0, 1.4]");
    edit(folder, "cell.yaml", "look_at_m: [measure, measure, measure]", "look_at_m: [0, 0, 0.5]");
    edit(folder, "cell.yaml", "translation_m: measure, rotation_deg: measure", "translation_m: 0.01, rotation_deg: 1");
  }
  edit(folder, "cell.yaml", "urdf: panda.urdf", "urdf: kuka_lwr4");
  edit(folder, "cell.yaml", "tool: panda_hand", "tool: lwr_7_link");
  const CommandResult show = run_command("cell show cell.yaml", folder);
  EXPECT_EQ(show.exit_code, 0) << show.err;
  EXPECT_THAT(show.out, ::testing::ContainsRegex("cameras.1..serial +222 "));
}

TEST(CellCameras, WhereNoneIsFoundTheExampleStays) {
  const TemporaryFolder folder;
  const CommandResult made =
      run_command("cell new cell.yaml", folder, "FAKE_REALSENSE_SERIALS='' " + std::string(kFakeRealSense));
  EXPECT_EQ(made.exit_code, 0) << made.err;
  if (made.out.find("found ") == std::string::npos) {  // this computer may have one of another kind
    EXPECT_THAT(made.out, HasSubstr("no camera with a driver was found: the cameras in the file are topics of ROS 2"));
    EXPECT_THAT(read_bytes(folder / "cell.yaml"), HasSubstr("topic: /left/depth/image_rect_raw"));
  }
}

TEST(CellCameras, WhatSaysNothingOfADeviceIsRefused) {
  const auto refused = [](const std::string& camera) {
    const TemporaryFolder folder;
    (void)folder.write("cell.yaml", device_cell(camera));
    return run_command("cell show cell.yaml", folder).err;
  };
  EXPECT_THAT(refused("source: realsense\n    topic: /a"), HasSubstr("topic: says nothing with source: realsense"));
  EXPECT_THAT(refused("source: realsense\n    repeat: true"),
              HasSubstr("repeat: says nothing of a camera that is there"));
  EXPECT_THAT(refused("source: realsense\n    recording: a.bag\n    serial: '7'"),
              HasSubstr("serial: says nothing of a recording"));
  EXPECT_THAT(refused("source: freenect\n    recording: a"),
              HasSubstr("recording: says nothing with source: freenect"));
  EXPECT_THAT(refused("source: openni\n    recording: a.oni"), HasSubstr("'mirrored' is missing"));
  EXPECT_THAT(refused("source: realsense\n    recording: a.bag\n    mirrored: true"),
              HasSubstr("mirrored: says nothing of this recording"));
  EXPECT_THAT(refused("source: simulated\n    arrival_lag_s: 0.03"),
              HasSubstr("arrival_lag_s: says nothing with source: simulated"));
}

}  // namespace
}  // namespace depthgrid::test
