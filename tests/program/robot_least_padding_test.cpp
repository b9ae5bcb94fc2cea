// depthgrid distances --least-padding: what it tells, and what it refuses.
#include <gmock/gmock.h>

#include <algorithm>
#include <string>

#include "program/robot_cell.hpp"

namespace depthgrid::test {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using namespace robot_cell;

TEST(RobotInRecording, TheLeastPaddingIsToldWithTheCameraThatDecides) {
  const TemporaryFolder folder;
  write_cell(folder);
  const auto told = run_command(kQuestion + kRobot + "--least-padding", folder);
  EXPECT_EQ(told.exit_code, 0) << told.err;
  EXPECT_THAT(told.out, AllOf(HasSubstr("link  least padding"), HasSubstr("\nfore  0.010 m"),
                              HasSubstr("\nhand  0.010 m"), HasSubstr("\nSo state --robot-padding 0.010\n")));
  // The model is 2.5 cm beside the robot, towards the left camera: what it reads behind is the robot's, and more.
  const std::string beside = kQuestion + "--urdf arm.urdf --joints joints.csv --frames 4 --robot-within 0.2 ";
  const auto moved = run_command(beside + "--base 0.1,0.025,0.2,0,0,0.5 --least-padding", folder);
  EXPECT_EQ(moved.exit_code, 0) << moved.err;
  const std::string padding = after(moved.out, "So state --robot-padding ");
  ASSERT_GE(std::stod(padding), 0.02) << moved.out;
  ASSERT_LE(std::stod(padding), 0.1) << moved.out;
  EXPECT_THAT(moved.out, ContainsRegex("(fore|hand) decides, by camera '(left|right)'"));
  // With that padding the links are clear, and with less one is not.
  const auto left_m = [&](double padding_m) {
    const std::string question = kQuestion +
                                 "--urdf arm.urdf --joints joints.csv --frames 4 --base 0.1,0.025,0.2,0,0,0.5 "
                                 "--robot-padding " +
                                 std::to_string(padding_m);
    const auto answers = run_command(question, folder);
    const auto distances = column(answers, "distance_m");
    const auto layers = column(answers, "blind_m");
    double least_m = 1;
    for (const auto& [name, distance_m] : distances) {
      least_m = std::min(least_m, std::stod(distance_m) - std::stod(layers.at(name)));
    }
    return least_m;
  };
  EXPECT_GE(left_m(std::stod(padding)), 0.1 - 1e-5);
  EXPECT_LT(left_m(std::stod(padding) - 0.005), 0.1);
}

TEST(RobotInRecording, TheLeastPaddingAnswersNothingElse) {
  const TemporaryFolder folder;
  write_cell(folder);
  const auto refused = [&](const std::string& more) {
    const auto result = run_command(kQuestion + kRobot + more, folder);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(result.out, "");
    return result.err;
  };
  EXPECT_THAT(refused("--least-padding --robot-padding 0.02"), HasSubstr("leave out --robot-padding 0.02"));
  EXPECT_THAT(refused("--least-padding --point 0,0,1"), HasSubstr("--least-padding asks for the robot's links"));
  EXPECT_THAT(refused("--least-padding --pictures p"), HasSubstr("--pictures has no effect with --least-padding"));
  EXPECT_THAT(refused("--least-padding --reasons"), HasSubstr("--reasons has no effect"));
  const auto elsewhere =
      run_command(kQuestion + "--urdf arm.urdf --joints joints.csv --base 0,-30,0 --least-padding", folder);
  EXPECT_EQ(elsewhere.exit_code, 1);
  EXPECT_THAT(elsewhere.err, HasSubstr("in no image of these frames, so they say nothing of its padding; is --base"));
  // 8 cm beside the robot, whose own pixels are left then, and farther away than a layer may cover.
  const auto beside = run_command(kQuestion +
                                      "--urdf arm.urdf --joints joints.csv --base 0.1,0.08,0.2,0,0,0.5 --frames 4 "
                                      "--robot-within 0.05 --least-padding",
                                  folder);
  EXPECT_EQ(beside.exit_code, 0) << beside.err;
  EXPECT_THAT(beside.out, AllOf(HasSubstr("State no padding by this"), Not(HasSubstr("So state"))));
  EXPECT_THAT(beside.err, HasSubstr("show its capsules: taken"));
  EXPECT_THAT(refused("--least-padding --robot-within 250"), HasSubstr("is it in millimetres?"));
  EXPECT_THAT(refused("--least-padding --robot-within=-0.1"), HasSubstr("must be 0 to 1 m"));
  EXPECT_THAT(refused("--robot-within 0.1"), HasSubstr("no effect without --least-padding"));
  const auto none = run_command(kQuestion + "--least-padding", folder);
  EXPECT_THAT(none.err, HasSubstr("--least-padding has no effect without a robot"));
}

}  // namespace
}  // namespace depthgrid::test
