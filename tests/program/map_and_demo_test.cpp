// depthgrid map and depthgrid demo as a user runs them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "program/command.hpp"

namespace depthgrid::test {
namespace {

using ::testing::HasSubstr;

TEST(Map, BuildsBothStoragesAndTellsWhatTheyAre) {
  const TemporaryFolder folder;
  write_wall(folder);
  for (const std::string storage : {"one-pixel", "lists"}) {
    const auto built = run_command("map build . --count 50 --storage " + storage + " --output wall.map", folder);
    ASSERT_EQ(built.exit_code, 0) << built.err;
    EXPECT_THAT(built.out + built.err, HasSubstr("of memory")) << "the memory is stated before it starts";
    const auto info = run_command("map info wall.map", folder);
    EXPECT_EQ(info.exit_code, 0) << info.err;
    EXPECT_THAT(info.out, HasSubstr(storage == "lists" ? "full pixel lists" : "one pixel a cell"));
  }
}

struct Broken {
  const char* arguments;
  const char* message;
};

TEST(Map, BrokenCommandsEndInOneLineAndLeaveNothing) {
  for (const Broken& broken : {
           Broken{"map build . --output nodir/wall.map", "nodir/wall.map"},
           Broken{"map build . --principal middle --output wall.map", "there is no camera 'middle'"},
           Broken{"map build . --count 0 --output wall.map", "count is 0 cells"},
           Broken{"map build . --step nan --output wall.map", "step"},
           Broken{"map build . --memory 0.000001 --output wall.map", "more than the 1073 available"},
           Broken{"map build nowhere --output wall.map", "nowhere"},
           Broken{"map build . --storage octree --output wall.map", "octree"},
           Broken{"map build . --output .", "cannot write .: it is a folder"},
           Broken{"map info rig.json", "rig.json"},
           Broken{"map info absent.map", "absent.map"},
       }) {
    const TemporaryFolder folder;
    write_wall(folder);
    const auto result = run_command(broken.arguments, folder);
    EXPECT_NE(result.exit_code, 0) << broken.arguments;
    EXPECT_THAT(result.err, HasSubstr(broken.message)) << broken.arguments;
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
      ++files;
      EXPECT_NE(entry.path().extension(), ".map") << broken.arguments;
    }
    EXPECT_EQ(files, 5U) << broken.arguments << ": the rig and four images, nothing else";
  }
}

TEST(Demo, ShadowObstaclesGoWithTheSecondCameraAndNoAnswerIsAboveTheTruth) {
  for (const std::string method : {"corrected", "search"}) {
    const TemporaryFolder folder;
    const auto demo = run_command("demo --method " + method + " --picture demo.png", folder);
    ASSERT_EQ(demo.exit_code, 0) << demo.err;
    EXPECT_THAT(demo.out, HasSubstr("method " + method));
    EXPECT_THAT(demo.out,
                HasSubstr("9 of 9 points have a shadow obstacle with one camera; 9 of them lose it with two"));
    EXPECT_THAT(demo.out, HasSubstr("No answer is above the true distance"));
    EXPECT_GT(std::filesystem::file_size(folder / "demo.png"), 10000U);
  }
}

TEST(Demo, ALostOutputIsAnError) {
  const TemporaryFolder folder;
  const auto demo = run_command("demo --picture nodir/demo.png", folder);
  EXPECT_EQ(demo.exit_code, 1);
  EXPECT_THAT(demo.err, HasSubstr("nodir/demo.png"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace depthgrid::test
