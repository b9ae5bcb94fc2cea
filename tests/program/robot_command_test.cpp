// depthgrid robot: what it says of a robot file, against shapes whose numbers are known.
#include <gmock/gmock.h>
#include <rapidjson/document.h>

#include <cmath>
#include <numbers>
#include <string>

#include "program/command.hpp"
#include "program/picture_colours.hpp"

namespace depthgrid::test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// A tetrahedron with three edges of 0.3 m along the axes, of volume 0.3^3 / 6; without its last face where `open`.
std::string tetrahedron(bool open) {
  return std::string("v 0 0 0\nv 0.3 0 0\nv 0 0.3 0\nv 0 0 0.3\nf 1 3 2\nf 1 2 4\nf 1 4 3\n") +
         (open ? "" : "f 2 3 4\n");
}

/// Base (mesh), arm (a sphere; its visual shape is a longer box), slide (no shape), finger (mimics the slide).
std::string urdf(const std::string& mesh) {
  return R"(<robot name="twolink">
  <link name="base"><collision><geometry><mesh filename=")" +
         mesh + R"("/></geometry></collision></link>
  <link name="arm">
    <visual><geometry><box size="0.4 0.1 0.1"/></geometry></visual>
    <collision><geometry><sphere radius="0.1"/></geometry></collision>
  </link>
  <link name="slide"/>
  <link name="finger"><collision><geometry><capsule radius="0.02" length="0.1"/></geometry></collision></link>
  <joint name="turn" type="revolute"><origin xyz="0 0 0.5"/><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>
    <limit lower="-1.6" upper="1.6" velocity="0"/></joint>
  <joint name="push" type="prismatic"><origin xyz="0.3 0 0"/><parent link="arm"/><child link="slide"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="0.2" velocity="0.5"/></joint>
  <joint name="follow" type="prismatic"><parent link="slide"/><child link="finger"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="0.2" velocity="0.5"/><mimic joint="push" multiplier="-2" offset="0.1"/></joint>
</robot>)";
}

void write_robot(const TemporaryFolder& folder, const std::string& mesh = "m.obj", bool open = false) {
  (void)folder.write("m.obj", tetrahedron(open));
  (void)folder.write("r.urdf", urdf(mesh));
}

rapidjson::Document json_of(const CommandResult& result) {
  EXPECT_EQ(result.exit_code, 0) << result.err;
  rapidjson::Document document;
  document.Parse(result.out.c_str());
  EXPECT_FALSE(document.HasParseError()) << result.out;
  return document;
}

/// Pixels of the red that only corners outside have; the line below the picture has a dot of its own.
long red_pixels(const std::filesystem::path& file) { return PictureColours(file, 660).of(217, 13, 13); }

TEST(RobotCommand, ListsJointsLinksAndWhatIsMissing) {
  const TemporaryFolder folder;
  write_robot(folder);
  const auto result = run_command("robot r.urdf", folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, StartsWith("r.urdf: loads. Robot 'twolink', root base, 4 links, 2 joints with"));
  EXPECT_THAT(result.out, ContainsRegex("turn +revolute +-1.600 +1.600 rad +not stated +arm\n"));
  EXPECT_THAT(result.out, ContainsRegex("push +prismatic +0.000 +0.200 m +0.500 m/s +slide\n"));
  EXPECT_THAT(result.out, ContainsRegex("follow +prismatic .* finger +-2 x push \\+ 0.1\n"));
  EXPECT_THAT(result.out, ContainsRegex("base +collision mesh m.obj, 4 triangles +1 of 1 "));
  EXPECT_THAT(result.out, ContainsRegex("arm +collision sphere +1 of 1 +0.100 m +0.000 m +1.00 times +touches"));
  EXPECT_THAT(result.out, ContainsRegex("slide +none"));
  EXPECT_THAT(result.out, ContainsRegex("links without shapes, .*: slide\n"));
  EXPECT_THAT(result.out, ContainsRegex("speeds not stated, .*: turn\n"));
}

TEST(RobotCommand, SetsCapsulesAgainstShapes) {
  const TemporaryFolder folder;
  write_robot(folder);
  const auto document = json_of(run_command("robot r.urdf --json", folder));
  const auto& base = document["links"][0];
  const auto& capsule = base["capsules"][0];
  double length = 0;
  for (rapidjson::SizeType k = 0; k < 3; ++k) {
    length = std::hypot(length, capsule["b_m"][k].GetDouble() - capsule["a_m"][k].GetDouble());
  }
  const double r = capsule["radius_m"].GetDouble();
  const double volume = std::numbers::pi * r * r * (length + 4.0 / 3.0 * r);
  EXPECT_NEAR(base["volume_ratio"].GetDouble(), volume / (0.3 * 0.3 * 0.3 / 6), 1e-9);
  EXPECT_NEAR(base["outermost_corner_inside_m"].GetDouble(), 0, 1e-9);
  EXPECT_TRUE(base["outermost_corner_of_other_shapes_inside_m"].IsNull());
  // A corner of the visual box against the sphere.
  const double corner_m = std::sqrt(0.2 * 0.2 + 2 * 0.05 * 0.05);
  EXPECT_NEAR(document["links"][1]["outermost_corner_of_other_shapes_inside_m"].GetDouble(), 0.1 - corner_m, 1e-9);
  EXPECT_THAT(run_command("robot r.urdf", folder).out, HasSubstr("112.1 mm outside"));
  EXPECT_TRUE(document["joints"][0]["speed"].IsNull());
  EXPECT_EQ(document["joints"][2]["mimic"]["multiplier"].GetDouble(), -2);
}

TEST(RobotCommand, AnOpenMeshHasNoVolume) {
  const TemporaryFolder folder;
  write_robot(folder, "m.obj", true);
  EXPECT_THAT(run_command("robot r.urdf", folder).out, ContainsRegex("base .* mesh is open "));
}

TEST(RobotCommand, VisualShapesCountWhereTheyAreAskedFor) {
  const TemporaryFolder folder;
  write_robot(folder);
  const auto document = json_of(run_command("robot r.urdf --shapes visual --json", folder));
  EXPECT_STREQ(document["links"][1]["kind"].GetString(), "visual");
  EXPECT_STREQ(document["links"][1]["shapes"][0].GetString(), "box");
  EXPECT_STREQ(document["links"][0]["kind"].GetString(), "collision") << "the base has no others";
}

TEST(RobotCommand, MeshesThatAreNotThereNameTheOptionThatFindsThem) {
  const TemporaryFolder folder;
  write_robot(folder, "package://arm_description/m.obj");
  const auto lost = run_command("robot r.urdf --output r.png", folder);
  EXPECT_EQ(lost.exit_code, 1);
  EXPECT_EQ(lost.err,
            "depthgrid: r.urdf: 1 mesh file is not there: package://arm_description/m.obj of link 'base'; state "
            "--package arm_description=FOLDER\n");
  EXPECT_THAT(lost.out, HasSubstr("does not load"));
  EXPECT_THAT(lost.out, ContainsRegex("arm +collision sphere +1 of 1 ")) << "the other links are shown";
  EXPECT_FALSE(std::filesystem::exists(folder / "r.png"));
  const auto found = run_command("robot r.urdf --package arm_description=.", folder);
  EXPECT_EQ(found.exit_code, 0) << found.err;
  EXPECT_THAT(found.out, HasSubstr(": loads."));
  EXPECT_EQ(run_command("robot r.urdf --package arm_description=nowhere", folder).exit_code, 1);
  EXPECT_EQ(run_command("robot r.urdf --package arm_description", folder).exit_code, 2);
}

TEST(RobotCommand, ABrokenFileIsOneLine) {
  const TemporaryFolder folder;
  (void)folder.write("r.urdf", "<robot name='r'><Link name='a'/></robot>");
  const auto result = run_command("robot r.urdf", folder);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, ContainsRegex("^depthgrid: r.urdf: .*Link.*\n$"));
  EXPECT_EQ(run_command("robot", folder).exit_code, 2);
}

/// The slide is at (0.3 + 0.1) m along the arm, which points along y after a quarter turn.
TEST(RobotCommand, SaysWhereTheTipStands) {
  const TemporaryFolder folder;
  write_robot(folder);
  const auto document =
      json_of(run_command("robot r.urdf --tip slide --joints turn=1.5707963267948966,push=0.1 --json", folder));
  EXPECT_NEAR(document["tip_at_m"][0].GetDouble(), 0, 1e-9);
  EXPECT_NEAR(document["tip_at_m"][1].GetDouble(), 0.4, 1e-9);
  EXPECT_NEAR(document["tip_at_m"][2].GetDouble(), 0.5, 1e-9);
  EXPECT_EQ(document["links"].Size(), 3U) << "the finger is not on the way";
  EXPECT_EQ(document["joints"].Size(), 2U);
  EXPECT_THAT(run_command("robot r.urdf --tip slide --joints 1.5707963267948966,0.1", folder).out,
              HasSubstr("tip slide at these joint positions: 0.0000, 0.4000, 0.5000 m from the root"));
  EXPECT_EQ(run_command("robot r.urdf --tip hand", folder).exit_code, 2);
}

TEST(RobotCommand, JointPositionsAreRadiansOfItsJoints) {
  const TemporaryFolder folder;
  write_robot(folder);
  const auto degrees = run_command("robot r.urdf --joints 60,0.1", folder);
  EXPECT_EQ(degrees.exit_code, 2);
  EXPECT_THAT(degrees.err, AllOf(HasSubstr("'turn'"), HasSubstr("-1.6 and 1.6 rad"), HasSubstr("in degrees?")));
  EXPECT_THAT(run_command("robot r.urdf --joints 0,60", folder).err, Not(HasSubstr("degrees")));
  EXPECT_THAT(run_command("robot r.urdf --joints 0", folder).err, HasSubstr("1 number for 2 joints"));
  EXPECT_THAT(run_command("robot r.urdf --joints turn=0,turn=1", folder).err, HasSubstr("'turn' is given twice"));
  EXPECT_THAT(run_command("robot r.urdf --joints push=100", folder).err, HasSubstr("is this one in millimetres?"));
  EXPECT_THAT(run_command("robot r.urdf --joints elbow=0", folder).err, HasSubstr("it has turn, push"));
}

TEST(RobotCommand, ThePictureMarksCornersOutside) {
  const TemporaryFolder folder;
  write_robot(folder);
  ASSERT_EQ(run_command("robot r.urdf --output outside.png", folder).exit_code, 0);
  EXPECT_GT(red_pixels(folder / "outside.png"), 10);
  edit(folder, "r.urdf", "0.4 0.1 0.1", "0.1 0.1 0.1");  // now the sphere holds the box
  ASSERT_EQ(run_command("robot r.urdf --output inside.png", folder).exit_code, 0);
  EXPECT_EQ(red_pixels(folder / "inside.png"), 0);
  EXPECT_EQ(run_command("robot r.urdf --output nowhere/r.png", folder).exit_code, 1);
}

TEST(RobotCommand, ItsPictureDoesNotReplaceTheRobot) {
  const TemporaryFolder folder;
  write_robot(folder);
  const std::string before = read_bytes(folder / "r.urdf");
  const auto result = run_command("robot r.urdf --output ./r.urdf", folder);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("--output ./r.urdf is the robot's URDF file r.urdf"));
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(read_bytes(folder / "r.urdf"), before);
}

TEST(RobotCommand, FileNamesDoNotSteerTheTerminal) {
  const TemporaryFolder folder;
  write_robot(folder);
  std::filesystem::rename(folder / "r.urdf", folder / "\x1b[31m.urdf");
  const auto result = run_command("robot \"$(printf '\\033[31m').urdf\"", folder);
  EXPECT_THAT(result.out, StartsWith("\\x1b[31m.urdf: loads"));
  EXPECT_THAT(result.out, Not(HasSubstr("\x1b")));
}

/// A mesh is read, too, whether its shape counts or not.
TEST(RobotCommand, ItsPictureReplacesNoMesh) {
  const TemporaryFolder folder;
  const std::string mesh =
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0.1 0 0\nvertex 0 0.1 0.1\n"
      "endloop\nendfacet\nendsolid a\n";
  (void)folder.write("meshes/a.stl", mesh);
  (void)folder.write("meshes/seen.stl", mesh);
  const auto shape = [](const std::string& kind, const std::string& file) {
    return "<" + kind + "><geometry><mesh filename=\"meshes/" + file + "\"/></geometry></" + kind + ">";
  };
  (void)folder.write("m.urdf", "<robot name=\"m\"><link name=\"a\">" + shape("collision", "a.stl") +
                                   shape("visual", "seen.stl") + "</link></robot>");
  for (const std::string file : {"meshes/a.stl", "meshes/seen.stl", "link.png"}) {
    if (file == "link.png") {
      std::filesystem::create_symlink("meshes/a.stl", folder / "link.png");
    }
    const auto result = run_command("robot m.urdf --output " + file, folder);
    EXPECT_EQ(result.exit_code, 2) << file;
    EXPECT_THAT(result.err, HasSubstr("--output " + file + " is the mesh ")) << file;
    EXPECT_EQ(read_bytes(folder / file), mesh);
  }
  EXPECT_EQ(run_command("robot m.urdf --output new.png", folder).exit_code, 0);
}

/// The robots of the data folder, where they are there.
TEST(RobotCommand, LoadsRealRobots) {
  const char* given = std::getenv("DEPTHGRID_DATA");
  const auto data = std::filesystem::absolute(given != nullptr ? given : "../shared/data");
  if (!std::filesystem::is_directory(data / "robots")) {
    GTEST_SKIP() << "no robots in '" << data.string() << "': set DEPTHGRID_DATA to their folder";
  }
  const TemporaryFolder folder;
  const std::string panda = (data / "robots" / "franka_panda").string();
  const auto document = json_of(run_command(
      "robot '" + panda + "/franka_panda.urdf' --package 'franka_description=" + panda + "' --json", folder));
  EXPECT_EQ(document["links"].Size(), 11U);
  for (const auto& link : document["links"].GetArray()) {
    EXPECT_GT(link["volume_ratio"].GetDouble(), 1.0);
    EXPECT_GT(link["outermost_corner_inside_m"].GetDouble(), -1e-6);
  }
  EXPECT_EQ(run_command("robot '" + panda + "/franka_panda.urdf'", folder).exit_code, 1);
}

}  // namespace
}  // namespace depthgrid::test
