// Control points from text: what is accepted, and the message of everything that is not.
#include "depthgrid/files/control_points.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <limits>

#include "files/temporary_folder.hpp"

namespace depthgrid::files {
namespace {

using test::message_of;
using test::TemporaryFolder;

TEST(ControlPoints, WithAndWithoutHeaderAreTheSame) {
  for (const char* text : {"id,x,y,z\nhand,1,-2.5,3e-1\nelbow,0,0,+1\n", "hand,1,-2.5,3e-1\r\nelbow,0,0,+1\r\n",
                           "\xEF\xBB\xBFid,x,y,z\r\nhand,1,-2.5,3e-1\r\nelbow,0,0,+1\r\n",  // of a spreadsheet
                           "# metres\n ID , X,Y ,Z # header\n\n\thand , 1,-2.5, 0.3 # the hand\nelbow,0,0,1"}) {
    const ControlPoints points = parse_control_points(text, "points.csv");
    ASSERT_EQ(points.fixed.size(), 2U) << text;
    EXPECT_TRUE(points.of_frame.empty());
    EXPECT_EQ(points.fixed[0].id, "hand");
    EXPECT_EQ(points.fixed[0].capsule.a, Eigen::Vector3d(1, -2.5, 0.3));
    EXPECT_EQ(points.fixed[1].id, "elbow");
    EXPECT_EQ(points.fixed[1].capsule.a, Eigen::Vector3d(0, 0, 1));
    EXPECT_EQ(points.at(0).size(), 2U);
    EXPECT_EQ(points.at(77).data(), points.fixed.data());
  }
}

TEST(ControlPoints, AHeaderMaySayMetres) {
  const ControlPoints points =
      parse_control_points("frame,id,X_m,y_m,z,radius_m,x2_m,y2_m,z2_m\n3,arm,1,2,3,0.1,4,5,6\n", "points.csv");
  ASSERT_EQ(points.at(3).size(), 1U);
  EXPECT_EQ(points.at(3)[0].capsule.a, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(points.at(3)[0].capsule.b, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(points.at(3)[0].capsule.radius_m, 0.1);
  EXPECT_EQ(parse_control_points("id,x_m,y_m,z_m\nhand,1,2,3\n", "points.csv").fixed.size(), 1U);
  EXPECT_EQ(message_of([] { parse_control_points("id,x_mm,y_mm,z_mm\nhand,1,2,3\n", "points.csv"); }),
            "points.csv: line 1, column 4: x is 'x_mm', must be a number in metres");
  EXPECT_EQ(message_of([] { parse_control_points("id_m,x_m,y_m,z_m\nhand,1,2,3\n", "points.csv"); }),
            "points.csv: line 1, column 6: x is 'x_m', must be a number in metres");
}

TEST(ControlPoints, MovingPointsAreThoseOfTheirFrame) {
  const ControlPoints points =
      parse_control_points("frame,id,x,y,z\n8,hand,1,2,3\n8,elbow,0,0,1\n10,hand,1,2,4\n", "points.csv");
  EXPECT_TRUE(points.fixed.empty());
  ASSERT_EQ(points.at(8).size(), 2U);
  EXPECT_EQ(points.at(8)[1].id, "elbow");
  EXPECT_TRUE(points.at(9).empty());
  ASSERT_EQ(points.at(10).size(), 1U);
  EXPECT_EQ(points.at(10)[0].capsule.a.z(), 4);
}

TEST(ControlPoints, SpheresAndCapsulesHaveAHeader) {
  const ControlPoints spheres = parse_control_points("id,x,y,z,radius\nhand,1,2,3,0.1\ntip,4,5,6,\n", "points.csv");
  ASSERT_EQ(spheres.fixed.size(), 2U);
  EXPECT_EQ(spheres.fixed[0].capsule.radius_m, 0.1);
  EXPECT_FALSE(spheres.fixed[0].has_end);
  EXPECT_EQ(spheres.fixed[1].capsule.radius_m, 0.0);
  const ControlPoints capsules = parse_control_points(
      "Frame,id,x,y,z,radius,x2,y2,z2\n7,arm,1,2,3,0.1,4,5,6\n7,hand,0,0,1,0.05,,,\n", "points.csv");
  ASSERT_EQ(capsules.at(7).size(), 2U);
  EXPECT_EQ(capsules.at(7)[0].capsule.a, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(capsules.at(7)[0].capsule.radius_m, 0.1);
  ASSERT_TRUE(capsules.at(7)[0].has_end);
  EXPECT_EQ(capsules.at(7)[0].capsule.b, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(capsules.at(7)[1].capsule.radius_m, 0.05);
  EXPECT_FALSE(capsules.at(7)[1].has_end);
}

TEST(ControlPoints, LoadIsParseOfTheFile) {
  const TemporaryFolder folder;
  EXPECT_EQ(load_control_points(folder.write("points.csv", "a,1,2,3\n")).fixed.size(), 1U);
}

TEST(ControlPoints, OnePointFromTheCommandLine) {
  const ControlPoint point = parse_control_point(" 0.5, -1 ,2e0", "p0");
  EXPECT_EQ(point.id, "p0");
  EXPECT_EQ(point.capsule.a, Eigen::Vector3d(0.5, -1, 2));
  EXPECT_EQ(point.capsule.radius_m, 0.0);
  EXPECT_EQ(parse_control_point("0,0,1,0.25", "p0").capsule.radius_m, 0.25);
  const ControlPoint capsule = parse_control_point("0,0,1,0.25,3,4,5", "p0");
  EXPECT_EQ(capsule.capsule.radius_m, 0.25);
  EXPECT_EQ(capsule.capsule.b, Eigen::Vector3d(3, 4, 5));
}

struct Broken {
  const char* name;
  std::string text;
  const char* message;
};

void PrintTo(const Broken& broken, std::ostream* out) { *out << broken.name; }

class BrokenControlPoints : public ::testing::TestWithParam<Broken> {};

TEST_P(BrokenControlPoints, AreRefusedWithTheirReason) {
  EXPECT_EQ(message_of([] { parse_control_points(GetParam().text, "points.csv"); }), GetParam().message);
}

const Broken kBroken[] = {
    {"Empty", "", "points.csv: holds no control point, needs at least one row id,x,y,z"},
    {"OnlyHeader", "id,x,y,z\n# nothing\n", "points.csv: holds no control point, needs at least one row id,x,y,z"},
    {"NoNumber", "id,x,y,z\nhand,1,abc,3\n", "points.csv: line 2, column 8: y is 'abc', must be a number in metres"},
    {"NumberWithUnit", "hand, 1 m,2,3\n", "points.csv: line 1, column 7: x is '1 m', must be a number in metres"},
    {"EmptyValue", "hand,1,,3\n", "points.csv: line 1, column 8: y is '', must be a number in metres"},
    {"NotANumber", "hand,1,2,nan\n", "points.csv: line 1, column 10: z is 'nan', must be finite"},
    {"Infinity", "hand,-inf,2,3\n", "points.csv: line 1, column 6: x is '-inf', must be finite"},
    {"TooLarge", "hand,1e999,2,3\n", "points.csv: line 1, column 6: x is '1e999', must be a number in metres"},
    {"FartherThanCoordinatesGo", "hand,1,-1e308,3\n",
     "points.csv: line 1, column 8: y is '-1e308', must be at most 1e5 m from 0"},
    {"HugeRadius", "id,x,y,z,radius\nhand,1,2,3,1e300\n",
     "points.csv: line 2, column 12: radius is '1e300', must be at most 1e5 m from 0"},
    {"EscapeInId", "\x1b[2Jhand,1,2,3\n",
     "points.csv: line 1, column 1: id '\\x1b[2Jhand' holds a character that cannot be printed, ids must not"},
    {"NulInId", std::string("ha\0nd,1,2,3\n", 12),
     "points.csv: line 1, column 1: id 'ha\\x00nd' holds a character that cannot be printed, ids must not"},
    {"EscapeInNumber", "hand,\x1b]0;x,2,3\n",
     "points.csv: line 1, column 6: x is '\\x1b]0;x', must be a number in metres"},
    {"LongValue", "hand,1,2," + std::string(1000, '7') + "x\n",
     "points.csv: line 1, column 10: z is '777777777777777777777777777777777777777777777777777777777777...', must be a "
     "number in metres"},
    {"TwoSigns", "hand,+-1,2,3\n", "points.csv: line 1, column 6: x is '+-1', must be a number in metres"},
    {"ThreeValues", "1,2,3\n",
     "points.csv: line 1, column 1: 3 values, must be 4 (id,x,y,z) or 5 (frame,id,x,y,z); "
     "radius and x2,y2,z2 need a header row"},
    {"SixValues", "0,hand,1,2,3,4\n",
     "points.csv: line 1, column 1: 6 values, must be 4 (id,x,y,z) or 5 (frame,id,x,y,z); "
     "radius and x2,y2,z2 need a header row"},
    {"OneValueLess", "id,x,y,z\nhand,1,2\n", "points.csv: line 2, column 1: 3 values, must be 4 as in the first row"},
    {"OtherColumns", "hand,1,2,3\n\n  8,hand,1,2,3\n",
     "points.csv: line 3, column 3: 5 values, must be 4 as in the first row"},
    {"DecimalComma", "hand,1,5,2,3\n", "points.csv: line 1, column 1: frame is 'hand', must be a whole number from 0"},
    {"FractionalFrame", "frame,id,x,y,z\n1.5,hand,1,2,3\n",
     "points.csv: line 2, column 1: frame is '1.5', must be a whole number from 0"},
    {"NegativeFrame", "-1,hand,1,2,3\n", "points.csv: line 1, column 1: frame is '-1', must be a whole number from 0"},
    {"EmptyId", ",1,2,3\n", "points.csv: line 1, column 1: the id is empty, every control point needs one"},
    {"IdTwice", "hand,1,2,3\nhand,1,2,4\n",
     "points.csv: line 2, column 1: id 'hand' occurs twice, ids must be distinct"},
    {"IdTwiceInAFrame", "4,hand,1,2,3\n5,hand,1,2,3\n4,hand,1,2,4\n",
     "points.csv: line 3, column 3: id 'hand' occurs twice, ids must be distinct"},
    {"HeaderInTheMiddle", "hand,1,2,3\nid,x,y,z\n",
     "points.csv: line 2, column 4: x is 'x', must be a number in metres"},
    {"Semicolons", "hand;1;2;3\n",
     "points.csv: line 1, column 1: 1 values, must be 4 (id,x,y,z) or 5 (frame,id,x,y,z); "
     "radius and x2,y2,z2 need a header row"},
    {"NegativeRadius", "id,x,y,z,radius\nhand,1,2,3,-0.1\n",
     "points.csv: line 2, column 12: radius is '-0.1', must not be negative"},
    {"NoRadius", "id,x,y,z,radius\nhand,1,2,3,nan\n", "points.csv: line 2, column 12: radius is 'nan', must be finite"},
    {"HalfAnEnd", "id,x,y,z,radius,x2,y2,z2\nhand,1,2,3,0.1,,5,6\n",
     "points.csv: line 2, column 16: x2 is '', must be a number in metres"},
    {"CapsuleCutOff", "id,x,y,z,radius,x2,y2,z2\nhand,1,2,3,0.1\n",
     "points.csv: line 2, column 1: 5 values, must be 8 as in the first row"},
    {"RadiusWithoutHeader", "hand,1,2,3,0.1\n",
     "points.csv: line 1, column 1: frame is 'hand', must be a whole number from 0"},
    {"HeaderInAnotherOrder", "id,x,y,z,x2,y2,z2,radius\n",
     "points.csv: line 1, column 1: 8 values, must be 4 (id,x,y,z) or 5 (frame,id,x,y,z); radius and x2,y2,z2 need a "
     "header row"},
};
INSTANTIATE_TEST_SUITE_P(All, BrokenControlPoints, ::testing::ValuesIn(kBroken),
                         [](const auto& broken) { return broken.param.name; });

TEST(BrokenControlPointFile, AbsentFileIsNamed) {
  const TemporaryFolder folder;
  EXPECT_EQ(message_of([&] { load_control_points(folder / "points.csv"); }, folder.path()),
            "points.csv: cannot be read: No such file or directory");
}

/// A hundred thousand ids of one frame: quadratic work would be 5e9 comparisons, minutes. The ratio of two sizes, in
/// turns, is what is asserted.
TEST(ControlPoints, AreNotQuadraticInTheirIds) {
  const auto rows = [](int count) {
    std::string text;
    for (int k = 0; k < count; ++k) {
      text += "a point with a long common beginning " + std::to_string(k) + ",1,2,3\n";
    }
    return text;
  };
  const std::string few = rows(4000);
  const std::string many = rows(64000);
  double ratio = std::numeric_limits<double>::infinity();
  for (int turn = 0; turn < 5; ++turn) {
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(parse_control_points(few, "few").fixed.size(), 4000U);
    const auto middle = std::chrono::steady_clock::now();
    EXPECT_EQ(parse_control_points(many, "many").fixed.size(), 64000U);
    const auto end = std::chrono::steady_clock::now();
    ratio =
        std::min(ratio, std::chrono::duration<double>(end - middle) / std::chrono::duration<double>(middle - begin));
  }
  EXPECT_LT(ratio, 64.0) << "16 times the rows; quadratic work would take 256 times as long";
}

TEST(ControlPoints, IdsOfOtherScriptsPass) {
  EXPECT_EQ(parse_control_points("Ellenbogen links \xc3\xbc\xe6\x89\x8b,1,2,3\n", "points.csv").fixed.size(), 1U);
}

TEST(BrokenControlPointFile, PipesAndDevicesAreRefusedAtOnce) {
  const TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "points.csv").c_str(), 0600), 0);
  EXPECT_EQ(message_of([&] { load_control_points(folder / "points.csv"); }, folder.path()),
            "points.csv: is a pipe, must be a regular file; copy what it gives into one");
  EXPECT_EQ(message_of([] { load_control_points("/dev/zero"); }),
            "/dev/zero: is a device, must be a regular file; copy what it gives into one");
}

TEST(BrokenControlPointFile, ALargeOneIsRefusedBeforeItIsRead) {
  const TemporaryFolder folder;
  const auto file = folder.write("points.csv", "hand,1,2,3\n");
  std::filesystem::resize_file(file, std::uintmax_t{1} << 40U);  // a hole, which takes no room on the disk
  EXPECT_EQ(message_of([&] { load_control_points(file); }, folder.path()),
            "points.csv: has 1099511627776 bytes, must have at most 67108864");
}

TEST(BrokenControlPointFile, FolderIsNamed) {
  const TemporaryFolder folder;
  EXPECT_EQ(message_of([&] { load_control_points(folder.path() / "."); }, folder.path()),
            ".: cannot be read: Is a directory");
}

TEST(BrokenControlPoint, OfTheCommandLineNamesTheText) {
  EXPECT_EQ(message_of([] { parse_control_point("1,2", "p0"); }),
            "control point '1,2': column 1: 2 values, must be 3 (x,y,z in metres), 4 (with a radius) or 7 "
            "(x,y,z,radius,x2,y2,z2)");
  EXPECT_EQ(message_of([] { parse_control_point("1,2,3,-1", "p0"); }),
            "control point '1,2,3,-1': column 7: radius is '-1', must not be negative");
  EXPECT_EQ(message_of([] { parse_control_point("1,2,3", "p\n"); }),
            "control point '1,2,3': id 'p\\n' is empty or holds a character that cannot be printed");
  EXPECT_EQ(message_of([] { parse_control_point("1,2,nan", "p0"); }),
            "control point '1,2,nan': column 5: z is 'nan', must be finite");
}

}  // namespace
}  // namespace depthgrid::files
