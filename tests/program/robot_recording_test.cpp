// depthgrid distances --urdf: a robot in a recording. The images are those of an analytic scene, which knows what is
// robot; where the links stand is worked out here by hand.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "depthgrid/files/recording.hpp"
#include "depthgrid/simulation/scene.hpp"
#include "program/command.hpp"
#include "program/distances/recorded_robot.hpp"
#include "program/picture_colours.hpp"

namespace depthgrid::test {
namespace {

/// The number that follows this text the first time; "nan" where there is none.
std::string after(const std::string& text, const std::string& words) {
  const std::size_t at = text.find(words);
  if (at == std::string::npos) {
    ADD_FAILURE() << "no '" << words << "' in: " << text;
    return "nan";
  }
  const std::size_t begin = at + words.size();
  const std::size_t end = text.find_first_not_of("0123456789.", begin);
  return text.substr(begin, end - begin);
}

using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

/// Two turning links of capsules, and a hand of two balls.
const std::string kUrdf = R"(<robot name="arm">
  <link name="foot"/>
  <link name="upper"><collision><origin xyz="0.2 0 0" rpy="0 1.5707963267948966 0"/>
    <geometry><capsule radius="0.06" length="0.4"/></geometry></collision></link>
  <link name="fore"><collision><origin xyz="0.15 0 0" rpy="0 1.5707963267948966 0"/>
    <geometry><capsule radius="0.05" length="0.3"/></geometry></collision></link>
  <link name="hand">
    <collision><origin xyz="0 0.06 0"/><geometry><sphere radius="0.05"/></geometry></collision>
    <collision><origin xyz="0 -0.06 0"/><geometry><sphere radius="0.05"/></geometry></collision>
  </link>
  <joint name="pan" type="revolute"><origin xyz="0 0 0.3"/><parent link="foot"/><child link="upper"/><axis xyz="0 0 1"/>
    <limit lower="-1.6" upper="1.6" velocity="0"/></joint>
  <joint name="tilt" type="revolute"><origin xyz="0.5 0 0"/><parent link="upper"/><child link="fore"/><axis xyz="0 1 0"/>
    <limit lower="-1.6" upper="1.6" velocity="1"/></joint>
  <joint name="grip" type="fixed"><origin xyz="0.4 0 0"/><parent link="fore"/><child link="hand"/></joint>
</robot>)";
const std::string kBase = "--base 0.1,0,0.2,0,0,0.5 ";

struct Position {
  double pan, tilt;
};
const std::map<int, Position> kFrames{{3, {0.2, -0.3}}, {4, {-0.6, 0.4}}};
const Capsule kObstacle = Capsule::sphere({0.775, 0.568, 0.93}, 0.1);

/// upper, fore, and the hand's two.
std::vector<Capsule> links_at(const Position& q) {
  Pose T = Pose(Eigen::Translation3d(0.1, 0, 0.2)) * Eigen::AngleAxisd(0.5 + q.pan, Vector3d::UnitZ());
  const auto moved = [&T](const Vector3d& a, const Vector3d& b, double radius_m) {
    return Capsule{T * a, T * b, radius_m};
  };
  T.translation().z() += 0.3;
  std::vector<Capsule> result{moved({0, 0, 0}, {0.4, 0, 0}, 0.06)};
  T = T * Eigen::Translation3d(0.5, 0, 0) * Eigen::AngleAxisd(q.tilt, Vector3d::UnitY());
  result.push_back(moved({0, 0, 0}, {0.3, 0, 0}, 0.05));
  result.push_back(moved({0.4, 0.06, 0}, {0.4, 0.06, 0}, 0.05));
  result.push_back(moved({0.4, -0.06, 0}, {0.4, -0.06, 0}, 0.05));
  return result;
}

double distance_m(const std::vector<Capsule>& links, const Vector3d& p) {
  double least_m = 1e9;
  for (const Capsule& link : links) {
    least_m = std::min(least_m, distance_to_axis(link, p) - link.radius_m);
  }
  return least_m;
}

simulation::Scene scene(const std::vector<Capsule>& robot, bool obstacle) {
  simulation::Scene result;
  result.add(simulation::Plane{{0, -1, 0}, -2});
  result.add(simulation::Plane{{0, 0, 1}, -0.5});
  if (obstacle) {
    result.add(kObstacle);
  }
  for (const Capsule& capsule : robot) {
    result.add(capsule, simulation::Body::robot);
  }
  return result;
}

files::RigFile rig_file() {
  files::RigFile file;
  file.rig.name = "cell";
  for (const bool left : {true, false}) {
    RigCamera camera;
    camera.id = left ? "left" : "right";
    camera.intrinsics = {320, 240, 260.0, 260.0, 160.0, 120.0};
    camera.T_world_camera = look_at(left ? Vector3d(-0.6, -1.6, 0.8) : Vector3d(1.7, -1.2, 1.1), {0.5, 0.4, 0.6});
    file.rig.cameras.push_back(camera);
    file.depth_files.push_back(camera.id + "_%d.png");
  }
  file.first_frame = 3;
  file.frame_count = 2;
  file.rate_hz = 10.0;
  return file;
}

void write_cell(const TemporaryFolder& folder) {
  const files::RigFile file = rig_file();
  files::save_rig(file, folder / "rig.json");
  for (const auto& [frame, q] : kFrames) {
    for (std::size_t k = 0; k < 2; ++k) {
      const RigCamera& camera = file.rig.cameras[k];
      const DepthImage depth = scene(links_at(q), true).render(camera.intrinsics, camera.T_world_camera).depth_m;
      std::vector<std::uint16_t> pixels(depth.index(0, depth.height_px()));
      std::transform(depth.data(), depth.data() + pixels.size(), pixels.begin(),
                     [](float z) { return static_cast<std::uint16_t>(std::lround(1000 * z)); });
      files::write_png_gray16(folder / files::depth_file_name(file.depth_files[k], frame), 320, 240, pixels);
    }
  }
  (void)folder.write("arm.urdf", kUrdf);
  (void)folder.write("joints.csv", "frame,pan,tilt\n3,0.2,-0.3\n4,-0.6,0.4\n");
}

const std::string kQuestion =
    "distances . --method search --margin-constant 0.002 --unobserved ignored --outside ignored --robot-pockets "
    "ignored "
    "--ignored-pocket 0.6 --v-max 0 --box=-0.8,-0.8,-0.4,1.6,1.9,1.7 --rho 0.6 ";
const std::string kRobot = "--urdf arm.urdf --joints joints.csv " + kBase;

/// "frame,point" to the cell of a column.
std::map<std::string, std::string> column(const CommandResult& result, const std::string& name) {
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::istringstream lines(result.out);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string>& row = rows.emplace_back(1);
    for (const char c : line) {
      c == ',' ? (void)row.emplace_back() : row.back().push_back(c);
    }
  }
  std::map<std::string, std::string> cells;
  const auto at = std::find(rows.at(0).begin(), rows.at(0).end(), name) - rows.at(0).begin();
  for (std::size_t i = 1; i < rows.size(); ++i) {
    cells[rows[i].at(0) + ' ' + rows[i].at(2)] = rows[i].at(static_cast<std::size_t>(at));
  }
  return cells;
}

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

/// As write_cell(), with a time stamp an image, 20 ms later those of the right camera; at 1 s of the joints' clock the
/// arm begins to pan evenly, and the left camera stands elsewhere in the second frame.
const std::vector<double> kLeftTimes_s{1700000001.0, 1700000001.1};
constexpr double kRightLater_s = 0.02;

Position stamped_position(double time_s) { return {0.2 - 2 * (time_s - kLeftTimes_s[0]), -0.3}; }

void write_stamped_cell(const TemporaryFolder& folder) {
  files::RigFile file = rig_file();
  file.frame_count = 1;
  file.first_frame = 0;
  file.rate_hz.reset();
  file.simultaneous = false;
  file.tolerance_s = 0.03;
  file.shared_clock = true;
  file.tracks.resize(2);
  file.tracks[0].trajectory = "left.txt";
  std::string trajectory;
  for (std::size_t k = 0; k < 2; ++k) {
    file.depth_files[k] = file.rig.cameras[k].id + "/%f.png";
    std::filesystem::create_directories(folder / file.rig.cameras[k].id);
    for (std::size_t i = 0; i < 2; ++i) {
      const double time_s = kLeftTimes_s[i] + (k == 0 ? 0 : kRightLater_s);
      const bool elsewhere = k == 0 && i == 1;
      const Pose T_world_camera =
          elsewhere ? look_at({-0.9, -1.2, 1.0}, {0.5, 0.4, 0.6}) : rig_file().rig.cameras[k].T_world_camera;
      const DepthImage depth = scene(links_at(stamped_position(time_s)), true)
                                   .render(file.rig.cameras[k].intrinsics, T_world_camera)
                                   .depth_m;
      std::vector<std::uint16_t> pixels(depth.index(0, depth.height_px()));
      std::transform(depth.data(), depth.data() + pixels.size(), pixels.begin(),
                     [](float z) { return static_cast<std::uint16_t>(std::lround(1000 * z)); });
      const std::string stamp = std::to_string(time_s);  // six decimals
      files::write_png_gray16(folder / (file.rig.cameras[k].id + "/" + stamp + ".png"), 320, 240, pixels);
      if (k == 0) {
        const Eigen::Quaterniond q(T_world_camera.linear());
        const Vector3d t = T_world_camera.translation();
        std::ostringstream line;
        line.precision(17);
        line << stamp << ' ' << t.x() << ' ' << t.y() << ' ' << t.z() << ' ' << q.x() << ' ' << q.y() << ' ' << q.z()
             << ' ' << q.w() << '\n';
        trajectory += line.str();
      }
    }
  }
  file.rig.cameras[0].T_world_camera = Pose::Identity();
  files::save_rig(file, folder / "rig.json");
  (void)folder.write("left.txt", trajectory);
  (void)folder.write("arm.urdf", kUrdf);
  std::ostringstream joints;
  joints.precision(17);
  joints << "time_s,pan,tilt\n";
  for (int i = -2; i <= 14; ++i) {
    const double time_s = kLeftTimes_s[0] + 0.01 * i;
    joints << time_s << ',' << stamped_position(time_s).pan << ',' << stamped_position(time_s).tilt << '\n';
  }
  (void)folder.write("joints.csv", joints.str());
}

const std::string kStampedQuestion = kQuestion + "--static-scene --joint-time-error 0 " + kRobot;

/// All but single pixels along an edge that the model, grown for rounding, covers by 0.01 mm.
std::string all_taken(const std::string& camera, const std::string& images) {
  return "camera '" + camera + "', " + images +
         ": [0-9 ]+ pixels taken for the robot, [0-9 ]+ of them beside its capsules; [0-9 ]+ show its capsules: taken "
         "(99.[89]|100.0) %, not because the reading is farther 0.[0-2] %, nearer 0.0 %, missing 0.0 %\n";
}

/// The arm pans by 40 mrad between the images of a frame: the right image shows it 4 cm beside the left one's.
TEST(RobotInRecording, IsTakenWhereItWasAtEachTimeStampAndTheCameraToo) {
  const TemporaryFolder folder;
  write_stamped_cell(folder);
  const auto result = run_command(kStampedQuestion + "--robot-padding 0.006", folder);
  const auto distances = column(result, "distance_m");
  EXPECT_THAT(result.err, ContainsRegex(all_taken("left", "2 images")));
  EXPECT_THAT(result.err, ContainsRegex(all_taken("right", "2 images")));
  ASSERT_EQ(distances.size(), 4U) << result.err;
  for (const int frame : {0, 1}) {
    // Where they are at the newer image, the right one: that is the time of the answers.
    const auto links = links_at(stamped_position(kLeftTimes_s[static_cast<std::size_t>(frame)] + kRightLater_s));
    Vector3d on_axis;
    for (const auto& [name, axis] : {std::pair("on_axis_x_m", 0), {"on_axis_y_m", 1}, {"on_axis_z_m", 2}}) {
      on_axis[axis] = std::stod(column(result, name).at(std::to_string(frame) + " fore"));
    }
    EXPECT_LT(distance_to_axis(links[1], on_axis), 0.001);
    const double fore_m = distance_m({links[1]}, kObstacle.a) - kObstacle.radius_m;
    const double hand_m = distance_m({links[2], links[3]}, kObstacle.a) - kObstacle.radius_m;
    for (const auto& [name, truth_m] : {std::pair("fore", fore_m), std::pair("hand", hand_m)}) {
      EXPECT_LE(std::stod(distances.at(std::to_string(frame) + " " + name)), std::min(truth_m, 0.6) + 1e-6) << name;
    }
  }
  // 20 ms beside the images' clock the links are missed.
  const auto beside = run_command(kStampedQuestion + "--robot-padding 0.006 --joint-time-offset -0.02", folder);
  EXPECT_EQ(beside.exit_code, 0) << beside.err;
  EXPECT_THAT(beside.err, Not(ContainsRegex(all_taken("left", "2 images"))));
  EXPECT_THAT(beside.err, Not(ContainsRegex(all_taken("right", "2 images"))));
  const auto least = run_command(kStampedQuestion + "--least-padding", folder);
  EXPECT_EQ(least.exit_code, 2);
  EXPECT_THAT(least.err, HasSubstr("--least-padding takes cameras that stand still and numbered images"));
}

TEST(RobotInRecording, ACameraWithoutImageInAFrameShowsNoRobot) {
  const TemporaryFolder folder;
  write_stamped_cell(folder);
  std::filesystem::remove(folder / "right/1700000001.020000.png");
  const auto result = run_command(kStampedQuestion + "--robot-padding 0.006 --frames 0:1 --pictures pictures", folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, ContainsRegex(all_taken("left", "2 images")));
  EXPECT_THAT(result.err, ContainsRegex(all_taken("right", "1 image")));
}

TEST(RobotInRecording, TimeStampsAskForJointsOverTimeOnTheirClock) {
  const TemporaryFolder folder;
  write_stamped_cell(folder);
  (void)folder.write("joints.csv", "frame,pan,tilt\n0,0.2,-0.3\n1,0,-0.3\n");
  const auto by_frame = run_command(kStampedQuestion, folder);
  EXPECT_EQ(by_frame.exit_code, 1);
  EXPECT_THAT(by_frame.err, AllOf(HasSubstr("joints.csv: "), HasSubstr("time stamps"), HasSubstr("column 'time'")));
  (void)folder.write("joints.csv", "time_s,pan,tilt\n0,0.2,-0.3\n0.06,0.1,-0.3\n0.12,0,-0.3\n");
  const auto since_the_start = run_command(kStampedQuestion, folder);
  EXPECT_EQ(since_the_start.exit_code, 1);
  EXPECT_THAT(since_the_start.err, AllOf(HasSubstr("camera 'left', at 1700000001"), HasSubstr("--joint-time-offset")));
  EXPECT_EQ(run_command(kStampedQuestion + "--joint-time-offset 1700000001", folder).exit_code, 0);
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
