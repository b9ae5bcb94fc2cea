// depthgrid distances --urdf: a robot in a recording.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "depthgrid/files/recording.hpp"
#include "program/distances/recorded_robot.hpp"
#include "program/picture_colours.hpp"
#include "program/robot_cell.hpp"

namespace depthgrid::test {
namespace {

using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using namespace robot_cell;

TEST(RobotInRecording, ItsPixelsAreTakenAndTheObstaclesStay) {
  const TemporaryFolder folder;
  write_cell(folder);
  program::RecordedRobotOptions options;
  options.robot.file = folder / "arm.urdf";
  options.joints_file = folder / "joints.csv";
  options.base = "0.1,0,0.2,0,0,0.5";
  options.padding_m = 0.02;
  files::Recording recording(folder.path());
  program::RecordedRobot robot(options, recording.rig(), Pose::Identity(),
                               {.known = true, .stamped = false, .start_s = 0});
  long robots = 0;
  long obstacles = 0;
  for (int index = 0; index < 2; ++index) {
    const int number = recording.frame_number(index);
    const auto links = links_at(kFrames.at(number));
    const auto frames = robot.frames(number, recording.read(index), recording.rig());
    for (std::size_t k = 0; k < 2; ++k) {
      const RigCamera& camera = recording.rig().cameras[k];
      const auto depth_m = [&](const std::vector<Capsule>& arm, bool obstacle) {
        return scene(arm, obstacle).render(camera.intrinsics, camera.T_world_camera).depth_m;
      };
      const DepthImage all = depth_m(links, true);
      const DepthImage no_robot = depth_m({}, true);
      const DepthImage no_obstacle = depth_m(links, false);
      EXPECT_NE(frames[k].robot.near_m, nullptr);
      for (int v = 0; v < 240; ++v) {
        for (int u = 0; u < 320; ++u) {
          const program::RobotPixel kind = robot.pixels()[k][all.index(u, v)];
          const bool taken = kind == program::RobotPixel::removed || kind == program::RobotPixel::in_padding;
          if (all.at(u, v) < no_robot.at(u, v)) {
            ++robots;
            ASSERT_EQ(kind, program::RobotPixel::removed) << "frame " << number << ", pixel " << u << ", " << v;
          }
          const Vector3d p = camera.T_world_camera * deproject(camera.intrinsics, {u + 0.5, v + 0.5, all.at(u, v)});
          if (distance_m(links, p) > 0.02 + 0.01) {  // padding, and half a pixel's diagonal
            obstacles += all.at(u, v) < no_obstacle.at(u, v) ? 1 : 0;
            ASSERT_FALSE(taken) << "frame " << number << ", pixel " << u << ", " << v;
          }
        }
      }
    }
  }
  EXPECT_GT(robots, 5000);
  EXPECT_GT(obstacles, 500);
}

TEST(RobotInRecording, AsksForOneDistanceALinkAFrame) {
  const TemporaryFolder folder;
  write_cell(folder);
  const auto distances = column(run_command(kQuestion + kRobot + "--robot-padding 0.02", folder), "distance_m");
  ASSERT_EQ(distances.size(), 4U) << "the upper link turns about its own foot, which one joint moves";
  for (const auto& [frame, q] : kFrames) {
    const auto links = links_at(q);
    const Vector3d p = kObstacle.a;
    const double fore_m = distance_m({links[1]}, p) - kObstacle.radius_m;
    const double hand_m = distance_m({links[2], links[3]}, p) - kObstacle.radius_m;
    for (const auto& [name, truth_m] : {std::pair("fore", fore_m), std::pair("hand", hand_m)}) {
      const double answer_m = std::stod(distances.at(std::to_string(frame) + " " + name));
      EXPECT_LE(answer_m, std::min(truth_m, 0.6) + 1e-6) << frame << " " << name;
      EXPECT_GT(answer_m, std::min(truth_m, 0.2) - 0.08) << frame << " " << name;
    }
  }
}

/// The same places without a robot: what the cameras see there is the robot itself.
TEST(RobotInRecording, IsItsOwnObstacleWhereItIsNotTaken) {
  const TemporaryFolder folder;
  write_cell(folder);
  const Capsule hand = links_at(kFrames.at(3))[2];
  std::ostringstream point;
  point << "--frames 3 --point hand=" << hand.a.x() << ',' << hand.a.y() << ',' << hand.a.z() << ",0.05 ";
  EXPECT_EQ(std::stod(column(run_command(kQuestion + point.str(), folder), "distance_m").at("3 hand")), 0);
  const auto with = run_command(kQuestion + point.str() + kRobot + "--robot-padding 0.02", folder);
  EXPECT_GT(std::stod(column(with, "distance_m").at("3 hand")), 0.05);
  EXPECT_EQ(column(with, "distance_m").size(), 1U) << "points that are given are asked for instead of the links";
}

TEST(RobotInRecording, SaysWhatWasTakenAndWhatNot) {
  const TemporaryFolder folder;
  write_cell(folder);
  const auto good = run_command(kQuestion + kRobot + "--robot-padding 0.02", folder);
  EXPECT_THAT(good.err, HasSubstr("joints.csv: 2 rows, by frame number, angles in radians\n"));
  for (const std::string camera : {"left", "right"}) {
    EXPECT_THAT(good.err,
                ContainsRegex("camera '" + camera +
                              "', 2 images: [0-9 ]+ pixels taken for the robot, [0-9 ]+ of them beside its "
                              "capsules; [0-9 ]+ show its capsules: taken 100.0 %, not because the reading is "
                              "farther 0.0 %, nearer 0.0 %, missing 0.0 %\n"));
  }
  // The model 10 cm beside the robot: what it shows is read farther, or nearer.
  const auto off = run_command(kQuestion +
                                   "--urdf arm.urdf --joints joints.csv --base 0.1,0,0.3,0,0,0.5 "
                                   "--robot-padding 0.02",
                               folder);
  EXPECT_THAT(off.err, Not(HasSubstr("taken 100.0 %")));
  EXPECT_THAT(off.err, Not(HasSubstr("farther 0.0 %")));
}

TEST(RobotInRecording, APaddingBelowTheSensorsMarginIsSaidWithTheOneToState) {
  const TemporaryFolder folder;
  write_cell(folder);
  std::string question = kQuestion + kRobot + "--frames 3 ";
  question.replace(question.find("0.002"), 5, "0.03");  // the margin
  const auto thin = run_command(question + "--robot-padding 0.01", folder);
  EXPECT_THAT(thin.err, HasSubstr("camera 'left': --robot-padding 0.01 is less "));
  const std::string stated = after(thin.err, "state at least --robot-padding ");
  EXPECT_THAT(thin.err, HasSubstr("within the sensor's margin of the padding's front"));
  const auto enough = run_command(question + "--robot-padding " + stated, folder);
  EXPECT_THAT(enough.err, Not(HasSubstr("camera 'left': --robot-padding")));
  // Along the ray to the corner of the left image, and no more.
  EXPECT_NEAR(std::stod(stated), 0.03 * std::hypot(1, std::hypot(160, 120) / 260), 0.001);
}

TEST(RobotInRecording, ThePaddingIsComparedWithTheMarginsOfEachCamera) {
  const TemporaryFolder folder;
  write_cell(folder);
  auto file = rig_file();
  file.rig.cameras[0].margins = CameraMargins{.sensor = {0.002, 0, 0, 0}, .smallest_obstacle_m = 0};
  file.rig.cameras[1].margins = CameraMargins{.sensor = {0.03, 0, 0, 0}, .smallest_obstacle_m = 0};
  files::save_rig(file, folder / "rig.json");
  std::string question = kQuestion + kRobot + "--frames 3 --robot-padding 0.01 ";
  question.erase(question.find("--margin-constant"), 24);
  const auto result = run_command(question, folder);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, Not(HasSubstr("camera 'left': --robot-padding")));
  EXPECT_THAT(result.err, HasSubstr("camera 'right': --robot-padding 0.01 is less "));
}

// The robot stands still, but its joints might have moved: one at the speed of the URDF, the other as stated.
TEST(RobotInRecording, AnImageBesideTheJointsThickensTheLayer) {
  const TemporaryFolder folder;
  write_cell(folder);
  (void)folder.write("joints.csv", "time_s,pan,tilt\n-0.3,0.2,-0.3\n0.3,0.2,-0.3\n");
  const auto layer_m = [&](const std::string& options) {
    const std::string question = kQuestion + kRobot + "--robot-padding 0.02 --frames 3 --joint-gap 1 ";
    return std::stod(column(run_command(question + options, folder), "blind_m").at("3 hand"));
  };
  const double exact_m = layer_m("--joint-time-error 0 --joint-speed 0");
  const double of_urdf_m = layer_m("--joint-time-error 0.1 --joint-speed 0");
  EXPECT_GT(of_urdf_m, exact_m + 0.03) << "0.1 rad at 0.4 m";
  EXPECT_GT(layer_m("--joint-time-error 0.1 --joint-speed 1"), of_urdf_m + 0.05);
}

// Rows by frame number say nothing of the images' times: what is remembered grows by those.
TEST(RobotInRecording, ImagesKeepTheirTimesWhateverTheRowsAreOf) {
  const TemporaryFolder folder;
  write_cell(folder);
  std::string question = kQuestion + kRobot + "--robot-padding 0.02 --half-exposure 0 --memory unknown ";
  question.replace(question.find("--v-max 0"), 9, "--v-max 0.5");
  const std::string pockets = "--robot-pockets ignored --ignored-pocket 0.6";
  question.replace(question.find(pockets), pockets.size(), "--robot-pockets obstacle");
  const auto by_frame = run_command(question, folder);
  ASSERT_EQ(by_frame.exit_code, 0) << by_frame.err;
  (void)folder.write("joints.csv", "time_s,pan,tilt\n0,0.2,-0.3\n0.1,-0.6,0.4\n");
  EXPECT_EQ(run_command(question + "--joint-time-error 0", folder).out, by_frame.out);
}

// Space that no camera covers counts; what the robot hides is another thing.
TEST(RobotInRecording, WhatItHidesCountsByAPolicyOfItsOwn) {
  const TemporaryFolder folder;
  write_cell(folder);
  std::string question = kQuestion + kRobot + "--robot-padding 0.02 --frames 3 ";
  question.replace(question.find("--unobserved ignored"), 20, "--unobserved obstacle");
  const auto hand_m = [&] { return std::stod(column(run_command(question, folder), "distance_m").at("3 hand")); };
  const double ignored_m = hand_m();
  const std::string pockets = "--robot-pockets ignored --ignored-pocket 0.6";
  question.replace(question.find(pockets), pockets.size(), "--robot-pockets obstacle");
  EXPECT_GT(ignored_m, 0.1);
  EXPECT_LT(hand_m(), 0.05);
}

TEST(RobotInRecording, DistancesWithinTheBlindLayerAreSaid) {
  const TemporaryFolder folder;
  write_cell(folder);
  int some = 0;
  int none = 0;
  for (const std::string padding : {"0.01", "0.05", "0.44"}) {
    const auto result = run_command(kQuestion + kRobot + "--robot-padding " + padding, folder);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto distances_m = column(result, "distance_m");
    const auto layers_m = column(result, "blind_m");
    int within = 0;
    for (const auto& [row, distance_m] : distances_m) {
      within += std::stod(distance_m) <= std::stod(layers_m.at(row)) ? 1 : 0;
    }
    const std::string said = "warning: " + std::to_string(within) + " of " + std::to_string(distances_m.size()) +
                             " distances are no more than blind_m";
    if (within > 0) {
      EXPECT_THAT(result.err, HasSubstr(said)) << padding;
      ++some;
    } else {
      EXPECT_THAT(result.err, Not(HasSubstr("no more than blind_m"))) << padding;
      ++none;
    }
  }
  EXPECT_GT(some, 0);
  EXPECT_GT(none, 0);
}

TEST(RobotInRecording, TheGridTakesItOutToo) {
  const TemporaryFolder folder;
  write_cell(folder);
  const Vector3d p = links_at(kFrames.at(3))[0].b;
  std::ostringstream point;
  point << "--frames 3 --rho 0.3 --point elbow=" << p.x() << ',' << p.y() << ',' << p.z() << ' ';
  for (const std::string method : {"letter", "corrected"}) {
    const std::string question = "distances . --method " + method + " " + point.str();
    const double with =
        std::stod(column(run_command(question + kRobot + "--robot-padding 0.02", folder), "distance_m").at("3 elbow"));
    EXPECT_LT(std::stod(column(run_command(question, folder), "distance_m").at("3 elbow")), 0.06) << method;
    EXPECT_GT(with, 0.06) << method;
  }
  const auto links = run_command("distances . " + kRobot, folder);
  EXPECT_EQ(links.exit_code, 2);
  EXPECT_THAT(links.err, AllOf(HasSubstr("points only"), HasSubstr("--method search")));
}

/// The base is stated in the world, whatever frame the points are in.
TEST(RobotInRecording, StandsWhereItStoodInTheFloorFrame) {
  const TemporaryFolder folder;
  write_cell(folder);
  const auto in_world = column(run_command(kQuestion + kRobot + "--robot-padding 0.02", folder), "distance_m");
  auto file = rig_file();
  file.rig.T_floor_world = Pose(Eigen::Translation3d(0, 0, 1));
  files::save_rig(file, folder / "rig.json");
  const std::string box = " --box=-0.8,-0.8,0.6,1.6,1.9,2.7 ";
  std::string question = kQuestion;
  question.replace(question.find("--box"), question.find(" --rho") - question.find("--box"), "--in floor" + box);
  const auto in_floor = column(run_command(question + kRobot + "--robot-padding 0.02", folder), "distance_m");
  ASSERT_EQ(in_world.size(), 4U);
  for (const auto& [link, distance] : in_world) {
    EXPECT_NEAR(std::stod(in_floor.at(link)), std::stod(distance), 0.006) << link;
  }
}

// What holds for one part of a link holds for the link.
TEST(RobotInRecording, ALinkIsAsStaleAsAnyOfItsParts) {
  const auto part = [](const char* id) { return files::ControlPoint{id, Capsule::point({0, 0, 0}), false}; };
  const auto answer = [](double distance_m, bool stale, bool budget, double known_to_m) {
    Answer result;
    result.nearest.state = ProximityState::measured;
    result.nearest.distance_m = distance_m;
    result.nearest.stale = stale;
    result.nearest.budget = budget;
    result.nearest.known_to_m = known_to_m;
    return result;
  };
  std::vector<files::ControlPoint> points{part("hand"), part("fore"), part("hand"), part("fore")};
  std::vector<Answer> answers{answer(0.2, false, false, 0.5), answer(0.3, true, false, 0.4),
                              answer(0.4, true, true, 0.3), answer(0.1, false, false, 0.6)};
  program::one_answer_a_link(points, answers);
  ASSERT_EQ(answers.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(points[i].id, i == 0 ? "hand" : "fore");
    EXPECT_EQ(answers[i].nearest.distance_m, i == 0 ? 0.2 : 0.1);
    EXPECT_TRUE(answers[i].nearest.stale);
    EXPECT_EQ(answers[i].nearest.budget, i == 0);
    EXPECT_EQ(answers[i].nearest.known_to_m, i == 0 ? 0.3 : 0.4);
  }
}

TEST(RobotInRecording, FaultsAreOneLine) {
  const TemporaryFolder folder;
  write_cell(folder);
  struct Case {
    std::string arguments;
    int exit_code;
    std::string message;
  };
  (void)folder.write("few.csv", "frame,pan,wrist\n3,0.2,0\n4,0,0\n");
  (void)folder.write("length.csv", "frame,pan_m,tilt\n3,0.2,-0.3\n4,0.2,0\n");
  (void)folder.write("one.csv", "frame,pan,tilt\n3,0.2,-0.3\n");
  for (const Case& broken : {
           Case{"--urdf arm.urdf", 2, "--urdf needs --joints"},
           Case{"--urdf arm.urdf --joints joints.csv", 2, "--urdf needs --base"},
           Case{"--joints joints.csv --point 0,0,1", 2, "--joints has no effect without a robot"},
           Case{"--robot-padding 0.1 --point 0,0,1", 2, "--robot-padding has no effect without a robot"},
           Case{kBase + "--urdf arm.urdf --joints no.csv", 1, "no.csv"},
           Case{kBase + "--urdf no.urdf --joints joints.csv", 1, "no.urdf"},
           Case{kBase + "--urdf arm.urdf --joints few.csv", 1,
                "no column for tilt of arm.urdf; columns of no joint: wrist"},
           Case{kBase + "--urdf arm.urdf --joints one.csv", 1, "one.csv: has no row of frame 4"},
           Case{kRobot + "--joint pan=0", 2, "has this joint already"},
           Case{kRobot + "--joint elbow=0", 2, "it has pan, tilt"},
           Case{kRobot + "--robot-padding -1", 2, "--robot-padding -1 must be finite and not negative"},
           Case{"--urdf arm.urdf --joints joints.csv --base 1,2", 2, "2 numbers, must be 3"},
           Case{"--urdf arm.urdf --joints joints.csv --base 0,0,0,90,0,0", 2, "angles are radians"},
           Case{"--urdf arm.urdf --joints joints.csv --base 0,0,0,1,1,0,0", 2, "the quaternion qx,qy,qz,qw has length"},
           Case{"--urdf arm.urdf --joints joints.csv --base 0,0,0,0,0,0,1.005", 2, "has length 1.005, must be 1"},
           Case{"--urdf arm.urdf --joints joints.csv --base 0,0,800", 2, "in millimetres?"},
           Case{kRobot + "--robot-padding 40", 2, "--robot-padding 40 must be at most 1 m (in millimetres?)"},
           Case{kRobot + "--joint-time-error 100", 2, "--joint-time-error 100 must be at most 60 s (in milliseconds?)"},
           Case{kBase + "--urdf arm.urdf --joints few.csv --joint tilt=45", 2, "is this one in degrees?"},
           Case{kBase + "--urdf arm.urdf --joints few.csv --joint-unit degrees --joint tilt=45", 2,
                "--joint tilt=45: joint 'tilt' stands at 45 rad, its limits are -1.6 and 1.6 rad"},
           Case{kBase + "--urdf arm.urdf --joints few.csv --joint tilt=0 --joint tilt=1", 2, "'tilt' is given twice"},
           Case{kBase + "--urdf arm.urdf --joints length.csv", 1,
                "length.csv: column 'pan_m' is a length, but joint 'pan' turns"},
           Case{kRobot + "--package arm", 2, "must be NAME=FOLDER"},
       }) {
    const auto before = folder.entries();
    const auto result = run_command(kQuestion + "--output answers.csv " + broken.arguments, folder);
    EXPECT_EQ(result.exit_code, broken.exit_code) << broken.arguments;
    EXPECT_THAT(result.err, HasSubstr(broken.message));
    EXPECT_THAT(result.err, ContainsRegex("depthgrid: [^\n]*\n$"));
    EXPECT_EQ(folder.entries(), before) << broken.arguments;
  }
  EXPECT_EQ(run_command(kQuestion + kBase + "--urdf arm.urdf --joints few.csv --joint tilt=-0.3 --frames 3 ", folder)
                .exit_code,
            0)
      << "a joint that the file lacks stands still";
}

TEST(RobotInRecording, PicturesShowIt) {
  const TemporaryFolder folder;
  write_cell(folder);
  const auto plain = run_command(kQuestion + "--point 0,0,1 --frames 3 --pictures plain", folder);
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  ASSERT_EQ(run_command(kQuestion + kRobot + "--frames 3 --pictures robot", folder).exit_code, 0);
  const PictureColours without(folder / "plain" / "frame_0003.png");
  const PictureColours with(folder / "robot" / "frame_0003.png");
  EXPECT_LT(without.of(230, 13, 13), 20);
  EXPECT_GT(with.of(230, 13, 13), 2000) << "taken for the robot";
  ASSERT_EQ(run_command(kQuestion + "--urdf arm.urdf --joints joints.csv --base 0.1,0,0.3,0,0,0.5 --frames 3 "
                                    "--pictures off",
                        folder)
                .exit_code,
            0);
  EXPECT_GT(PictureColours(folder / "off" / "frame_0003.png").of(26, 77, 242), 500) << "read farther";
}

/// A real arm, where its recording is there: figures in docs/recordings.md.
TEST(RobotInRecording, TakesARealArmOutOfItsImages) {
  const char* given = std::getenv("DEPTHGRID_DATA");
  const auto data = std::filesystem::absolute(given != nullptr ? given : "../shared/data") / "med7_zed2i";
  if (!std::filesystem::is_directory(data)) {
    GTEST_SKIP() << "no '" << data.string() << "': set DEPTHGRID_DATA to the folder with the recordings";
  }
  const TemporaryFolder folder;
  const auto result =
      run_command("distances '" + data.string() + "' --urdf '" + (data / "med7.urdf").string() + "' --joints '" +
                      (data / "joint_states.csv").string() +
                      "' --base 0,0,0 --robot-padding 0.06 --method search --margin-constant 0.01 --margin-quadratic "
                      "0.004 --v-max 0 "
                      "--box=-0.8,-0.8,0,0.8,0.8,1.3 --unobserved ignored --outside ignored --robot-pockets ignored",
                  folder);
  EXPECT_EQ(column(result, "distance_m").size(), 5U * 6) << "links 2 to 7 in five images";
  EXPECT_GT(std::stod(after(result.err, "show its capsules: taken ")), 60);
}

}  // namespace
}  // namespace depthgrid::test
