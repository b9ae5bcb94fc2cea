// depthgrid distances and info on MCAP files: as on the folder that they were made of.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "depthgrid/files/mcap_export.hpp"
#include "depthgrid/files/recording.hpp"
#include "program/command.hpp"

namespace depthgrid::test {
namespace {

using ::testing::HasSubstr;

const std::string kAsked =
    " --method search --box=-0.6,-0.4,0.5,0.9,0.4,3 --unobserved obstacle --outside ignored --robot-pockets obstacle "
    "--v-max 1 --sensor ideal --point hand=0.1,0,1.7,0.05 --point 0.4,0,1.2 --output - ";

/// The wall, and the same as wall.mcap.
void write_wall_as_mcap(const TemporaryFolder& folder) {
  write_wall(folder);
  files::Recording recording(folder.path());
  files::save_mcap(recording, folder / "wall.mcap");
}

/// Without the first column: numbers of frames, which messages do not have.
std::string without_numbers(const std::string& csv) {
  std::string rest;
  for (std::size_t begin = 0; begin < csv.size();) {
    const std::size_t end = csv.find('\n', begin);
    rest += csv.substr(csv.find(',', begin), end + 1 - csv.find(',', begin));
    begin = end + 1;
  }
  return rest;
}

TEST(CommandMcap, DistancesAreThoseOfTheFolder) {
  const TemporaryFolder folder;
  write_wall_as_mcap(folder);
  const auto before = run_command("distances ." + kAsked, folder);
  ASSERT_EQ(before.exit_code, 0) << before.err;
  const auto by_rig = run_command("distances wall.mcap --rig rig.json --tolerance 0.001" + kAsked, folder);
  EXPECT_EQ(by_rig.exit_code, 0) << by_rig.err;
  EXPECT_EQ(by_rig.out, before.out);
  const auto by_messages = run_command("distances wall.mcap --tolerance 0.001" + kAsked, folder);
  EXPECT_EQ(by_messages.exit_code, 0) << by_messages.err;
  EXPECT_EQ(without_numbers(by_messages.out), without_numbers(before.out));
  EXPECT_THAT(by_messages.err, HasSubstr("wall.mcap: camera 'left': 2 images of /left/depth/image_raw\n"));
  EXPECT_THAT(by_messages.err, HasSubstr("wall.mcap: the world is frame 'world'\n"));
}

TEST(CommandMcap, TheGridIsAskedToo) {
  const TemporaryFolder folder;
  write_wall_as_mcap(folder);
  const std::string asked = " --point 0.1,0,1.7 --sensor ideal";
  const auto before = run_command("distances ." + asked, folder);
  const auto after = run_command("distances wall.mcap --rig rig.json --tolerance 0.001" + asked, folder);
  EXPECT_EQ(after.exit_code, 0) << after.err;
  EXPECT_EQ(after.out, before.out);
}

TEST(CommandMcap, InfoSaysWhatItHolds) {
  const TemporaryFolder folder;
  write_wall_as_mcap(folder);
  const auto result = run_command("info wall.mcap --tolerance 0.001", folder);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("wall: 2 cameras, 2 frames (0 to 1)"));
  EXPECT_THAT(result.out, HasSubstr("left"));
  EXPECT_THAT(result.out, HasSubstr("2.000 ... 2.000"));
}

TEST(CommandMcap, WhatDoesNotFitIsSaidInALine) {
  const TemporaryFolder folder;
  write_wall_as_mcap(folder);
  (void)folder.write("cut.mcap", read_bytes(folder / "wall.mcap").substr(0, 5));
  struct Case {
    std::string line, message;
    int exit_code;
  };
  for (const auto& [line, message, exit_code] :
       {Case{"info wall.mcap", "has 2 cameras, and nothing says how far apart", 2},
        Case{"info wall.mcap --tolerance 0.001 --world map", "there is no frame 'map'", 2},
        Case{"info wall.mcap --depth-topics /words", "there is no topic '/words'; topics: ", 2},
        Case{"info wall.mcap --cameras front --tolerance 0.001", "front", 2},
        Case{"info . --world map", "are chosen of MCAP files only", 2},
        Case{"info cut.mcap", "cut.mcap: is no MCAP file", 1}, Case{"info none.mcap", "none.mcap", 1},
        Case{"info wall.mcap --tolerance 0.001 --output wall.mcap", "is the MCAP file", 2},
        Case{"info wall.mcap --tolerance 0.001 --rig none.json", "none.json", 1},
        Case{"map build wall.mcap --output x.map", "is an MCAP file, and a map is built of a rig file", 1}}) {
    const auto result = run_command(line, folder);
    EXPECT_EQ(result.exit_code, exit_code) << line << '\n' << result.err;
    EXPECT_THAT(result.err, HasSubstr(message)) << line;
    EXPECT_THAT(result.err, HasSubstr("depthgrid: ")) << line;
  }
}

TEST(CommandMcap, ACutFileIsSaidToBeCut) {
  const TemporaryFolder folder;
  write_wall_as_mcap(folder);
  const std::string bytes = read_bytes(folder / "wall.mcap");
  (void)folder.write("cut.mcap", bytes.substr(0, bytes.size() - 100));
  const auto result = run_command("info cut.mcap --tolerance 0.001", folder);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("within its summary; its messages are all there"));
}

}  // namespace
}  // namespace depthgrid::test
