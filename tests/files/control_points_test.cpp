// Control points from text: what is accepted, and the message of everything that is not.
#include "depthgrid/files/control_points.hpp"

#include <gtest/gtest.h>

#include "files/temporary_folder.hpp"

namespace depthgrid::files {
namespace {

using test::message_of;
using test::TemporaryFolder;

TEST(ControlPoints, WithAndWithoutHeaderAreTheSame) {
  for (const char* text : {"id,x,y,z\nhand,1,-2.5,3e-1\nelbow,0,0,+1\n", "hand,1,-2.5,3e-1\r\nelbow,0,0,+1\r\n",
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
  EXPECT_EQ(message_of([] { parse_control_point("1,2,nan", "p0"); }),
            "control point '1,2,nan': column 5: z is 'nan', must be finite");
}

}  // namespace
}  // namespace depthgrid::files
