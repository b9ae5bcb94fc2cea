#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <string>

#include "depthgrid/cell/cell_file.hpp"
#include "depthgrid/files/mcap_export.hpp"
#include "depthgrid/files/recording.hpp"
#include "program/command.hpp"

namespace depthgrid::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A recording of two cameras, 0.1 s long, again and again.
std::string recorded_cell() {
  return R"(name: wall
smallest_obstacle_m: 0
cameras:
  - {name: left, source: recording, recording: ., repeat: true, sensor: ideal}
  - {name: right, source: recording, recording: ., repeat: true, sensor: ideal}
space: {low_m: [-0.5, -0.5, 0.5], high_m: [0.9, 0.5, 1.9]}
policies: {unobserved: ignored, outside: ignored, robot_pockets: obstacle}
v_max_m_s: 0
memory: none
ask: {rate_hz: 100, points: [{name: hand, at_m: [0.2, 0, 1.2], radius_m: 0.05}], rho_m: 0.3}
outputs: {jsonl: answers.jsonl}
)";
}

TEST(CellCommand, ShowsEveryValueWithItsOrigin) {
  const TemporaryFolder folder;
  write_wall(folder);
  (void)folder.write("cell.yaml", recorded_cell());
  const CommandResult result = run_command("cell show cell.yaml", folder);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, ::testing::ContainsRegex("ask.rho_m +0.3 m +line 10\n"));
  EXPECT_THAT(result.out, ::testing::ContainsRegex("ages.image_s +0.5 s +default\n"));
  EXPECT_THAT(result.out, ::testing::ContainsRegex("cameras.0..margins.lateral_px +1 px +model ideal\n"));
  EXPECT_THAT(result.out, ::testing::ContainsRegex("cameras.1..intrinsics +64 x 48, fx 60, fy 60 px +[.]\n"));
}

TEST(CellCommand, ChecksEachSourceOnce) {
  const TemporaryFolder folder;
  write_wall(folder);
  (void)folder.write("cell.yaml", recorded_cell());
  const CommandResult result = run_command("cell check cell.yaml", folder);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("left: recording . (left), 64 x 48 pixels, image of "));
  EXPECT_THAT(result.out, HasSubstr("100.0 % of its pixels have a reading"));
  EXPECT_THAT(result.out, HasSubstr("implausible: cell.yaml:4:5: cameras[0]: nothing says how well the camera's pose"));
}

TEST(CellCommand, ACheckThatFailsSaysWhatAndGoesOn) {
  const TemporaryFolder folder;
  write_wall(folder);
  (void)folder.write("cell.yaml", recorded_cell());
  std::filesystem::remove(folder / "left_005.png");
  std::filesystem::remove(folder / "left_006.png");
  const CommandResult result = run_command("cell check cell.yaml", folder);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, ::testing::ContainsRegex("failed: left: opened, and then: .*left_00"));
  EXPECT_THAT(result.out, HasSubstr("right: recording"));
  EXPECT_THAT(result.err, HasSubstr("depthgrid: 1 thing would keep the cell from running, the first: left"));
}

TEST(CellCommand, NewWritesOneAndNothingOver) {
  const TemporaryFolder folder;
  const CommandResult made = run_command("cell new cell.yaml", folder);
  EXPECT_EQ(made.exit_code, 0);
  if (made.out.find("found ") == std::string::npos) {  // this computer may have cameras
    EXPECT_EQ(read_bytes(folder / "cell.yaml"), cell::example_cell());
  }
  (void)folder.write("cell.yaml", "mine");
  const CommandResult again = run_command("cell new cell.yaml", folder);
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_THAT(again.err, HasSubstr("cell.yaml: is there already, and is not written over: choose another name"));
  EXPECT_EQ(read_bytes(folder / "cell.yaml"), "mine");
  EXPECT_THAT(run_command("cell new nowhere/cell.yaml", folder).err, HasSubstr("is its folder there?"));
}

TEST(RunCommand, AnswersARecordingAndSumsUp) {
  const TemporaryFolder folder;
  write_wall(folder);
  (void)folder.write("cell.yaml", recorded_cell());
  const CommandResult result = run_command("run cell.yaml --seconds 1.5", folder);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, ::testing::ContainsRegex("[1-9][.][0-9] s, [0-9]+ answers, "));
  EXPECT_THAT(result.out, HasSubstr("from exposure to answer   median "));
  EXPECT_THAT(result.out, ::testing::ContainsRegex("\n  left: [0-9]+ images"));
  EXPECT_THAT(result.err, ::testing::ContainsRegex("s  left: open: recording [.]\n"));
  EXPECT_THAT(result.err, ::testing::ContainsRegex("s  (go  |stop) .* blind layer 0.000 m . left "));
  const std::string lines = read_bytes(folder / "answers.jsonl");
  EXPECT_THAT(lines, ::testing::StartsWith(R"({"sequence":)"));
  EXPECT_TRUE(lines.find(R"("parts":[{"part":"hand","distance_m":0.)") != std::string::npos);
  EXPECT_TRUE(lines.ends_with("}]}\n")) << "the last line is whole";
  // The ball is within the box, whose border is 0.5 m away, and the wall is 0.75 m away: nothing within rho.
  EXPECT_TRUE(lines.find(R"("state":"beyond_rho")") != std::string::npos);
}

TEST(RunCommand, AFullDiskIsToldOnceAndIsNoSuccess) {
  const TemporaryFolder folder;
  write_wall(folder);
  std::string cell = recorded_cell();
  cell.replace(cell.find("answers.jsonl"), std::string("answers.jsonl").size(), "/dev/full");
  (void)folder.write("cell.yaml", cell);
  const CommandResult result = run_command("run cell.yaml --seconds 1", folder);
  EXPECT_EQ(result.exit_code, 1);
  const std::string told = "warning: /dev/full: a line was not written: No space left on device";
  EXPECT_THAT(result.err, HasSubstr(told));
  EXPECT_EQ(result.err.find(told), result.err.rfind(told));
  EXPECT_THAT(result.err, HasSubstr("an output could not be written, as was said above"));
  EXPECT_THAT(result.out, HasSubstr("answers, ")) << "it ran to its end";
}

TEST(RunCommand, RecordsAndWritesNothingOver) {
  const TemporaryFolder folder;
  write_wall(folder);
  (void)folder.write("cell.yaml", recorded_cell());
  const CommandResult result = run_command("run cell.yaml --seconds 1 --record run.mcap", folder);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, ::testing::ContainsRegex("\n  recording: [1-9][0-9]* images, 0 joint states, [1-9][0-9]* a"));
  const CommandResult again = run_command("run cell.yaml --seconds 1 --record run.mcap", folder);
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_THAT(again.err, HasSubstr("run.mcap: is there already, and is not written over: choose another name"));
  edit(folder, "cell.yaml", "outputs: {", "outputs: {record: mine.mcap, ");
  const CommandResult both = run_command("run cell.yaml --seconds 0.5 --record other.mcap", folder);
  EXPECT_EQ(both.exit_code, 0) << both.err;
  EXPECT_THAT(both.err, HasSubstr("--record other.mcap in place of mine.mcap of the cell file"));
  EXPECT_FALSE(std::filesystem::exists(folder / "mine.mcap"));
  EXPECT_EQ(run_command("run cell.yaml --seconds 0.5", folder).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "mine.mcap"));
}

TEST(RunCommand, ARecordingIsPlayedToItsEndAndAskedAgain) {
  const TemporaryFolder folder;
  write_wall(folder);
  (void)folder.write("cell.yaml", recorded_cell());
  ASSERT_EQ(run_command("run cell.yaml --seconds 1 --record run.mcap", folder).exit_code, 0);
  const CommandResult again = run_command("run run.mcap --again", folder);
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.out,
              ::testing::ContainsRegex("^[1-9][0-9]+ answers, [1-9][0-9]+ are the same to the bit when they are asked "
                                       "again, 0 differ\n$"));
  const CommandResult played = run_command("run run.mcap", folder);
  EXPECT_EQ(played.exit_code, 0) << played.err;
  EXPECT_THAT(played.err, HasSubstr("run.mcap: is played; of the cell's outputs none but the terminal"));
  EXPECT_THAT(played.err, HasSubstr("left: at its end"));
  EXPECT_EQ(run_command("run cell.yaml --again", folder).exit_code, 2);
  EXPECT_THAT(run_command("run run.mcap --again --seconds 1", folder).err,
              HasSubstr("--seconds says nothing beside it"));
  EXPECT_THAT(run_command("run run.mcap --again --record a.mcap", folder).err, HasSubstr("--record says nothing"));
  edit(folder, "cell.yaml", "recording: .,", "recording: nowhere,");
  EXPECT_EQ(run_command("run run.mcap --again", folder).exit_code, 0) << "the cell is the one that was recorded";
}

TEST(RunCommand, TopicsOfOthersAreNamedInTheCellFile) {
  const TemporaryFolder folder;
  write_wall(folder);
  {
    files::Recording recording(folder.path());
    files::save_mcap(recording, folder / "wall.mcap");
  }
  (void)folder.write("cell.yaml", recorded_cell());
  for (int camera = 0; camera < 2; ++camera) {
    edit(folder, "cell.yaml", "recording: .,", "recording: wall.mcap,");
  }
  EXPECT_EQ(run_command("cell check cell.yaml", folder).exit_code, 0) << "found by the cameras' names";
  edit(folder, "cell.yaml", "name: left, ",
       "name: eye, topic: /left/depth/image_raw, camera_info: /left/depth/camera_info, pose: {position_m: [0, 0, 0], "
       "quaternion_xyzw: [0, 0, 0, 1]}, ");
  const CommandResult checked = run_command("cell check cell.yaml", folder);
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  EXPECT_THAT(checked.out, HasSubstr("eye: recording wall.mcap (eye), 64 x 48 pixels"));
  edit(folder, "cell.yaml", "/left/depth/camera_info", "/other/camera_info");
  EXPECT_THAT(run_command("cell check cell.yaml", folder).err,
              HasSubstr("there is no /other/camera_info (camera_info topics: "));
  edit(folder, "cell.yaml", "/left/depth/image_raw", "/other");
  EXPECT_THAT(run_command("cell check cell.yaml", folder).err, HasSubstr("there is no topic '/other'; topics: "));
  edit(folder, "cell.yaml", "recording: wall.mcap, ", "recording: ., ");
  EXPECT_THAT(run_command("cell check cell.yaml", folder).err, HasSubstr("are of MCAP files, and . is none"));
}

TEST(RunCommand, LogsStopsAndKeepsNumbersForPrometheus) {
  const TemporaryFolder folder;
  write_wall(folder);
  (void)folder.write("cell.yaml", recorded_cell());
  (void)folder.write("stops.log", "before\n");
  edit(folder, "cell.yaml", "outputs: {", "outputs: {log: stops.log, prometheus: cell.prom, ");
  const CommandResult result = run_command("run cell.yaml --seconds 1.5", folder);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(read_bytes(folder / "stops.log"),
              ::testing::ContainsRegex("^before\n20[^ ]+Z (stop|go): .* m: blind layer "));
  EXPECT_THAT(read_bytes(folder / "cell.prom"), ::testing::ContainsRegex("\ndepthgrid_images_total.*taken.. [1-9]"));
  EXPECT_THAT(read_bytes(folder / "cell.prom"), HasSubstr("\ndepthgrid_stop 1\n")) << "it has ended";
  edit(folder, "cell.yaml", "outputs: {", "outputs: {record: run.mcap, ");
  edit(folder, "cell.yaml", "stops.log", "nowhere/stops.log");
  EXPECT_THAT(run_command("run cell.yaml --seconds 1", folder).err, HasSubstr("nowhere/stops.log: cannot be written"));
  EXPECT_FALSE(std::filesystem::exists(folder / "run.mcap")) << "nothing half-written";
  edit(folder, "cell.yaml", "nowhere/stops.log", "stops.log");
  edit(folder, "cell.yaml", "cell.prom", "nowhere/cell.prom");
  EXPECT_THAT(run_command("run cell.yaml --seconds 1", folder).err, HasSubstr("nowhere"));
}

TEST(RunCommand, CtrlCEndsItWithASummary) {
  const TemporaryFolder folder;
  write_wall(folder);
  (void)folder.write("cell.yaml", recorded_cell());
  const CommandResult result = run_command("run cell.yaml", folder, "timeout --signal=INT 3 ");
  EXPECT_EQ(result.exit_code, 124) << "timeout's own, when the command ended by itself after the signal";
  EXPECT_THAT(result.out, HasSubstr(" answers, "));
  EXPECT_THAT(result.err, Not(HasSubstr("stopped by SIGINT")));
}

TEST(RunCommand, BrokenFilesAndWordsAreOneLine) {
  const TemporaryFolder folder;
  (void)folder.write("cell.yaml", "name: a\ncamera: []\n");
  const CommandResult broken = run_command("run cell.yaml", folder);
  EXPECT_EQ(broken.exit_code, 1);
  EXPECT_EQ(broken.err, "depthgrid: cell.yaml:2:1: unknown key 'camera' (did you mean 'cameras'?)\n");
  EXPECT_EQ(run_command("run nowhere.yaml", folder).exit_code, 1);
  EXPECT_EQ(run_command("run cell.yaml --seconds 0", folder).exit_code, 2);
  EXPECT_EQ(run_command("run", folder).exit_code, 2);
  EXPECT_EQ(run_command("cell", folder).exit_code, 2);
}

}  // namespace
}  // namespace depthgrid::test
