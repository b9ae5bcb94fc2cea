// That every number the user states reaches the place where it counts: each changes an answer by as much as it should.
#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <vector>

#include "depthgrid/core/sensor_models.hpp"
#include "program/answer_rows.hpp"

namespace depthgrid::test {
namespace {

const std::string kBox = "--box=-1.2,-0.3,0.5,1.5,0.3,2.5 ";
const std::string kIgnored = "--unobserved ignored --outside ignored --robot-pockets ignored ";
const std::string kSearch = "distances . --frames 5 --method search " + kBox + kIgnored;
const std::string kPoint = "--point 0.2,0,1.7 ";  // 0.3 m before the wall

double distance_m(const TemporaryFolder& folder, const std::string& arguments) {
  return rows_of(run_command(arguments, folder)).at(0).number("distance_m");
}

using Image = std::vector<std::uint16_t>;
Image wall_mm(std::uint16_t depth_mm) { return Image(std::size_t{64} * 48, depth_mm); }
void write(const TemporaryFolder& folder, const std::string& name, const Image& image) {
  files::write_png_gray16(folder / name, 64, 48, image);
}

TEST(Wiring, EveryMarginCountsInBothMethods) {
  const TemporaryFolder folder;
  write_wall(folder);
  for (const std::string method : {"search", "corrected"}) {
    const std::string question = (method == "search" ? kSearch + "--v-max 0 " : "distances . --frames 5 ") + kPoint;
    const double cells_m = method == "search" ? 0.006 : 0.0251;
    for (const std::string margin : {"--margin-constant 0.1", "--margin-linear 0.05", "--margin-quadratic 0.025",
                                     "--margin-translation 0.1", "--margin-rotation 0.05", "--margin-time 0.1"}) {
      EXPECT_NEAR(distance_m(folder, question + "--sensor ideal " + margin), 0.2, cells_m) << method << margin;
    }
  }
}

// A pole right of the left camera's middle: it comes six pixels nearer to the point.
TEST(Wiring, TheFilterRadiusCountsInBothMethods) {
  const TemporaryFolder folder;
  write_wall(folder);
  Image image = wall_mm(2000);
  for (std::size_t i = 0; i < image.size(); ++i) {
    image[i] = i % 64 >= 42 ? 1400 : 2000;
  }
  write(folder, "left_005.png", image);
  for (const std::string method : {"search", "corrected"}) {
    const std::string question = (method == "search" ? kSearch + "--v-max 0 " : "distances . --frames 5 ") +
                                 "--cameras left --point 0,0,1.7 --sensor ideal --margin-lateral ";
    const double at_m = 1.7 / 60;  // of a pixel
    EXPECT_NEAR(distance_m(folder, question + "0"), 10 * at_m, 0.03) << method;
    EXPECT_NEAR(distance_m(folder, question + "6"), 4 * at_m, 0.03) << method;
  }
}

TEST(Wiring, RhoAndTheResolutionReachTheSearch) {
  const TemporaryFolder folder;
  write_wall(folder);
  const std::string question = kSearch + "--v-max 0 --sensor ideal ";
  EXPECT_NEAR(distance_m(folder, question + "--point 0.2,0,1.55 --rho 0.6"), 0.45, 0.006);
  EXPECT_EQ(distance_m(folder, question + "--point 0.2,0,1.55 --rho 0.35"), 0.35);
  const std::string beside = question + "--point 0.2,0.03,1.71 ";
  EXPECT_LT(distance_m(folder, beside + "--resolution 0.2"), distance_m(folder, beside) - 0.006);
}

TEST(Wiring, FramesComeInTheirOrderHoweverTheyAreNamed) {
  const TemporaryFolder folder;
  write_wall(folder);
  const std::string question = "distances . --method search --v-max 0 --sensor ideal " + kBox + kIgnored + kPoint;
  const auto result = run_command(question + "--memory unknown --frames 6,5", folder);
  EXPECT_EQ(rows_of(result).size(), 2U);
  EXPECT_EQ(result.out, run_command(question + "--memory unknown --frames 5:6", folder).out);
}

// What is nearer than a sensor can measure is not free before a wall that it measures.
TEST(Wiring, TheBlindZoneIsThatOfTheSensor) {
  const TemporaryFolder folder;
  write_wall(folder);
  const std::string question =
      "distances . --frames 5 --method search --v-max 0 --sensor kinect_v1 --outside ignored "
      "--unobserved obstacle --robot-pockets ignored --box=-0.4,-0.1,0.1,0.8,0.1,2.5 --point 0.2,0,0.9 --rho 1 ";
  for (const auto& [option, near_m] :
       {std::pair("", sensor_model("kinect_v1").rule.near_m), std::pair("--near 0.6", 0.6)}) {
    const double answer_m = distance_m(folder, question + option);
    EXPECT_LE(answer_m, 0.9 - near_m) << option;
    EXPECT_GT(answer_m, 0.9 - near_m - 0.05) << option;
  }
}

// Points that one camera sees alone.
TEST(Wiring, EachCameraHasItsOwnMargins) {
  const TemporaryFolder folder;
  write_wall(folder);
  auto file = wall_rig();
  file.rig.cameras[0].margins = CameraMargins{{0.1, 0, 0, 0}, 0, 0, 0, 0};
  file.rig.cameras[1].margins = CameraMargins{{0.02, 0, 0, 0}, 0, 0, 0, 0};
  files::save_rig(file, folder / "rig.json");
  const auto rows = rows_of(run_command(kSearch + "--v-max 0 --point=-0.6,0,1.75 --point 1.0,0,1.75", folder));
  EXPECT_NEAR(rows.at(0).number("distance_m"), 0.15, 0.006);
  EXPECT_NEAR(rows.at(1).number("distance_m"), 0.23, 0.006);
  EXPECT_EQ(rows.at(0).text("camera"), "left");
  EXPECT_EQ(rows.at(1).text("camera"), "right");
}

TEST(Wiring, TheExposureOfTheSensorCountsWhereThingsMove) {
  const TemporaryFolder folder;
  write_wall(folder);
  const RigCamera camera = wall_rig().rig.cameras[0];
  const double half_s =
      sensor_margins(sensor_model("kinect_v1"), camera.intrinsics, camera.metres_per_unit).half_exposure_s;
  ASSERT_GT(half_s, 0.01);
  const std::string question = kSearch + "--v-max 2 --sensor kinect_v1 " + kPoint;
  const double difference_m = distance_m(folder, question + "--half-exposure 0") - distance_m(folder, question);
  EXPECT_NEAR(difference_m, 2 * half_s, 0.0061);
}

// A hole of a pixel in what the left camera sees, 3 cm wide at the wall.
TEST(Wiring, TheSmallestObstacleDecidesAboutHoles) {
  const TemporaryFolder folder;
  write_wall(folder);
  Image image = wall_mm(2000);
  image[24 * 64 + 32] = 0;
  write(folder, "left_005.png", image);
  const std::string question = kSearch + "--v-max 0 --cameras left --point 0,0,1.7 ";
  EXPECT_NEAR(distance_m(folder, question + "--sensor ideal"), 0, 0.02);
  EXPECT_GT(distance_m(folder, question + "--sensor ideal --smallest-obstacle 0.2"), 0.15);
  auto file = wall_rig();
  file.rig.cameras[0].margins = CameraMargins{.sensor = {0, 0, 0, 0}, .smallest_obstacle_m = 0.2};
  files::save_rig(file, folder / "rig.json");
  EXPECT_GT(distance_m(folder, question), 0.15);
  EXPECT_NEAR(distance_m(folder, question + "--smallest-obstacle 0"), 0, 0.02) << "nothing is assumed";
}

/// Figures of a pair: medians, shares in per cent.
std::string pair(const std::string& names, const std::string& plane_mm, const std::string& near_plane) {
  return names + " +" + plane_mm + " mm +" + near_plane + " % ";
}

// The second frame's wall is farther, for the right camera 0.2 m more than for the left one.
TEST(Wiring, InfoLooksAtEveryFrame) {
  const TemporaryFolder folder;
  write_wall(folder);
  write(folder, "left_006.png", wall_mm(2500));
  write(folder, "right_006.png", wall_mm(2700));
  const auto result = run_command("info .", folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, ::testing::ContainsRegex("left +64 x 48 +0.0 % +2.000 ... 2.500"));
  EXPECT_THAT(result.out, ::testing::ContainsRegex("right +64 x 48 +0.0 % +2.000 ... 2.700"));
  EXPECT_THAT(result.out, ::testing::ContainsRegex(pair("left to right", "[0-9]+", "(4|5)[0-9]")));
}

// No margin makes up for a camera that stands a metre from where the rig has it.
TEST(Wiring, InfoSuggestsNoPoseMarginForPosesThatAreWrong) {
  const TemporaryFolder folder;
  write_wall(folder);
  for (const std::string frame : {"005", "006"}) {
    write(folder, "right_" + frame + ".png", wall_mm(3000));
  }
  const auto result = run_command("info .", folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, ::testing::HasSubstr("  ! left to right: most surfaces that both see are not where the other "
                                               "has them: are the poses right?\n"));
  EXPECT_EQ(result.out.find("--margin-translation"), std::string::npos) << result.out;
}

TEST(Wiring, InfoLeavesOutWhatItIsToldTo) {
  const TemporaryFolder folder;
  write_wall(folder);
  const std::string compared = "left to right ";
  const std::string none = "there is no pair to compare";
  for (const auto& [options, found] :
       {std::pair("--limit 2.1", compared), std::pair("--limit 1.9", none), std::pair("--least-overlap 0.7", compared),
        std::pair("--least-overlap 0.9", none)}) {
    const auto result = run_command(std::string("info . ") + options, folder);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, ::testing::HasSubstr(found)) << options;
  }
}

}  // namespace
}  // namespace depthgrid::test
