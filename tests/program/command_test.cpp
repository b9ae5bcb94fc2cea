// What the command does when it is used as intended.
#include "program/command.hpp"

#include <gmock/gmock.h>
#include <rapidjson/document.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

namespace depthgrid::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::size_t begin = 0;
  for (std::size_t end = 0; end != std::string::npos; begin = end + 1) {
    end = line.find(',', begin);
    cells.push_back(line.substr(begin, end == std::string::npos ? end : end - begin));
  }
  return cells;
}

TEST(Command, SaysItsVersion) {
  const TemporaryFolder folder;
  const auto result = run_command("--version", folder);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out, "depthgrid " DEPTHGRID_VERSION "\n");
  EXPECT_EQ(result.err, "");
}

TEST(Command, HelpOfEveryCommandHasExamples) {
  const TemporaryFolder folder;
  for (const std::string command : {"", "demo ", "distances ", "info ", "map ", "map build ", "map info "}) {
    const auto result = run_command(command + "--help", folder);
    EXPECT_EQ(result.exit_code, 0) << command;
    EXPECT_THAT(result.out, HasSubstr("depthgrid")) << command;
    EXPECT_THAT(result.out, HasSubstr("Example")) << command;
    EXPECT_EQ(result.err, "") << command;
    const std::string examples = result.out.substr(result.out.rfind("Example"));
    EXPECT_THAT(examples, HasSubstr("depthgrid " + command)) << "of another command";
    EXPECT_EQ(examples.find("depthgrid info ../shared") != std::string::npos, command.empty() || command == "info ")
        << command << "ends with " << examples;
  }
}

TEST(Distances, OfAWallAsCsv) {
  const TemporaryFolder folder;
  write_wall(folder);
  const auto result =
      run_command("distances . --sensor ideal --point 0.2,0,1.7 --point far=0.2,0,1.2 --point beside=5,0,1", folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const auto lines = lines_of(result.out);
  ASSERT_EQ(lines.size(), 7U) << result.out;
  EXPECT_EQ(lines[0],
            "frame,time_s,point,x_m,y_m,z_m,distance_m,state,camera,nearest_x_m,nearest_y_m,nearest_z_m,"
            "direction_x,direction_y,direction_z,stale,budget,known_to_m,blind_m");
  const auto near = cells_of(lines[1]);
  ASSERT_EQ(near.size(), 19U);
  EXPECT_EQ(near[0], "5");
  EXPECT_EQ(near[1], "0.000000");
  EXPECT_EQ(near[2], "p1");
  EXPECT_EQ(near[5], "1.7");
  EXPECT_LE(std::stod(near[6]), 0.3);
  EXPECT_GE(std::stod(near[6]), 0.28);  // two cells
  EXPECT_EQ(near[7], "measured");
  EXPECT_NEAR(std::stod(near[14]), 1.0, 1e-3);
  EXPECT_NEAR(std::stod(near[17]), 0.3, 0.02);  // the grid ends at the wall
  EXPECT_EQ(near[18], "0.000000") << "recordings hold no robot";
  const auto far = cells_of(lines[2]);
  EXPECT_EQ(far[2], "far");
  EXPECT_EQ(far[6], "0.400000");
  EXPECT_EQ(far[7], "beyond_rho");
  for (std::size_t i = 8; i < 15; ++i) {
    EXPECT_EQ(far[i], "") << i;
  }
  const auto beside = cells_of(lines[3]);
  EXPECT_EQ(beside[6], "");  // not known: no number at all
  EXPECT_EQ(beside[7], "outside");
  EXPECT_EQ(beside[17], "");
  EXPECT_EQ(cells_of(lines[4])[0], "6");
  EXPECT_EQ(cells_of(lines[4])[1], "0.100000");
}

TEST(Distances, AsJsonLinesInTheFloorFrame) {
  const TemporaryFolder folder;
  write_wall(folder);
  const auto result = run_command(
      "distances rig.json --in floor --point a=0.2,0,2.7 --point b=5,0,2 --frames 6 --format jsonl --collect hybrid "
      "--output answers.jsonl",
      folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "");
  const auto lines = lines_of(read_bytes(folder / "answers.jsonl"));
  ASSERT_EQ(lines.size(), 2U);
  rapidjson::Document a;
  a.Parse(lines[0].c_str());
  ASSERT_FALSE(a.HasParseError()) << lines[0];
  EXPECT_EQ(a["frame"].GetInt(), 6);
  EXPECT_STREQ(a["point"].GetString(), "a");
  EXPECT_NEAR(a["distance_m"].GetDouble(), 0.29, 0.0101);
  EXPECT_NEAR(a["nearest_m"][2].GetDouble(), 3.0, 0.02);  // the wall in the floor frame
  EXPECT_GT(a["obstacle_points"].GetInt(), 10);
  rapidjson::Document b;
  b.Parse(lines[1].c_str());
  ASSERT_FALSE(b.HasParseError()) << lines[1];
  EXPECT_TRUE(b["distance_m"].IsNull());
  EXPECT_TRUE(b["nearest_m"].IsNull());
  EXPECT_TRUE(b["camera"].IsNull());
  EXPECT_NEAR(a["known_to_m"].GetDouble(), 0.3, 0.02);
  EXPECT_TRUE(b["known_to_m"].IsNull());
  EXPECT_EQ(a["blind_m"].GetDouble(), 0);
}

// Up is against the images' y here, so that the wall ahead stands along y.
TEST(Distances, PlacesAndDirectionsTurnWithTheFloor) {
  const TemporaryFolder folder;
  write_wall(folder);
  auto file = wall_rig();
  file.rig.T_floor_world = Pose(Eigen::AngleAxisd(-std::numbers::pi / 2, Eigen::Vector3d::UnitX()));
  files::save_rig(file, folder / "rig.json");
  const auto result =
      run_command("distances . --sensor ideal --in floor --point 0.2,1.7,0 --frames 5 --collect hybrid", folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto cells = cells_of(lines_of(result.out).at(1));
  EXPECT_NEAR(std::stod(cells.at(10)), 2, 0.02);
  for (const std::size_t direction : {12U, 19U}) {
    EXPECT_NEAR(std::stod(cells.at(direction)), 0, 0.1) << direction;
    EXPECT_GT(std::stod(cells.at(direction + 1)), direction == 12 ? 0.99 : 0.5) << direction;
    EXPECT_NEAR(std::stod(cells.at(direction + 2)), 0, 0.1) << direction;
  }
}

TEST(Distances, KnownToIsEmptyWhereOutsideCountsAsObstacle) {
  const TemporaryFolder folder;
  write_wall(folder);
  const auto result = run_command("distances . --point 0.2,0,1.7 --frames 5 --outside obstacle", folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(cells_of(lines_of(result.out).at(1)).at(17), "");
}

/// The wall at 2 m is beyond far; with clamp it frees up to there, with and without a lens to straighten.
TEST(Distances, ClampBeyondFarHoldsWithLensDistortion) {
  for (const double k1 : {0.0, -0.05}) {
    const TemporaryFolder folder;
    write_wall(folder);
    auto file = wall_rig();
    for (auto& camera : file.rig.cameras) {
      camera.distortion = make_distortion(Distortion::Model::plumb_bob, std::vector<double>{k1, 0, 0, 0, 0});
    }
    files::save_rig(file, folder / "rig.json");
    const std::string question = "distances . --point 0.2,0,1.7 --frames 5 --far 1.9";
    const auto clamped = run_command(question + " --beyond-far clamp", folder);
    const auto invalid = run_command(question + " --beyond-far invalid", folder);
    ASSERT_EQ(clamped.exit_code, 0) << clamped.err;
    ASSERT_EQ(invalid.exit_code, 0) << invalid.err;
    EXPECT_NEAR(std::stod(cells_of(lines_of(clamped.out).at(1))[6]), 0.19, 0.0151) << k1;
    EXPECT_EQ(cells_of(lines_of(invalid.out).at(1))[6], "0.000000") << k1;
  }
}

TEST(Distances, CombineDifferentTimesWhenTheUserSaysSo) {
  const TemporaryFolder folder;
  write_wall(folder);
  const std::string question = "distances . --point 0.2,0,1.7 --frames 5";
  const auto simultaneous = run_command(question, folder);
  auto file = wall_rig();
  file.simultaneous = false;
  files::save_rig(file, folder / "rig.json");
  EXPECT_EQ(run_command(question, folder).exit_code, 2);
  EXPECT_EQ(run_command(question + " --static-scene", folder).out, simultaneous.out);
  EXPECT_EQ(run_command(question + " --margin-time 0.01", folder).exit_code, 0);
  EXPECT_EQ(run_command(question + " --cameras left", folder).exit_code, 0);
}

TEST(Distances, PointsOfAFileMayMove) {
  const TemporaryFolder folder;
  write_wall(folder);
  (void)folder.write("points.csv", "frame,id,x,y,z\n5,hand,0.2,0,1.7\n6,hand,0.2,0,1.8\n");
  const auto result = run_command("distances . --points points.csv --principal right --method letter", folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto lines = lines_of(result.out);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_NEAR(std::stod(cells_of(lines[1])[6]), 0.3, 0.02);
  EXPECT_NEAR(std::stod(cells_of(lines[2])[6]), 0.2, 0.02);
}

TEST(Distances, MarginsShortenThem) {
  const TemporaryFolder folder;
  write_wall(folder);
  const auto plain = run_command("distances . --point 0.2,0,1.7 --frames 5", folder);
  const auto margin = run_command("distances . --point 0.2,0,1.7 --frames 5 --margin-constant 0.05", folder);
  ASSERT_EQ(margin.exit_code, 0) << margin.err;
  const double without_m = std::stod(cells_of(lines_of(plain.out).at(1))[6]);
  const double with_m = std::stod(cells_of(lines_of(margin.out).at(1))[6]);
  EXPECT_NEAR(without_m - with_m, 0.05, 0.0101);
}

TEST(Distances, WritesPictures) {
  const TemporaryFolder folder;
  write_wall(folder);
  const auto result = run_command("distances . --point 0.2,0,1.7 --pictures pictures", folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (const std::string name : {"pictures/frame_0005.png", "pictures/frame_0006.png"}) {
    EXPECT_THAT(read_bytes(folder / name), StartsWith("\x89PNG")) << name;
  }
}

TEST(Distances, UsesAStoredMap) {
  const TemporaryFolder folder;
  write_wall(folder);
  ASSERT_EQ(run_command("map build . --count 200 --output wall.map", folder).exit_code, 0);
  const std::string question = "distances . --variant letter --point 0.2,0,1.7 --frames 5";
  const auto stored = run_command(question + " --map wall.map", folder);
  const auto closed = run_command(question + " --count 200", folder);
  ASSERT_EQ(stored.exit_code, 0) << stored.err;
  EXPECT_EQ(stored.out, closed.out);
  EXPECT_EQ(run_command("map info wall.map", folder).exit_code, 0);
}

/// A map is for the images as they are handed out, which are larger where a lens sees more than its plain intrinsics.
TEST(Distances, MapsOfCamerasWithALensFitTheirImages) {
  const TemporaryFolder folder;
  write_wall(folder);
  auto file = wall_rig();
  for (auto& camera : file.rig.cameras) {
    camera.distortion = make_distortion(Distortion::Model::plumb_bob, std::vector<double>{-0.25, 0, 0, 0});
  }
  files::save_rig(file, folder / "rig.json");
  ASSERT_EQ(run_command("map build . --count 200 --output wall.map", folder).exit_code, 0);
  const std::string question = "distances . --variant letter --point 0.2,0,1.7 --frames 5";
  const auto stored = run_command(question + " --map wall.map", folder);
  ASSERT_EQ(stored.exit_code, 0) << stored.err;
  EXPECT_EQ(stored.out, run_command(question + " --count 200", folder).out);
}

TEST(Info, SaysHowCamerasAgree) {
  const TemporaryFolder folder;
  write_wall(folder);
  const auto result = run_command("info .", folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("wall: 2 cameras, 2 frames (5 to 6), 2 looked at, 10 a second"));
  EXPECT_THAT(result.out, ::testing::ContainsRegex("left +64 x 48 +0.0 % +2.000 ... 2.000"));
  EXPECT_THAT(result.out, ::testing::ContainsRegex("left to right +0 mm +100 % +0 mm +100 % +0 % +0 %"));
}

TEST(Info, SaysWhichHolesFreeNothingAndWhatWouldHelp) {
  const TemporaryFolder folder;
  write_wall(folder);
  std::vector<std::uint16_t> image(std::size_t{64} * 48, 2000);
  for (int v = 10; v < 15; ++v) {
    std::fill_n(image.begin() + v * 64 + 10, 5, std::uint16_t{0});
  }
  for (int i = 0; i < 4; ++i) {
    image[static_cast<std::size_t>((20 + 6 * i) * 64 + 40)] = 0;
  }
  files::write_png_gray16(folder / "left_005.png", 64, 48, image);
  const auto result = run_command("info . --frames 5 --hole-picture holes.png", folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "holes.png"));
  // The border frees nothing, 220 of 3072 pixels with a filter radius of 1, nor do 49 and 36 around the holes.
  EXPECT_THAT(result.out, ::testing::ContainsRegex("left +9.9 +[0-9.]+ +[0-9.]+ +[0-9.]+ +7.2 +smallest_obstacle_m"));
  EXPECT_THAT(result.out, ::testing::ContainsRegex("right +7.2 +7.2 +7.2 +7.2 +7.2 +none"));
  EXPECT_THAT(result.out, ::testing::ContainsRegex("left +0.1 +0.0 +0.8 +0.0 +0.0 +0.0\n"));
}

TEST(Info, SeesACameraThatStandsWrong) {
  const TemporaryFolder folder;
  write_wall(folder);
  auto file = wall_rig();
  file.rig.cameras[1].T_world_camera.translation().z() = -0.2;  // its wall is 0.2 m nearer than the other's
  files::save_rig(file, folder / "rig.json");
  const auto result = run_command("info .", folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, ::testing::ContainsRegex("left to right +20[01] mm +0 % +20[01] mm +0 % +0 % +100 %"));
  EXPECT_THAT(result.out, ::testing::ContainsRegex("right to left +20[01] mm +0 % +20[01] mm +0 % +100 % +0 %"));
  EXPECT_THAT(result.out, HasSubstr("--margin-translation 0.20"));
}

TEST(Info, SaysWhetherTheCalibrationCanBeRight) {
  const TemporaryFolder folder;
  write_wall(folder);
  const auto right = run_command("info .", folder);
  ASSERT_EQ(right.exit_code, 0) << right.err;
  EXPECT_THAT(right.out,
              ::testing::ContainsRegex("left +56.1 x 43.6 degrees; 2.00, 2.00, 2.00 m; 0.400 m from right\n"));
  EXPECT_THAT(right.out, ::testing::Not(HasSubstr("!")));

  auto file = wall_rig();
  file.rig.cameras[0].metres_per_unit = 0.01;  // 20 m, and the other one a millimetre's tenth
  file.rig.cameras[1].metres_per_unit = 0.00005;
  files::save_rig(file, folder / "rig.json");
  edit(folder, "rig.json", "\"metres_per_unit\": 0.01", "\"metres_per_unit\": 0.01, \"near_m\": 0.01");
  files::write_png_gray16(folder / "left_005.png", 64, 48, std::vector<std::uint16_t>(std::size_t{64} * 48, 3000));
  const auto wrong = run_command("info . --frames 5", folder);
  ASSERT_EQ(wrong.exit_code, 0) << wrong.err;
  EXPECT_THAT(wrong.out,
              ::testing::ContainsRegex("! half of the readings are farther than (29|30) m: is metres_per_unit "
                                       "\\(0.01\\) right\\? For images in millimetres it is 0.001"));
  EXPECT_THAT(wrong.out,
              ::testing::ContainsRegex("! half of the readings are nearer than 0.10. m: is metres_per_unit"));

  file = wall_rig();
  file.rig.cameras[1].T_world_camera = file.rig.cameras[0].T_world_camera;
  file.rig.cameras[1].intrinsics.cx_px = 16;
  files::save_rig(file, folder / "rig.json");
  const auto same = run_command("info .", folder);
  EXPECT_THAT(same.out, HasSubstr("! stands and looks where right does: was a pose left out?"));
  EXPECT_THAT(same.out, HasSubstr("! the principal point is 25 % of the image off its middle"));
}

/// A wide lens of which the plain intrinsics would keep only the middle.
TEST(Info, SaysWhatRectificationLeavesOut) {
  const TemporaryFolder folder;
  write_wall(folder);
  auto file = wall_rig();
  file.rig.cameras[0].intrinsics = {64, 48, 30.0, 30.0, 32.0, 24.0};
  file.rig.cameras[0].distortion = make_distortion(Distortion::Model::equidistant, std::vector<double>{0, 0, 0, 0});
  files::save_rig(file, folder / "rig.json");
  std::vector<std::uint16_t> image(std::size_t{64} * 48, 2000);
  std::fill_n(image.begin(), 64 * 12, 0);  // a quarter without measurement
  files::write_png_gray16(folder / "left_005.png", 64, 48, image);
  const auto result = run_command("info . --frames 5", folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, ::testing::ContainsRegex("lens distortion removed: 25.0 % of the recorded image without "
                                                   "measurement; the rectified one, 1[012][0-9] x 9[0-9], leaves out "
                                                   "[0-9]+.[0-9] % of the recorded image and [0-9]+.[0-9] % of its "
                                                   "readings\n"));
}

TEST(RigFrom, MakesAFileThatTheOtherCommandsTake) {
  const TemporaryFolder folder;
  write_wall(folder);
  for (const std::string name : {"left", "right"}) {
    (void)folder.write(
        name + ".yaml",
        "image_width: 64\nimage_height: 48\ncamera_name: " + name +
            "\ncamera_matrix: {rows: 3, cols: 3, data: [60, 0, 31.5, 0, 60, 23.5, 0, 0, 1]}\n"
            "distortion_model: plumb_bob\ndistortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, "
            "0]}\n");
  }
  const std::string question = "distances . --point 0.2,0,1.7";
  const auto before = run_command(question, folder);
  const auto made = run_command(
      "rig from left.yaml right.yaml --metres-per-unit 0.001 --sensor none --pose left=identity --pose "
      "right=0.4,0,0,0,0,0,1 --depth-files left=left_%03d.png --depth-files right=right_%03d.png --frames 5:6 --output "
      "rig.json",
      folder);
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(made.err,
            "depthgrid: warning: rig.json: says that images of one frame were taken at the same time; if they "
            "were not, write \"simultaneous\": false\n");
  EXPECT_THAT(made.out, HasSubstr("left: ROS camera_info, 64 x 48, no distortion, at (0, 0, 0) m"));
  const auto after = run_command(question, folder);
  ASSERT_EQ(after.exit_code, 0) << after.err;
  EXPECT_EQ(cells_of(lines_of(after.out).at(1))[6], cells_of(lines_of(before.out).at(1))[6]);
  const auto asked = run_command("rig from left.yaml --output new.json", folder);
  EXPECT_EQ(asked.exit_code, 2);
  EXPECT_THAT(asked.err, HasSubstr("--pose left=x,y,z,qx,qy,qz,qw"));
  EXPECT_FALSE(std::filesystem::exists(folder / "new.json"));
  EXPECT_EQ(run_command("rig from absent.yaml --output new.json", folder).exit_code, 1);
}

/// Everything in it would be free, kilometres deep.
TEST(Distances, RefuseUnitsOfOneMetre) {
  const TemporaryFolder folder;
  write_wall(folder);
  edit(folder, "rig.json", "\"metres_per_unit\": 0.001", "\"metres_per_unit\": 1000");
  const auto result = run_command("distances . --point 0.2,0,1.7", folder);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("did you mean 0.001"));
  write_wall(folder);
  EXPECT_THAT(run_command("distances . --point 0.2,0,1.7 --margin-translation 5", folder).err,
              HasSubstr("in millimetres? did you mean 0.005?"));
  EXPECT_THAT(run_command("distances . --point 0.2,0,1.7 --far 3000", folder).err, HasSubstr("did you mean 3?"));
}

TEST(Demo, Runs) {
  const TemporaryFolder folder;
  const auto result = run_command("demo", folder);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out, "");
}

}  // namespace
}  // namespace depthgrid::test
