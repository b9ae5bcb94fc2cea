// depthgrid distances and info on cameras that move, and on images with time stamps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "program/command.hpp"

namespace depthgrid::test {
namespace {

using ::testing::HasSubstr;

/// Every 0.25 s from 99.9 s on, at z = t + `before_m`.
std::string poses_of_approach(double before_m) {
  std::string poses = "# timestamp tx ty tz qx qy qz qw\n";
  for (int k = 0; k < 6; ++k) {
    const double t = -0.1 + 0.25 * k;
    poses += std::to_string(100 + t) + " 0 0 " + std::to_string(t + before_m) + " 0 0 0 1\n";
  }
  return poses;
}

/// A camera that goes along z towards a wall at z = 3 m: at time t it stands at z = t and sees the wall 3 - t m away.
/// Images at 0, 0.5, 1 s of 100 s; poses every 0.25 s from 99.9 s on, so never at an image's time.
void write_approach(const TemporaryFolder& folder, const std::string& frames) {
  std::string list = "# timestamp filename\n";
  for (const double t : {0.0, 0.5, 1.0}) {
    const std::string name = "depth/" + std::to_string(100 + t) + ".png";
    std::filesystem::create_directories(folder / "depth");
    files::write_png_gray16(
        folder / name, 64, 48,
        std::vector<std::uint16_t>(std::size_t{64} * 48, static_cast<std::uint16_t>(3000 - 1000 * t)));
    list += std::to_string(100 + t) + " " + name + "\n";
  }
  (void)folder.write("depth.txt", list);
  (void)folder.write("groundtruth.txt", poses_of_approach(0));
  (void)folder.write("rig.json",
                     R"({"name": "approach", "depth": {"metres_per_unit": 0.001}, "frames": {)" + frames +
                         R"(}, "cameras": [{"id": "hand", "width": 64, "height": 48, "fx": 60, "fy": 60, "cx": 31.5,
      "cy": 23.5, "sensor": "ideal", "depth_list": "depth.txt", "trajectory": "groundtruth.txt"}]})");
}

const std::string kSearch =
    "distances . --method search --box=-0.4,-0.3,0.5,0.4,0.3,3.5 --unobserved obstacle --outside ignored "
    "--robot-pockets obstacle --v-max 0 ";
const std::string kPoint = "--point 0,0,2.7 ";

std::vector<double> distances_of(const CommandResult& result) {
  std::vector<double> distances;
  std::size_t begin = result.out.find('\n') + 1;
  while (begin < result.out.size()) {
    std::size_t cell = begin;
    for (int k = 0; k < 6; ++k) {
      cell = result.out.find(',', cell) + 1;
    }
    distances.push_back(std::stod(result.out.substr(cell)));
    begin = result.out.find('\n', begin) + 1;
  }
  return distances;
}

/// The wall stands still in the world although it comes nearer in the images: the camera is moved.
TEST(Moving, TheSearchMovesTheCamera) {
  const TemporaryFolder folder;
  write_approach(folder, R"("pose_gap_s": 0.3, "shared_clock": true)");
  const auto result = run_command(kSearch + kPoint + "--pictures pictures", folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, ::testing::MatchesRegex("smallest obstacle: [^\n]*\n"));
  const auto distances = distances_of(result);
  ASSERT_EQ(distances.size(), 3U) << result.out;
  for (const double distance_m : distances) {
    EXPECT_LE(distance_m, 0.3);
    EXPECT_NEAR(distance_m, 0.3, 0.0051);
  }
  EXPECT_THAT(result.out, HasSubstr("\n0,0.000000,"));
  EXPECT_THAT(result.out, HasSubstr("\n1,0.500000,"));
  EXPECT_THAT(result.out, HasSubstr("\n2,1.000000,"));
  EXPECT_TRUE(std::filesystem::exists(folder / "pictures/frame_0002.png"));
}

TEST(Moving, TheSearchMovesTheCameraInTheFloorFrame) {
  const TemporaryFolder folder;
  write_approach(folder, R"("pose_gap_s": 0.3, "shared_clock": true)");
  edit(folder, "rig.json", "\"cameras\"",
       "\"T_floor_world\": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 5], [0, 0, 0, 1]], \"cameras\"");
  const auto result = run_command(
      "distances . --method search --in floor --box=-0.4,-0.3,5.5,0.4,0.3,8.5 --unobserved obstacle --outside ignored "
      "--robot-pockets obstacle --v-max 0 --point 0,0,7.7",
      folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (const double distance_m : distances_of(result)) {
    EXPECT_NEAR(distance_m, 0.3, 0.0051);
  }
}

TEST(Moving, TheGridSaysThatItCannot) {
  const TemporaryFolder folder;
  write_approach(folder, R"("pose_gap_s": 0.3, "shared_clock": true)");
  for (const std::string method : {"letter", "corrected"}) {
    const auto result = run_command("distances . --method " + method + " " + kPoint, folder);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.err, "depthgrid: camera 'hand' moves, and --method " + method +
                              " needs cameras that stand still; use --method search\n");
  }
  EXPECT_EQ(run_command("distances . " + kPoint, folder).exit_code, 2) << "the default is corrected";
  const auto map = run_command("map build . --output wall.map", folder);
  EXPECT_EQ(map.exit_code, 1);
  EXPECT_THAT(map.err, HasSubstr("camera 'hand' moves, and a map is for cameras that stand still"));
}

TEST(Moving, AMissingPoseIsRefusedBeforeWorkBegins) {
  const TemporaryFolder folder;
  write_approach(folder, R"("pose_gap_s": 0.2, "shared_clock": true)");
  const auto result = run_command(kSearch + kPoint, folder);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(
      result.err,
      "depthgrid: ./groundtruth.txt: frame 0: there is no pose at 100.000000 s, and those around it are 0.25 s apart, "
      "more than /frames/pose_gap_s = 0.2; choose other frames with --frames\n");
  write_approach(folder, R"("shared_clock": true)");
  EXPECT_THAT(run_command(kSearch + kPoint, folder).err, HasSubstr("state /frames/pose_gap_s to interpolate"));
}

TEST(Moving, OneClockIsStatedOrWarnedOf) {
  const TemporaryFolder folder;
  write_approach(folder, R"("pose_gap_s": 0.3)");
  const auto unsaid = run_command(kSearch + kPoint, folder);
  EXPECT_EQ(unsaid.exit_code, 0);
  EXPECT_THAT(unsaid.err, ::testing::StartsWith(
                              "depthgrid: warning: the rig file does not say that all time stamps are of one clock "
                              "(\"shared_clock\": true in \"frames\"); they are compared as if they were\nsmallest "));
  write_approach(folder, R"("pose_gap_s": 0.3, "shared_clock": false)");
  const auto denied = run_command(kSearch + kPoint, folder);
  EXPECT_EQ(denied.exit_code, 1);
  EXPECT_THAT(denied.err, HasSubstr("\"shared_clock\": false, so the trajectory does not say where the camera was"));
}

TEST(Moving, ListsAndTrajectoriesAreInputs) {
  const TemporaryFolder folder;
  write_approach(folder, R"("pose_gap_s": 0.3, "shared_clock": true)");
  for (const std::string input : {"depth.txt", "groundtruth.txt", "depth/100.000000.png", "rig.json"}) {
    const std::string before = read_bytes(folder / input);
    const auto result = run_command(kSearch + kPoint + "--output " + input, folder);
    EXPECT_EQ(result.exit_code, 2) << input;
    EXPECT_THAT(result.err, HasSubstr("an input that would be overwritten")) << input;
    EXPECT_EQ(read_bytes(folder / input), before);
  }
}

// The second camera goes along with the first, and then 0.2 m before it, where it should see the wall nearer.
TEST(Moving, InfoComparesCamerasWhereTheyWere) {
  const TemporaryFolder folder;
  write_approach(folder, R"("pose_gap_s": 0.3, "shared_clock": true, "tolerance_s": 0)");
  std::string rig = read_bytes(folder / "rig.json");
  const std::size_t begin = rig.find("[{") + 1;
  std::string second = rig.substr(begin, rig.rfind(']') - begin);
  second.replace(second.find("\"hand\""), 6, "\"other\"");
  second.replace(second.find("groundtruth.txt"), 15, "other.txt");
  (void)folder.write("rig.json", rig.insert(rig.rfind(']'), ", " + second));
  for (const bool before : {false, true}) {
    (void)folder.write("other.txt", poses_of_approach(before ? 0.2 : 0));
    const auto result = run_command("info .", folder);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out,
                ::testing::ContainsRegex(before ? "hand to other +20[01] mm +0 % +20[01] mm +0 % +100 % +0 %"
                                                : "hand to other +0 mm +100 % +0 mm +100 % +0 % +0 %"));
  }
}

/// The two cameras of the wall, not triggered together.
void write_stamped_wall(const TemporaryFolder& folder, const std::string& frames) {
  write_wall(folder);
  std::string rig = read_bytes(folder / "rig.json");
  const std::size_t key = rig.find("\"frames\"");
  rig.replace(key, rig.find('}', key) + 1 - key, "\"frames\": {" + frames + "}");
  for (const std::string camera : {"left", "right"}) {
    const std::string pattern = "\"depth_files\": \"" + camera + "_%03d.png\"";
    ASSERT_NE(rig.find(pattern), std::string::npos) << rig;
    rig.replace(rig.find(pattern), pattern.size(), "\"depth_list\": \"" + camera + ".txt\"");
  }
  (void)folder.write("rig.json", rig);
  (void)folder.write("left.txt", "7.0 left_005.png\n7.1 left_006.png\n");
  (void)folder.write("right.txt", "7.01 right_005.png\n7.18 right_006.png\n");
}

/// Neither the rig file's name nor the images' names a folder.
TEST(Stamped, ImagesMayStandBesideTheRigFile) {
  const TemporaryFolder folder;
  files::write_png_gray16(folder / "1305031102.160407.png", 64, 48,
                          std::vector<std::uint16_t>(std::size_t{64} * 48, std::uint16_t{3000}));
  (void)folder.write("rig.json", R"({"depth": {"metres_per_unit": 0.001}, "cameras": [{"id": "c", "width": 64,
      "height": 48, "fx": 60, "fy": 60, "cx": 31.5, "cy": 23.5, "depth_files": "%f.png",
      "T_world_cam": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}]})");
  for (const std::string recording : {"rig.json", "."}) {
    const auto result = run_command("info " + recording, folder);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("1 frame"));
  }
}

TEST(Stamped, TheSearchKnowsHowOldEachImageIs) {
  const TemporaryFolder folder;
  write_stamped_wall(folder, R"("tolerance_s": 0.03, "shared_clock": true)");
  const std::string question =
      "distances . --method search --sensor ideal --box=-1.2,-0.3,0.5,0.8,0.3,2.5 --unobserved obstacle --outside "
      "ignored "
      "--robot-pockets obstacle --point=-0.6,0,1.7 --frames 0 ";  // which the left camera sees alone
  const auto still = run_command(question + "--v-max 0 --static-scene", folder);
  const auto moving = run_command(question + "--v-max 5", folder);
  ASSERT_EQ(still.exit_code, 0) << still.err;
  ASSERT_EQ(moving.exit_code, 0) << moving.err;
  EXPECT_NEAR(distances_of(still).at(0) - distances_of(moving).at(0), 5 * 0.01, 0.0051)
      << "the left image is 10 ms older than the right one";
}

TEST(Stamped, TheGridRefusesDifferentTimes) {
  const TemporaryFolder folder;
  write_stamped_wall(folder, R"("tolerance_s": 0.03, "shared_clock": true)");
  const std::string question = "distances . --sensor ideal --point 0.2,0,1.7 ";
  const auto result = run_command(question, folder);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(
      result.err,
      "depthgrid: the time stamps say that images of one frame are of different times; give --static-scene if nothing "
      "moves, or --margin-time with how far an obstacle moves between them\n");
  EXPECT_EQ(run_command(question + "--margin-time 0.01", folder).exit_code, 0);
  EXPECT_EQ(run_command(question + "--cameras left", folder).exit_code, 0);
}

TEST(Stamped, ACameraWithoutAnImageFreesNothingAndThatIsSaid) {
  const TemporaryFolder folder;
  write_stamped_wall(folder, R"("tolerance_s": 0.03, "shared_clock": true)");
  const std::string question =
      "distances . --method search --sensor ideal --box=-0.4,-0.3,0.5,1.5,0.3,2.5 --unobserved obstacle --outside "
      "ignored "
      "--robot-pockets obstacle --v-max 0 --static-scene --point 1.1,0,1.7 ";  // which the right camera sees alone
  const auto result = run_command(question, folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, ::testing::StartsWith("depthgrid: warning: camera 'right' has no image within tolerance_s in "
                                                "1 of 2 frames; it frees nothing there\nsmallest "));
  const auto distances = distances_of(result);
  ASSERT_EQ(distances.size(), 2U);
  EXPECT_GT(distances[0], 0.1);
  EXPECT_EQ(distances[1], 0.0) << "nobody has looked there";
  EXPECT_THAT(result.out, HasSubstr(",true,false,")) << "stale";
  const auto lost = run_command(
      "distances . --method search --sensor ideal --unobserved obstacle --outside ignored --robot-pockets obstacle "
      "--v-max 0 "
      "--static-scene --point 1.1,0,1.7 --d-min 0.5 --d-max 2.5 --principal right",
      folder);
  EXPECT_EQ(lost.exit_code, 2);
  EXPECT_THAT(lost.err, HasSubstr("no image within tolerance_s in frame 1"));
}

TEST(Stamped, ClocksThatDifferNeedTheirUncertainty) {
  const TemporaryFolder folder;
  write_stamped_wall(folder, R"("tolerance_s": 0.03, "shared_clock": false)");
  const std::string question =
      "distances . --method search --sensor ideal --box=-0.4,-0.3,0.5,0.8,0.3,2.5 --unobserved obstacle --outside "
      "ignored "
      "--robot-pockets obstacle --v-max 2 --point 0.2,0,1.7 --frames 0 ";
  EXPECT_EQ(run_command(question, folder).exit_code, 2);
  EXPECT_EQ(run_command(question + "--time-uncertainty 0.05", folder).exit_code, 0);
  EXPECT_EQ(run_command(question + "--static-scene", folder).exit_code, 0);
}

TEST(Frames, WithGapsInTheirNumbersAreChosenByNumber) {
  const TemporaryFolder folder;
  write_wall(folder);
  std::filesystem::create_directory(folder / "left");
  for (const std::string number : {"000000", "000020", "000040"}) {
    std::filesystem::copy(folder / "left_005.png", folder / ("left/" + number + ".png"));
  }
  std::string rig = read_bytes(folder / "rig.json");
  const std::size_t key = rig.find("\"frames\"");
  rig.replace(key, rig.find('}', key) + 1 - key, "\"frames\": {}");
  const std::string pattern = "left_%03d.png";
  rig.replace(rig.find(pattern), pattern.size(), "left/");
  (void)folder.write("rig.json", rig);
  const std::string question = "distances . --cameras left --sensor ideal --point 0,0,1.7 --frames ";
  const auto result = run_command(question + "0:40:40", folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("\n0,"));
  EXPECT_THAT(result.out, HasSubstr("\n40,"));
  EXPECT_EQ(result.out.find("\n20,"), std::string::npos);
  EXPECT_EQ(run_command(question + "10", folder).exit_code, 2);
  EXPECT_EQ(run_command(question + "20:30", folder).exit_code, 0);
  EXPECT_EQ(run_command(question + "41", folder).exit_code, 2);
}

}  // namespace
}  // namespace depthgrid::test
