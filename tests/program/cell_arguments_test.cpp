// A cell file in place of options: the same answers, and what is given beside it is told.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "program/command.hpp"
#include "program/robot_cell.hpp"

namespace depthgrid::test {
namespace {

using ::testing::HasSubstr;

std::string arm_cell() {
  return R"(name: arm
smallest_obstacle_m: 0
cameras:
  - {name: front, source: recording, recording: ., recorded_as: FIRST, margins: {constant_m: 0.002}}
  - {name: side, source: recording, recording: ., recorded_as: SECOND, margins: {constant_m: 0.002}}
robot:
  urdf: arm.urdf
  base: {position_m: [0.1, 0, 0.2], rpy_deg: [0, 0, 28.64788975654116]}
  joints: {source: recording, file: joints.csv, time_error_s: 0}
  padding_m: 0.02
space: {low_m: [-0.8, -0.8, -0.4], high_m: [1.6, 1.9, 1.7]}
policies: {unobserved: ignored, outside: ignored, robot_pockets: ignored, ignored_pocket_m: 0.6}
v_max_m_s: 0
memory: none
ask: {links: moving, rho_m: 0.6, points: [{name: spot, at_m: [0.6, 0.3, 0.9], radius_m: 0.05}]}
)";
}

void write_arm(const TemporaryFolder& folder) {
  robot_cell::write_cell(folder);
  const files::RigFile file = robot_cell::rig_file();
  (void)folder.write("cell.yaml", arm_cell());
  edit(folder, "cell.yaml", "FIRST", file.rig.cameras.at(0).id);
  edit(folder, "cell.yaml", "SECOND", file.rig.cameras.at(1).id);
}

TEST(CellArguments, LinksAreAnsweredAsWithOptions) {
  const TemporaryFolder folder;
  write_arm(folder);
  const CommandResult by_options =
      run_command(robot_cell::kQuestion + robot_cell::kRobot + "--robot-padding 0.02 --smallest-obstacle 0", folder);
  ASSERT_EQ(by_options.exit_code, 0) << by_options.err;
  const CommandResult by_cell = run_command("distances cell.yaml", folder);
  EXPECT_EQ(by_cell.exit_code, 0) << by_cell.err;
  EXPECT_EQ(by_cell.out, by_options.out);
  EXPECT_THAT(by_cell.out, HasSubstr("fore"));
  EXPECT_THAT(by_cell.err, HasSubstr("distances asks links or points; here the links"));
}

TEST(CellArguments, PointsAreAnsweredAsWithOptions) {
  const TemporaryFolder folder;
  write_arm(folder);
  edit(folder, "cell.yaml", "links: moving, ", "");
  const CommandResult by_options = run_command(robot_cell::kQuestion + robot_cell::kRobot +
                                                   "--robot-padding 0.02 --smallest-obstacle 0 "
                                                   "--point spot=0.6,0.3,0.9,0.05",
                                               folder);
  ASSERT_EQ(by_options.exit_code, 0) << by_options.err;
  const CommandResult by_cell = run_command("distances cell.yaml", folder);
  EXPECT_EQ(by_cell.out, by_options.out) << by_cell.err;
}

TEST(CellArguments, OptionsBesideItOverrideAndAreTold) {
  const TemporaryFolder folder;
  write_arm(folder);
  const CommandResult by_options =
      run_command(robot_cell::kQuestion + robot_cell::kRobot + "--robot-padding 0.05 --smallest-obstacle 0", folder);
  const CommandResult by_cell = run_command("distances cell.yaml --robot-padding 0.05", folder);
  EXPECT_EQ(by_cell.out, by_options.out) << by_cell.err;
  EXPECT_THAT(by_cell.err, HasSubstr("depthgrid: warning: --robot-padding in place of padding_m of cell.yaml\n"));
}

TEST(CellArguments, WhatOptionsCannotSayIsRefused) {
  const TemporaryFolder folder;
  write_arm(folder);
  const auto refused = [&](const char* what, const char* by, const char* words) {
    (void)folder.write("other.yaml", read_bytes(folder / "cell.yaml"));
    edit(folder, "other.yaml", what, by);
    const CommandResult result = run_command("distances other.yaml", folder);
    EXPECT_EQ(result.exit_code, 2) << by;
    EXPECT_THAT(result.err, HasSubstr(words));
  };
  refused("constant_m: 0.002}", "constant_m: 0.003}", "cameras[1]: sensor, margins and smallest_obstacle_m differ");
  refused("recording: ., ", "recording: elsewhere, ", "recording: . is another than elsewhere");
  refused("padding_m: 0.02", "padding_m: 0.02\n  margin_in_test: true", "margin_in_test: distances has no such option");
  refused("urdf: arm.urdf", "urdf: kuka_lwr4", "is built in for running cells");
  refused("{source: recording, file: joints.csv,", "{source: ros2,", "joints: distances takes those of a recording");
  refused("links: moving", "links: [fore]", "distances asks all that move");
  EXPECT_EQ(run_command("distances cell.yaml --method letter", folder).exit_code, 2);
}

TEST(CellArguments, InfoAndRobotTakeItToo) {
  const TemporaryFolder folder;
  write_arm(folder);
  const CommandResult info = run_command("info cell.yaml", folder);
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_EQ(info.out, run_command("info .", folder).out);
  const CommandResult robot = run_command("robot cell.yaml", folder);
  EXPECT_EQ(robot.exit_code, 0) << robot.err;
  EXPECT_EQ(robot.out, run_command("robot arm.urdf", folder).out);
  edit(folder, "cell.yaml", "urdf: arm.urdf", "urdf: kuka_lwr4");
  EXPECT_EQ(run_command("robot cell.yaml", folder).exit_code, 2);
}

}  // namespace
}  // namespace depthgrid::test
