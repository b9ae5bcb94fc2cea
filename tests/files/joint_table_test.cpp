// Tables of joint positions as people's programs write them.
#include "depthgrid/files/joint_table.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "support/thrown_message.hpp"

namespace depthgrid::files {
namespace {

using ::testing::AllOf;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::vector<std::string> kJoints{"A1", "panda_joint2"};

JointTable parse(const std::string& text, std::optional<double> unit = std::nullopt) {
  return parse_joint_table(text, "j.csv", kJoints, unit);
}

std::string message(const std::string& text) {
  return test::thrown_message([&] { (void)parse(text); });
}

TEST(JointTable, TakesColumnsByTheirNamesInAnyOrder) {
  const JointTable table = parse("time_s,panda_joint2,effort,A1\n0.5,2,9,1\n0.6,4,9,3\n");
  EXPECT_THAT(table.joints[0].values, ElementsAre(1, 3));
  EXPECT_THAT(table.joints[1].values, ElementsAre(2, 4));
  EXPECT_THAT(table.time_s, ElementsAre(0.5, 0.6));
  EXPECT_THAT(table.unused, ElementsAre("effort"));
  EXPECT_THAT(table.lines, ElementsAre(2, 3));
  EXPECT_TRUE(parse("time_s,A1\n0,1\n").joints[1].column.empty()) << "the file has no such joint";
}

/// The same numbers in the clothes of other programs.
TEST(JointTable, ReadsWhatFilesReallyLookLike) {
  for (const std::string text : {
           "\xEF\xBB\xBFtime_s,A1,panda_joint2\r\n0.5,1,2\r\n",
           "# robot: left\n\n# time_s,A1,panda_joint2\n0.5,1,2\n# the end\n",
           "# one row per image\n# time and position\ntime_s,A1,panda_joint2\n0.5,1,2\n",
           "time_s;A1;panda_joint2\n0.5;1;2\n",
           "time_s\tA1\tpanda_joint2\n0.5\t1\t2\n",
           "%time_s  A1   panda_joint2\n0.5   1 2\n",
           "\"time_s\", \"A1\" , \"panda_joint2\"\n \"0.5\", 1, +2\n",
           "Time [s],a1 [rad],PANDA_JOINT2 (rad)\n0.5,1,2\n",
           "time.s,A1_rad,panda_joint2_position\n0.5,1,2\n",
           "time_s,/joint_states/A1/position,/joint_states/panda_joint2/position,/joint_states/A1/"
           "velocity\n0.5,1,2,7\n",
           "time_s,position.A1,position.panda_joint2,effort.A1\n0.5,1,2,7\n",
       }) {
    const JointTable table = parse(text);
    EXPECT_THAT(table.joints[0].values, ElementsAre(1)) << text;
    EXPECT_THAT(table.joints[1].values, ElementsAre(2)) << text;
    EXPECT_THAT(table.time_s, ElementsAre(0.5)) << text;
  }
}

TEST(JointTable, AColumnSaysItsUnit) {
  const JointTable table = parse("frame,A1_deg,panda_joint2[rad]\n0,1,2\n");
  EXPECT_EQ(table.joints[0].unit, JointUnit::degrees);
  EXPECT_EQ(table.joints[1].unit, JointUnit::radians);
  EXPECT_EQ(parse("frame,A1\n0,1\n").joints[0].unit, JointUnit::not_said);
  EXPECT_EQ(parse("frame,A1_m\n0,1\n").joints[0].unit, JointUnit::metres);
}

TEST(JointTable, TimesAreSecondsWhateverTheFileHas) {
  const auto near = [](double value) { return DoubleNear(value, 1e-6); };
  EXPECT_THAT(parse("time_ms,A1\n500,1\n600,1\n").time_s, ElementsAre(near(0.5), near(0.6)));
  EXPECT_THAT(parse("timestamp_ns,A1\n1700000000500000000,1\n").time_s, ElementsAre(near(1700000000.5)));
  EXPECT_THAT(parse("header.stamp.sec,header.stamp.nanosec,A1\n1700000000,500000000,1\n").time_s,
              ElementsAre(near(1700000000.5)));
  EXPECT_THAT(parse("secs,nsecs,A1\n3,250000000,1\n").time_s, ElementsAre(near(3.25)));
  EXPECT_THAT(parse("nsecs,secs,A1\n250000000,3,1\n").time_s, ElementsAre(near(3.25))) << "the other way round";
  EXPECT_THAT(parse("time_s,time_ns,A1\n0,0,1\n1,1000000000,1\n").time_s, ElementsAre(0, 1)) << "one time, twice";
  EXPECT_THAT(parse("t,A1\n500,1\n600,1\n", 1e-3).time_s, ElementsAre(near(0.5), near(0.6))) << "stated";
}

/// Where the name does not say it the numbers may: 10 ms between rows in each unit, since 1970 and since the start.
TEST(JointTable, TheUnitOfTimesIsRecognisedAndSaid) {
  for (const auto& [start_s, unit, name] :
       std::vector<std::tuple<double, double, std::string>>{{1.7e9, 1, "taken as seconds"},
                                                            {1.7e9, 1e-3, "milliseconds"},
                                                            {1.7e9, 1e-6, "microseconds"},
                                                            {1.7e9, 1e-9, "nanoseconds"},
                                                            {4, 1, "taken as seconds"},
                                                            {4, 1e-6, "microseconds"},
                                                            {4, 1e-9, "nanoseconds"}}) {
    std::string text = "stamp,A1\n";
    for (int i = 0; i < 4; ++i) {
      text += std::to_string((start_s + 0.01 * i) / unit) + ",1\n";
    }
    if (unit < 1) {  // clocks that count
      for (std::size_t at = 0; (at = text.find(".000000", at)) != std::string::npos;) {
        text.erase(at, 7);
      }
    }
    const JointTable table = parse(text);
    EXPECT_NEAR(table.time_s[1], start_s + 0.01, 1e-5) << text;
    EXPECT_THAT(table.time_column, HasSubstr(name)) << text;
  }
}

TEST(JointTable, AUnitThatMayBeSeveralIsRefused) {
  EXPECT_THAT(message("time,A1\n0,1\n1,1\n2,1\n"), AllOf(HasSubstr("'time'"), HasSubstr("--joint-time-unit")));
  EXPECT_THAT(message("time,A1\n0,1\n10,1\n20,1\n"), HasSubstr("--joint-time-unit")) << "10 ms, or 10 s";
  EXPECT_THAT(message("time,A1\n0,1\n"), HasSubstr("--joint-time-unit")) << "one row has no step";
  EXPECT_THAT(message("time,A1\n0.0,1\n33.3,1\n66.7,1\n"), HasSubstr("--joint-time-unit")) << "33 ms, or 33 s";
  EXPECT_THAT(parse("time,A1\n0,1\n0.02,1\n").time_s, ElementsAre(0, 0.02));
}

TEST(JointTable, FramesComeInOrderAndOnce) {
  const JointTable table = parse("image,A1\n8,1\n0,2\n16,3\n");
  EXPECT_THAT(table.frames, ElementsAre(0, 8, 16));
  EXPECT_THAT(table.joints[0].values, ElementsAre(2, 1, 3));
  EXPECT_THAT(table.lines, ElementsAre(3, 2, 4));
  EXPECT_THAT(table.time_s, IsEmpty());
  EXPECT_THAT(parse("frame,time,A1\n0,0,1\n1,1,1\n").time_s, IsEmpty()) << "of no use, so its unit is not asked for";
  EXPECT_THAT(message("frame,A1\n8,1\n8,2\n"), AllOf(HasSubstr("line 3"), HasSubstr("frame 8")));
  EXPECT_THAT(message("frame,A1\n0.5,1\n"), HasSubstr("whole number"));
}

/// As pandas writes it: rows are counted, which says nothing of the images.
TEST(JointTable, AnIndexIsNoFrameNumber) {
  for (const std::string index : {"index", "idx"}) {
    const JointTable table = parse(index + ",time_s,A1\n0,0.5,1\n1,0.6,2\n");
    EXPECT_THAT(table.frames, IsEmpty());
    EXPECT_THAT(table.time_s, ElementsAre(0.5, 0.6));
    EXPECT_THAT(table.unused, ElementsAre(index));
    EXPECT_THAT(message(index + ",A1\n0,1\n"), HasSubstr("no column 'frame'"));
  }
}

TEST(JointTable, TheSameTimeAgainIsSkippedAndOneBeforeIsRefused) {
  EXPECT_THAT(parse("time_s,A1\n1,1\n1,2\n2,3\n").joints[0].values, ElementsAre(1, 3));
  EXPECT_THAT(message("time_s,A1\n1,1\n0.5,2\n"), AllOf(HasSubstr("line 3"), HasSubstr("0.5 s"), HasSubstr("line 2")));
}

TEST(JointTable, FaultsNameTheLineTheColumnAndTheValue) {
  EXPECT_THAT(message("0,1\n"), HasSubstr("header"));
  EXPECT_THAT(message("A1,panda_joint2\n1,2\n"), AllOf(HasSubstr("'time'"), HasSubstr("it has A1, panda_joint2")));
  EXPECT_THAT(message("time_s,A1\n0,one\n"), AllOf(HasSubstr("j.csv: line 2, column 'A1'"), HasSubstr("'one'")));
  EXPECT_THAT(message("time_s,A1\n0,nan\n"), HasSubstr("finite"));
  EXPECT_THAT(message("sec,nanosec,A1\n7,500000000,1\n7,-1,1\n8,0,1\n"),
              AllOf(HasSubstr("j.csv: line 3, column 'nanosec'"), HasSubstr("'-1' must be from 0 to 999999999")));
  EXPECT_THAT(message(std::string("\xFF\xFEt\0", 4)), HasSubstr("j.csv: "));
  EXPECT_THAT(message("time_s,A1\n0\n"), HasSubstr("1 values, must be 2"));
  EXPECT_THAT(message("time_s,A1,a1_rad\n0,1,1\n"), AllOf(HasSubstr("'A1' and 'a1_rad'"), HasSubstr("both")));
  EXPECT_THAT(message("time_s,A1\n"), HasSubstr("at least one row"));
  EXPECT_THAT(message(""), HasSubstr("at least one row"));
  EXPECT_NO_THROW((void)parse("time_s,A1,mode\n0,1,auto\n")) << "text in a column that is not read";
}

TEST(JointTable, ReadsTheTableOfARealArm) {
  const char* given = std::getenv("DEPTHGRID_DATA");
  const auto file = std::filesystem::path(given != nullptr ? given : "../shared/data") / "med7_zed2i/joint_states.csv";
  if (!std::filesystem::exists(file)) {
    GTEST_SKIP() << "no '" << file.string() << "': set DEPTHGRID_DATA to the folder with the recordings";
  }
  const std::vector<std::string> joints{"A1", "A2", "A3", "A4", "A5", "A6", "A7"};
  const JointTable table = load_joint_table(file, joints);
  EXPECT_THAT(table.frames, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_EQ(table.joints[1].unit, JointUnit::radians);
  EXPECT_NEAR(table.joints[1].values[0], -1.218424402, 1e-9);
  EXPECT_THAT(table.unused, IsEmpty());
}

}  // namespace
}  // namespace depthgrid::files
