// depthgrid distances --method search, and where the margins come from.
#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "program/answer_rows.hpp"
#include "program/command.hpp"

namespace depthgrid::test {
namespace {

using ::testing::HasSubstr;

const std::string kSpace = "--box=-0.4,-0.3,0.5,0.8,0.3,2.5 ";
const std::string kPolicies = "--unobserved obstacle --outside ignored --robot-pockets obstacle --v-max 0 ";
const std::string kSearch = "distances . --frames 5 --method search " + kSpace + kPolicies;
const std::string kPoint = "--point 0.2,0,1.7 ";

TEST(SearchCommand, DistanceOfAWallFromPointSphereAndCapsule) {
  const TemporaryFolder folder;
  write_wall(folder);
  const auto rows = rows_of(run_command(kSearch + kPoint +
                                            "--sensor ideal --point ball=0.2,0,1.7,0.05 "
                                            "--point arm=0.2,0,1.5,0.1,0.2,0.1,1.8 --point beside=5,0,1 "
                                            "--point high=0.2,0,1.2",
                                        folder));
  ASSERT_EQ(rows.size(), 5U);
  EXPECT_LE(rows[0].number("distance_m"), 0.3);
  EXPECT_GE(rows[0].number("distance_m"), 0.3 - 0.005 - 2e-5);
  EXPECT_EQ(rows[0].text("state"), "measured");
  EXPECT_THAT(rows[0].text("camera"), ::testing::AnyOf("left", "right"));
  EXPECT_NEAR(rows[0].number("known_to_m"), 0.3, 1e-6) << "the box ends 0.3 m beside the point";
  EXPECT_EQ(rows[0].text("budget"), "false");
  EXPECT_EQ(rows[0].text("stale"), "false");
  EXPECT_EQ(rows[0].text("radius_m"), "0");
  EXPECT_EQ(rows[0].text("end_x_m"), "");
  EXPECT_NEAR(rows[1].number("distance_m"), 0.25, 0.0051);
  EXPECT_EQ(rows[1].text("radius_m"), "0.05");
  EXPECT_NEAR(rows[2].number("distance_m"), 0.1, 0.0051);
  EXPECT_EQ(rows[2].text("end_z_m"), "1.8");
  EXPECT_NEAR(rows[2].number("on_axis_z_m"), 1.8, 1e-6) << "the end is nearest";
  EXPECT_EQ(rows[3].text("state"), "outside");
  EXPECT_EQ(rows[3].text("distance_m"), "");
  EXPECT_EQ(rows[4].text("state"), "beyond_rho");
  EXPECT_EQ(rows[4].number("distance_m"), 0.4);
}

TEST(SearchCommand, SaysWhichSmallestObstacleItAssumes) {
  const TemporaryFolder folder;
  write_wall(folder);
  auto file = wall_rig();
  const std::string question = kSearch + kPoint;
  const auto said = [&](const std::string& options) { return run_command(question + options, folder).err; };
  EXPECT_THAT(said("--sensor ideal"), HasSubstr("smallest obstacle: 0 m (recommended for ideal); every pixel without"));
  EXPECT_THAT(said("--sensor kinect_v1"), HasSubstr("smallest obstacle: 0.05 m (recommended for kinect_v1); what is "));
  EXPECT_THAT(said("--margin-constant 0.01"), HasSubstr("smallest obstacle: 0 m (nothing is said of it)"));
  EXPECT_THAT(said("--sensor kinect_v1 --smallest-obstacle 0.02"), HasSubstr(": 0.02 m (--smallest-obstacle)"));
  file.rig.cameras[0].margins = CameraMargins{.sensor = {.constant_m = 0.01}, .smallest_obstacle_m = 0.03};
  files::save_rig(file, folder / "rig.json");
  EXPECT_THAT(said("--sensor kinect_v1"),
              HasSubstr("'left' 0.03 m (the rig file), 'right' 0.05 m (recommended for kinect_v1); what"));
  EXPECT_THAT(said("--sensor ideal --smallest-obstacle 5"), HasSubstr("smallest obstacle is 5 m"));
  EXPECT_THAT(said("--sensor ideal --smallest-obstacle=-1"), HasSubstr("smallest obstacle is -1 m"));
  EXPECT_THAT(run_command("distances . --frames 5 --sensor ideal --smallest-obstacle 0.02 " + kPoint, folder).err,
              HasSubstr("--smallest-obstacle has no effect with --method corrected"));
}

TEST(SearchCommand, JsonLinesHaveTheShapesToo) {
  const TemporaryFolder folder;
  write_wall(folder);
  const auto result =
      run_command(kSearch + "--point a=0.2,0,1.5,0.1,0.2,0.1,1.8 --sensor ideal --format jsonl", folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out,
              HasSubstr(R"("radius_m":0.1,"end_m":[0.2,0.1,1.8],"on_axis_m":[0.200000,0.100000,1.800000])"));
}

/// Before the middle of the wall both directions are the wall's normal; near its seen edge the others pull to one side.
TEST(SearchCommand, HybridDirectionsAreUnitVectorsNearTheNearest) {
  const TemporaryFolder folder;
  write_wall(folder);
  const auto rows =
      rows_of(run_command(kSearch + kPoint + "--point far=0.2,0,1.2 --sensor ideal --collect hybrid", folder));
  const Eigen::Vector3d hybrid(rows.at(0).number("hybrid_x"), rows.at(0).number("hybrid_y"),
                               rows.at(0).number("hybrid_z"));
  EXPECT_NEAR(hybrid.norm(), 1.0, 1e-5);
  EXPECT_GT(hybrid.z(), 0.99);
  EXPECT_EQ(rows.at(1).number("hybrid_z"), 0.0) << "nothing within rho";
}

/// The floor frame of the recording is the world moved by a metre: so is the box then.
TEST(SearchCommand, TheBoxStandsInTheFrameOfThePoints) {
  const TemporaryFolder folder;
  write_wall(folder);
  const auto world = rows_of(run_command(kSearch + kPoint + "--sensor ideal", folder));
  const auto floor =
      rows_of(run_command("distances . --frames 5 --method search --in floor --sensor ideal "
                          "--box=-0.4,-0.3,1.5,0.8,0.3,3.5 --point 0.2,0,2.7 " +
                              kPolicies,
                          folder));
  EXPECT_NEAR(floor.at(0).number("distance_m"), world.at(0).number("distance_m"), 1e-4);
  EXPECT_NEAR(floor.at(0).number("known_to_m"), world.at(0).number("known_to_m"), 1e-5);
  EXPECT_NEAR(floor.at(0).number("nearest_z_m"), world.at(0).number("nearest_z_m") + 1, 0.005);
}

TEST(SearchCommand, ThePrincipalCamerasViewIsASpaceToo) {
  const TemporaryFolder folder;
  write_wall(folder);
  const auto rows =
      rows_of(run_command("distances . --frames 5 --method search --sensor ideal --principal right "
                          "--d-min 0.5 --d-max 1.9 " +
                              kPolicies + kPoint,
                          folder));
  EXPECT_NEAR(rows.at(0).number("known_to_m"), 0.2, 1e-5);
}

TEST(SearchCommand, ABudgetStopsItWithALowerBound) {
  const TemporaryFolder folder;
  write_wall(folder);
  const auto whole = rows_of(run_command(kSearch + kPoint + "--sensor ideal", folder));
  const auto stopped = rows_of(run_command(kSearch + kPoint + "--sensor ideal --budget-nodes 3", folder));
  EXPECT_EQ(stopped.at(0).text("budget"), "true");
  EXPECT_LT(stopped.at(0).number("distance_m"), whole.at(0).number("distance_m"));
}

TEST(SearchCommand, CombinesDifferentTimesOnlyWhereTheMarginsAllowForIt) {
  const TemporaryFolder folder;
  write_wall(folder);
  auto file = wall_rig();
  file.simultaneous = false;
  files::save_rig(file, folder / "rig.json");
  const std::string question = kSearch + kPoint + "--sensor ideal ";
  EXPECT_EQ(run_command(question, folder).exit_code, 2);
  EXPECT_EQ(run_command(question + "--time-uncertainty 0.01", folder).exit_code, 2) << "but nothing moves";
  EXPECT_EQ(run_command(question + "--static-scene", folder).exit_code, 0);
  EXPECT_EQ(run_command(question + "--margin-time 0.02", folder).exit_code, 0);
  const std::string moving =
      "distances . --frames 5 --method search --sensor ideal --unobserved obstacle --outside ignored "
      "--robot-pockets obstacle --v-max 2 " +
      kSpace + kPoint;
  EXPECT_EQ(run_command(moving, folder).exit_code, 2);
  const auto rows = rows_of(run_command(moving + "--time-uncertainty 0.01", folder));
  EXPECT_NEAR(rows.at(0).number("distance_m"), 0.3 - 2 * 0.01, 0.0051);
}

/// Answers of both methods that know margins, with what the rig file and the command line say.
double distance_m(const TemporaryFolder& folder, const std::string& method, const std::string& arguments) {
  const std::string question = method == "search" ? kSearch : "distances . --frames 5 ";
  return rows_of(run_command(question + kPoint + arguments, folder)).at(0).number("distance_m");
}

TEST(Margins, OfTheRigFileCountUnlessTheCommandSaysOtherwise) {
  const TemporaryFolder folder;
  write_wall(folder);
  auto file = wall_rig();
  for (RigCamera& camera : file.rig.cameras) {
    camera.margins = CameraMargins{{0.05, 0, 0, 1}, 0, 0, 0, 0};
  }
  files::save_rig(file, folder / "rig.json");
  for (const std::string method : {"search", "corrected"}) {
    const double cell_m = method == "search" ? 0.0051 : 0.0151;
    EXPECT_NEAR(distance_m(folder, method, ""), 0.25, cell_m) << method;
    EXPECT_NEAR(distance_m(folder, method, "--margin-constant 0.1"), 0.2, cell_m) << method;
    EXPECT_NEAR(distance_m(folder, method, "--sensor ideal"), 0.3, cell_m) << method;
    EXPECT_NEAR(distance_m(folder, method, "--margin-translation 0.03"), 0.22, cell_m) << method;
  }
}

TEST(Margins, TheGridTakesTheWorstOfItsCameras) {
  const TemporaryFolder folder;
  write_wall(folder);
  auto file = wall_rig();
  file.rig.cameras[0].margins = CameraMargins{{0.05, 0, 0, 1}, 0, 0, 0, 0};
  file.rig.cameras[1].margins = CameraMargins{{0.02, 0, 0, 1}, 0.03, 0, 0, 0};
  files::save_rig(file, folder / "rig.json");
  EXPECT_NEAR(distance_m(folder, "corrected", ""), 0.22, 0.0151);
  EXPECT_NEAR(distance_m(folder, "search", ""), 0.25, 0.0051) << "each camera its own: either frees what it frees";
}

TEST(Margins, OfASensorReplaceTheNoiseAndKeepTheCalibration) {
  const TemporaryFolder folder;
  write_wall(folder);
  auto file = wall_rig();
  for (RigCamera& camera : file.rig.cameras) {
    camera.margins = CameraMargins{{0.1, 0, 0, 1}, 0.03, 0, 0, 0};
  }
  files::save_rig(file, folder / "rig.json");
  const double kinect_m = 0.00245 + 0.00633 * 4;
  EXPECT_NEAR(distance_m(folder, "search", "--sensor kinect-v1"), 0.3 - kinect_m - 0.03, 0.0051);
}

/// Margins alone, as info suggests them, say nothing about the exposure; what does is enough, 0 included.
TEST(Margins, OfWhatMovesNeedTheExposure) {
  const TemporaryFolder folder;
  write_wall(folder);
  const std::string question =
      "distances . --frames 5 --method search --unobserved obstacle --outside ignored --robot-pockets obstacle "
      "--v-max 2 --margin-constant 0.05 " +
      kSpace + kPoint;
  EXPECT_EQ(run_command(question, folder).exit_code, 2);
  EXPECT_EQ(run_command(question + "--time-uncertainty 0.01 --margin-time 0.01", folder).exit_code, 2);
  EXPECT_NEAR(rows_of(run_command(question + "--half-exposure 0", folder)).at(0).number("distance_m"), 0.25, 0.0051);
  EXPECT_NEAR(rows_of(run_command(question + "--half-exposure 0.02", folder)).at(0).number("distance_m"), 0.21, 0.0051);
  EXPECT_EQ(run_command(question + "--sensor ideal", folder).exit_code, 0);

  auto file = wall_rig();
  for (RigCamera& camera : file.rig.cameras) {
    camera.margins = CameraMargins{{0.05, 0, 0, 1}, 0, 0, 0.02, 0};
  }
  files::save_rig(file, folder / "rig.json");
  EXPECT_NEAR(rows_of(run_command(question, folder)).at(0).number("distance_m"), 0.21, 0.0051);
  file.rig.cameras[1].margins->half_exposure_s = 0;
  files::save_rig(file, folder / "rig.json");
  EXPECT_EQ(run_command(question, folder).exit_code, 2);
  EXPECT_EQ(run_command(question + "--cameras left", folder).exit_code, 0);
}

TEST(Margins, InfoShowsThoseOfTheRigFile) {
  const TemporaryFolder folder;
  write_wall(folder);
  auto file = wall_rig();
  file.rig.cameras[1].sensor = "kinect_v1";
  file.rig.cameras[1].margins = CameraMargins{{0.00245, 0, 0.00633, 2}, 0.01, 0.002, 0.0333, 0};
  files::save_rig(file, folder / "rig.json");
  const auto result = run_command("info .", folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("\nleft              none\n"));
  EXPECT_THAT(result.out,
              HasSubstr("\nright             0.0024 + 0.0000 D + 0.00633 D^2 m, 2 px; 0.0100 m, 0.0020 rad; "
                        "33.3 ms, 0.0 ms (sensor kinect_v1)\n"));
}

TEST(SearchCommand, RemembersWhatEarlierFramesSawFree) {
  TemporaryFolder folder;
  write_wall(folder);
  const std::vector<std::uint16_t> near(std::size_t{64} * 48, 600);
  for (const std::string name : {"left_006.png", "right_006.png"}) {
    files::write_png_gray16(folder / name, 64, 48, near);
  }
  const std::string question = "distances . --method search " + kSpace + kPolicies + kPoint + "--sensor ideal ";
  const std::vector<Row> without = rows_of(run_command(question, folder));
  ASSERT_EQ(without.size(), 2U);
  EXPECT_EQ(without[1].number("distance_m"), 0);
  const std::vector<Row> with = rows_of(run_command(question + "--memory unknown --memory-voxel 0.02", folder));
  ASSERT_EQ(with.size(), 2U);
  EXPECT_EQ(with[0].number("distance_m"), without[0].number("distance_m"));
  EXPECT_GT(with[1].number("distance_m"), 0.15);
  EXPECT_LT(with[1].number("distance_m"), without[0].number("distance_m"));

  EXPECT_THAT(run_command(question + "--memory-voxel 0.02", folder).err, HasSubstr("--memory-voxel has no effect"));
  EXPECT_THAT(run_command(question + "--memory empty --memory-voxel 9", folder).err, HasSubstr("voxel is 9 m"));
  files::RigFile timeless = wall_rig();
  timeless.rate_hz.reset();
  files::save_rig(timeless, folder / "rig.json");
  EXPECT_THAT(run_command(question + "--memory empty", folder).err, HasSubstr("says no times"));
}

/// A wall that comes half a metre nearer in a tenth of a second.
TEST(SearchCommand, SaysWhatTheMemoryHeldImpossible) {
  const TemporaryFolder folder;
  write_wall(folder);
  const std::vector<std::uint16_t> nearer(std::size_t{64} * 48, 1500);
  for (const auto& pattern : wall_rig().depth_files) {
    files::write_png_gray16(folder / files::depth_file_name(pattern, 6), 64, 48, nearer);
  }
  const std::string question = "distances . --method search " + kSpace +
                               "--unobserved obstacle --outside ignored --robot-pockets obstacle --sensor ideal "
                               "--memory unknown --memory-voxel 0.1 --point 0.2,0,1.2 ";
  const auto wrong = run_command(question + "--v-max 1", folder);
  EXPECT_EQ(wrong.exit_code, 0);
  EXPECT_THAT(wrong.err, HasSubstr("depthgrid: warning: 1 image shows a surface where nothing could be, last at "));
  EXPECT_THAT(wrong.err, HasSubstr("(camera right): v_max is too low, a calibration or a clock is wrong"));
  const auto right = run_command(question + "--v-max 6", folder);
  EXPECT_EQ(right.exit_code, 0);
  EXPECT_THAT(right.err, ::testing::Not(HasSubstr("nothing could be")));
}

/// A hand right before both cameras in the second frame: what they saw free is hidden.
TEST(SearchCommand, SaysInWordsWhatIsNearest) {
  const TemporaryFolder folder;
  write_wall(folder);
  const std::vector<std::uint16_t> hand(std::size_t{64} * 48, 600);
  for (const auto& pattern : wall_rig().depth_files) {
    files::write_png_gray16(folder / files::depth_file_name(pattern, 6), 64, 48, hand);
  }
  const std::string question = "distances . --method search " + kSpace +
                               "--unobserved obstacle --outside ignored --robot-pockets obstacle --sensor ideal "
                               "--v-max 1 --point 0.2,0,1.6 --reasons ";
  const auto without = run_command(question, folder);
  EXPECT_EQ(without.exit_code, 0) << without.err;
  EXPECT_THAT(without.out, HasSubstr(",reason,hidden_s,from_x_m,from_y_m,from_z_m\n5,"));
  EXPECT_THAT(without.out, HasSubstr(",a surface,,,,\n6,"));
  EXPECT_THAT(without.out, HasSubstr(",space hidden behind a surface,,,,\n"));
  const auto with = run_command(question + "--memory unknown --format jsonl", folder);
  EXPECT_EQ(with.exit_code, 0) << with.err;
  EXPECT_THAT(with.out, HasSubstr("\"reason\":\"space hidden behind a surface, where nothing could be until "));
  EXPECT_THAT(with.out, ::testing::ContainsRegex("\"hidden_s\":0[.]0[0-9]+"));
  EXPECT_THAT(with.out, ::testing::ContainsRegex("\"from_m\":\\[-?[0-9.]+,-?[0-9.]+,[0-9.]+\\]"));
}

}  // namespace
}  // namespace depthgrid::test
