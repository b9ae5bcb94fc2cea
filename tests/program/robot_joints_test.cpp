// depthgrid distances --joints: the file of joint positions, its times and units.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

#include "program/robot_cell.hpp"

namespace depthgrid::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using namespace robot_cell;

TEST(RobotInRecording, JointsOverTimeAreThoseOfTheImages) {
  const TemporaryFolder folder;
  write_cell(folder);
  const auto by_frame = run_command(kQuestion + kRobot + "--robot-padding 0.02", folder);
  // The frames are 0 and 0.1 s; between the rows around 0.1 s the positions of frame 4 lie.
  (void)folder.write("joints.csv",
                     "time_ns,pan,tilt\n0,0.2,-0.3\n50000000,0.2,-0.3\n90000000,-0.5,0.3\n110000000,-0.7,0.5\n");
  const std::string question = kQuestion + kRobot + "--robot-padding 0.02 --joint-speed 1 ";
  const auto by_time = run_command(question, folder);
  EXPECT_EQ(by_time.out, by_frame.out) << by_time.err;
  (void)folder.write("joints.csv",
                     "time_s,pan,tilt\n1700000000,0.2,-0.3\n1700000000.09,-0.6,0.4\n1700000000.18,-0.6,0.4\n");
  const auto other_clock = run_command(question, folder);
  EXPECT_EQ(other_clock.exit_code, 1);
  EXPECT_THAT(other_clock.err, AllOf(HasSubstr("joints.csv: frame 3, camera 'left', at"),
                                     HasSubstr("before the first row"), HasSubstr("--joint-time-offset")));
  EXPECT_EQ(run_command(question + "--joint-time-offset -1700000000", folder).exit_code, 0);
  (void)folder.write("joints.csv", "time_s,pan,tilt\n-0.2,0.2,-0.3\n0.2,-0.6,0.4\n");
  EXPECT_THAT(run_command(question, folder).err, HasSubstr("--joint-gap"));
  EXPECT_EQ(run_command(question + "--joint-gap 0.5", folder).exit_code, 0);
  // Images may be beside the joints in time: then speeds count, and pan has none.
  const auto speed = run_command(kQuestion + kRobot + "--joint-gap 0.5 --joint-time-error 0.01", folder);
  EXPECT_EQ(speed.exit_code, 2);
  EXPECT_THAT(speed.err, AllOf(HasSubstr("'pan'"), HasSubstr("--joint-speed")));
  auto file = rig_file();
  file.rate_hz.reset();
  files::save_rig(file, folder / "rig.json");
  EXPECT_THAT(run_command(question, folder).err, AllOf(HasSubstr("rate_hz"), HasSubstr("column 'frame'")));
}

/// From -0.5 to -0.7, told a whole turn later.
TEST(RobotInRecording, AJointWithoutLimitsMayBeToldAWholeTurnLater) {
  const TemporaryFolder folder;
  write_cell(folder);
  std::string urdf = kUrdf;
  urdf.replace(urdf.find("revolute"), 8, "continuous");
  (void)folder.write("arm.urdf", urdf);
  const std::string question = kQuestion + kRobot + "--robot-padding 0.02 --joint-speed 1 --frames 4 ";
  const auto told = [&](const std::string& last) {
    (void)folder.write("joints.csv", "time_s,pan,tilt\n0.09,-0.5,0.3\n0.11," + last + ",0.5\n");
    return column(run_command(question, folder), "distance_m");
  };
  const auto before = told("-0.7");
  const auto after_a_turn = told("5.583185307179586");
  ASSERT_EQ(before.size(), 2U);
  for (const auto& [link, distance] : before) {
    EXPECT_NEAR(std::stod(after_a_turn.at(link)), std::stod(distance), 1e-5) << link;
  }
}

TEST(RobotInRecording, DegreesAreRefusedUnlessTheyAreStated) {
  const TemporaryFolder folder;
  write_cell(folder);
  const std::string question = kQuestion + kRobot + "--robot-padding 0.02 ";
  const auto radians = run_command(question, folder);
  const std::string rows = "3,11.459155902616466,-17.188733853924695\n4,-34.37746770784939,22.91831180523293\n";
  (void)folder.write("joints.csv", "frame,pan,tilt\n" + rows);
  const auto guessed = run_command(question, folder);
  EXPECT_EQ(guessed.exit_code, 1);
  EXPECT_THAT(guessed.err,
              AllOf(HasSubstr("joints.csv: line 2"), HasSubstr("'pan'"), HasSubstr("--joint-unit degrees")));
  const auto stated = run_command(question + "--joint-unit degrees", folder);
  EXPECT_EQ(stated.out, radians.out) << stated.err;
  EXPECT_THAT(stated.err, HasSubstr("angles in degrees"));
  (void)folder.write("joints.csv", "frame,pan_deg,tilt_deg\n" + rows);
  EXPECT_EQ(run_command(question, folder).out, radians.out) << "the columns say it";
  (void)folder.write("joints.csv", "frame,pan_deg,tilt_rad\n3,11.459155902616466,-0.3\n4,-34.37746770784939,0.4\n");
  const auto mixed = run_command(question, folder);
  EXPECT_EQ(mixed.out, radians.out) << mixed.err;
  EXPECT_THAT(mixed.err, HasSubstr("angles in degrees and radians\n"));
}

/// --joint-unit is of angles: a finger in millimetres would stand 40 m away, and the arm be an obstacle where it is.
TEST(RobotInRecording, SlidesAreMetresWhateverTheUnitOfAngles) {
  const TemporaryFolder folder;
  write_cell(folder);
  std::string urdf = kUrdf;
  urdf.replace(urdf.find("type=\"fixed\""), 12, "type=\"prismatic\"");
  const std::string limit = R"(<axis xyz="0 1 0"/><limit lower="0" upper="0.05" velocity="1"/></joint>)"
                            "\n</robot>";
  urdf.replace(urdf.rfind("</joint>"), std::string::npos, limit);
  (void)folder.write("arm.urdf", urdf);
  const auto run = [&](const std::string& rows, const std::string& options) {
    (void)folder.write("joints.csv", rows);
    return run_command(kQuestion + kRobot + "--robot-padding 0.02 " + options, folder);
  };
  const std::string radians = "3,0.2,-0.3,0\n4,-0.6,0.4,0\n";
  EXPECT_EQ(run("frame,pan,tilt,grip\n" + radians, "").exit_code, 0);
  for (const std::string options : {"", "--joint-unit radians", "--joint-unit degrees"}) {
    for (const std::string header : {"frame,pan,tilt,grip\n", "frame,pan,tilt,grip_m\n"}) {
      const auto result = run(header + "3,0.2,-0.3,40\n4,-0.6,0.4,0\n", options);
      EXPECT_EQ(result.exit_code, 1) << header << options;
      EXPECT_THAT(result.err, AllOf(HasSubstr("joints.csv: line 2"), HasSubstr("joint 'grip' at 40 m is beyond"),
                                    HasSubstr("are these millimetres?")));
    }
  }
  const auto still = run("frame,pan,tilt\n3,0.2,-0.3\n4,-0.6,0.4\n", "--joint grip=40");
  EXPECT_EQ(still.exit_code, 2);
  EXPECT_THAT(still.err, HasSubstr("is this one in millimetres?"));
}

}  // namespace
}  // namespace depthgrid::test
