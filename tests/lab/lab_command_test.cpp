// depthgrid-lab as a user runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "program/command.hpp"

namespace depthgrid::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(Experiment, ListNamesThemAll) {
  const TemporaryFolder folder;
  const auto result = run_command("experiment --list", folder);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const char* name : {"shadow ", "hidden-hand ", "interference ", "cameras "}) {
    EXPECT_THAT(result.out, HasSubstr(name));
  }
  EXPECT_TRUE(folder.entries() == 0);
}

TEST(Experiment, WritesReportFiguresAndPicture) {
  const TemporaryFolder folder;
  const auto result = run_command("experiment shadow --quick --frames 3 --width 64 --seed 2 --out report", folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("report.md"));
  EXPECT_EQ(result.err, "") << "progress belongs to a terminal";
  for (const char* file : {"report.md", "figures.json", "shadow.png"}) {
    EXPECT_TRUE(std::filesystem::exists(folder / "report" / file)) << file;
  }
  EXPECT_THAT(read_bytes(folder / "report" / "figures.json"),
              HasSubstr("depthgrid-lab experiment shadow --seed 2 --quick --frames 3 --width 64"));
}

struct Broken {
  const char* arguments;
  int exit_code;
  const char* message;
};

TEST(Experiment, BrokenCommandsEndInOneLineAndLeaveNothing) {
  for (const Broken& broken : {
           Broken{"experiment", 2, "needs a NAME"},
           Broken{"experiment shadows", 2, "there is no experiment 'shadows', known are shadow, hidden-hand"},
           Broken{"experiment shadow --out file", 1, "it is a file"},
           Broken{"experiment shadow --out none/report", 1, "there is no folder"},
           Broken{"experiment shadow --out /proc/report", 1, "/proc/report"},
           Broken{"experiment shadow --frames 0", 2, "frames is 0"},
           Broken{"experiment shadow --width 33", 2, "width is 33 px"},
           Broken{"experiment shadow --width wide", 2, "wide"},
           Broken{"experiment shadow --sensor kinect", 2,
                  "there is no sensor model 'kinect', known are ideal, kinect_v1"},
           Broken{"experiment shadow --seed -1", 2, "seed"},
           Broken{"experiment shadow --seed 99999999999999999999", 2, "whole number"},
           Broken{"experiment shadow --out ''", 2, "--out"},
           Broken{"experiment shadow hidden-hand", 2, "hidden-hand"},
       }) {
    const TemporaryFolder folder;
    (void)folder.write("file", "x");
    // Small, so that an unnoticed fault does not cost minutes.
    const bool has_size = std::string(broken.arguments).find("--width") != std::string::npos ||
                          std::string(broken.arguments).find("--frames") != std::string::npos;
    const auto result = run_command(std::string(broken.arguments) + (has_size ? "" : " --frames 1 --width 32"), folder);
    EXPECT_EQ(result.exit_code, broken.exit_code) << broken.arguments;
    EXPECT_THAT(result.err, StartsWith("depthgrid-lab: ")) << broken.arguments;
    EXPECT_THAT(result.err, HasSubstr(broken.message)) << broken.arguments;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(result.out, "") << broken.arguments;
    EXPECT_EQ(folder.entries(), 1U) << broken.arguments << ": something was left behind";
  }
}

TEST(Lab, BrokenOptionsEndInOneLine) {
  const TemporaryFolder folder;
  for (const char* arguments :
       {"speedy", "speed --cameras 0", "speed --page page.md", "campaign --seeds 0", "letter", "letter rates",
        "letter rate --cameras none", "letter errors --scenes -1", "recordings --stride 0", "map-storages --slow",
        "image-in --frame-sets 0", "robot-removal --poses 0", "control-cycle --cycles 1", "worst-cases now",
        "growth --frame-sets 0", "workcell pictures none"}) {
    const auto result = run_command(arguments, folder);
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_THAT(result.err, StartsWith("depthgrid-lab: ")) << arguments;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(result.out, "") << arguments;
  }
}

TEST(Lab, ErrorsWhileWorkingEndInOneLine) {
  const TemporaryFolder folder;
  (void)folder.write("file", "{}");
  for (const Broken& broken : {Broken{"campaign --state file", 1, "file: is no state of the campaign"},
                               Broken{"campaign --page none.md", 1, "none.md: cannot be read"},
                               Broken{"speed --from file", 1, "file: is no report of the benchmark"},
                               Broken{"map-storages --quick --page file", 1, "file: lacks the line"}}) {
    const auto result = run_command(broken.arguments, folder);
    EXPECT_EQ(result.exit_code, broken.exit_code) << broken.arguments;
    EXPECT_THAT(result.err, HasSubstr(broken.message)) << broken.arguments;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  }
}

}  // namespace
}  // namespace depthgrid::test
