// URDF files: what is read, and that every fault ends in one line that names the file and what is wrong.
#include "depthgrid/robot/urdf.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "depthgrid/robot/kuka_lwr4.hpp"
#include "robot/robot_support.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::robot {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const char* const kLinks = R"(<link name="a"/><link name="b"/><link name="c"/>)";

std::string joint(const std::string& name, const std::string& parent, const std::string& child,
                  const std::string& more = "", const std::string& type = "revolute",
                  const std::string& limit = R"(<limit lower="-1" upper="2" velocity="3" effort="4"/>)") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent + "'/><child link='" + child + "'/>" +
         limit + more + "</joint>";
}

std::string message_of(const std::string& inside) {
  std::string text = "<robot name='r'>";
  text += inside + "</robot>";
  const std::string message =
      test::thrown_message([&] { const RobotModel unused(parse_urdf(text, "folder/arm.urdf")); });
  EXPECT_THAT(message, HasSubstr("folder/arm.urdf: "));
  EXPECT_THAT(message, Not(HasSubstr("\n")));
  return message;
}

TEST(Urdf, ReadsATreeAndItsShapes) {
  const std::string text =
      std::string("<robot name='r'><link name='a'><visual><geometry><sphere radius='9'/></geometry>") +
      "</visual><collision><origin xyz='1 2 3'/><geometry><box size='4 5 6'/></geometry></collision>" +
      "</link><link name='b'><visual><geometry><sphere radius='0.5'/></geometry></visual></link>" + "<link name='c'/>" +
      joint("j1", "a", "b") + joint("j0", "b", "c", "<axis xyz='0 0 2'/>", "prismatic") + "</robot>";
  const RobotModel model(parse_urdf(text, "arm.urdf"));
  EXPECT_EQ(model.name(), "r");
  ASSERT_EQ(model.links().size(), 3U);
  EXPECT_EQ(model.links()[2].name, "c");
  ASSERT_EQ(model.joints().size(), 2U);
  EXPECT_EQ(model.joints()[0].name, "j1");
  EXPECT_EQ(model.joints()[1].type, JointType::prismatic);
  EXPECT_EQ(model.joints()[0].lower, -1);
  EXPECT_EQ(model.joints()[0].upper, 2);
  EXPECT_EQ(model.joints()[0].max_speed, 3);
  ASSERT_EQ(model.links()[0].shapes.size(), 1U);  // collision shapes only, where there are any
  EXPECT_EQ(std::get<BoxShape>(model.links()[0].shapes[0].shape).size_m, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(model.links()[0].shapes[0].T_link_shape.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(std::get<SphereShape>(model.links()[1].shapes[0].shape).radius_m, 0.5);
}

TEST(Urdf, FilesThatAreNone) {
  EXPECT_THAT(test::thrown_message([] { (void)load_urdf("no/such.urdf"); }),
              HasSubstr("no/such.urdf: there is no such file"));
  EXPECT_THAT(test::thrown_message([] { (void)load_urdf("."); }), HasSubstr("no such file"));
  for (const char* text :
       {"", "not XML at all", "<html></html>", "<robot name='r'><link", "<robot/>", "<robot name='r'/>"}) {
    EXPECT_THAT(test::thrown_message([&] { const RobotModel unused(parse_urdf(text, "x.urdf")); }),
                HasSubstr("x.urdf: "))
        << text;
  }
}

TEST(Urdf, Trees) {
  EXPECT_THAT(message_of(kLinks + joint("j", "a", "nowhere") + joint("k", "a", "c")), HasSubstr("nowhere"));
  EXPECT_THAT(message_of(kLinks + joint("j", "nowhere", "b") + joint("k", "a", "c")), HasSubstr("nowhere"));
  EXPECT_THAT(message_of(kLinks + joint("j", "a", "b")), AllOf(HasSubstr("[a]"), HasSubstr("[c]")));
  message_of(kLinks + joint("j", "a", "b") + joint("k", "b", "c") + joint("l", "c", "a"));
  EXPECT_THAT(message_of(kLinks + joint("j", "b", "c") + joint("k", "c", "b")), HasSubstr("loop"));
  EXPECT_THAT(message_of(kLinks + joint("j", "a", "b") + joint("k", "a", "c") + joint("l", "b", "c")),
              AllOf(HasSubstr("'c'"), HasSubstr("two joints")));
  EXPECT_THAT(message_of(kLinks + joint("j", "a", "a") + joint("k", "b", "c")), HasSubstr("loop"));
  EXPECT_THAT(message_of("<link name='a'/><link name='a'/>"), HasSubstr("'a'"));
}

TEST(Urdf, Joints) {
  const std::string rest = joint("k", "a", "c");
  const auto with = [&](const std::string& more, const std::string& type = "revolute",
                        const std::string& limit = "<limit lower='-1' upper='2' velocity='3' effort='4'/>") {
    return message_of(kLinks + joint("j", "a", "b", more, type, limit) + rest);
  };
  EXPECT_THAT(with("", "wobbly"), HasSubstr("wobbly"));
  EXPECT_THAT(with("", "floating"), AllOf(HasSubstr("'j'"), HasSubstr("floating")));
  EXPECT_THAT(with("", "planar"), AllOf(HasSubstr("'j'"), HasSubstr("planar")));
  EXPECT_THAT(with("<axis xyz='0 0 0'/>"), AllOf(HasSubstr("'j'"), HasSubstr("axis")));
  EXPECT_THAT(with("<axis xyz='0 nan 0'/>"), HasSubstr("nan"));
  EXPECT_THAT(with("<axis xyz='0 1'/>"), HasSubstr("j"));
  EXPECT_THAT(with("<origin xyz='0 0 nan'/>"), HasSubstr("nan"));
  EXPECT_THAT(with("<origin xyz='0 0 1e999'/>"), HasSubstr("1e999"));
  EXPECT_THAT(with("", "revolute", ""), HasSubstr("j"));
  EXPECT_THAT(with("", "revolute", "<limit lower='nan' upper='2' velocity='3' effort='4'/>"), HasSubstr("nan"));
  EXPECT_THAT(with("", "revolute", "<limit lower='3' upper='2' velocity='3' effort='4'/>"),
              AllOf(HasSubstr("'j'"), HasSubstr("3 and 2")));
  EXPECT_THAT(with("", "revolute", "<limit lower='1' upper='2' velocity='0' effort='4'/>"),
              AllOf(HasSubstr("'j'"), HasSubstr("speed")));
  EXPECT_THAT(with("<mimic joint='missing'/>"), AllOf(HasSubstr("'j'"), HasSubstr("'missing'")));
  EXPECT_THAT(with("<mimic joint='j'/>"), HasSubstr("'j'"));
}

TEST(Urdf, Shapes) {
  const auto with = [](const std::string& geometry) {
    return message_of("<link name='a'><collision><geometry>" + geometry + "</geometry></collision></link>");
  };
  EXPECT_THAT(with("<sphere radius='-1'/>"), AllOf(HasSubstr("'a'"), HasSubstr("-1")));
  EXPECT_THAT(with("<sphere radius='nan'/>"), HasSubstr("nan"));
  EXPECT_THAT(with("<sphere/>"), HasSubstr("radius"));
  EXPECT_THAT(with("<blob/>"), HasSubstr("blob"));
  EXPECT_THAT(with("<cylinder radius='1' length='0'/>"), AllOf(HasSubstr("'a'"), HasSubstr("length")));
  EXPECT_THAT(with("<box size='1 1 -2'/>"), AllOf(HasSubstr("'a'"), HasSubstr("-2")));
  EXPECT_THAT(with("<mesh filename='missing.stl'/>"), AllOf(HasSubstr("'a'"), HasSubstr("folder/missing.stl")));
  EXPECT_THAT(with("<mesh filename='package://nobody/a.stl'/>"), AllOf(HasSubstr("'a'"), HasSubstr("'nobody'")));
  EXPECT_THAT(with("<mesh filename='package://nobody'/>"), HasSubstr("package://NAME/FILE"));
}

TEST(Urdf, PackagesAreFolders) {
  const std::filesystem::path root = std::filesystem::path(::testing::TempDir()) / "depthgrid_urdf";
  std::filesystem::create_directories(root / "pack" / "urdf");
  std::ofstream(root / "pack" / "m.stl") << "solid";
  const std::string text =
      "<robot name='r'><link name='a'><collision><geometry><mesh filename='package://pack/m.stl' scale='1 2 3'/>"
      "</geometry></collision></link></robot>";
  const auto mesh_of = [](const RobotDescription& robot) {
    return std::get<MeshShape>(robot.links[0].shapes[0].shape);
  };
  const MeshShape around = mesh_of(parse_urdf(text, root / "pack" / "urdf" / "r.urdf"));
  EXPECT_EQ(around.file, root / "pack" / "m.stl");
  EXPECT_EQ(around.scale, Eigen::Vector3d(1, 2, 3));
  UrdfOptions options;
  options.packages["pack"] = root / "pack";
  EXPECT_EQ(mesh_of(parse_urdf(text, "elsewhere.urdf", options)).file, root / "pack" / "m.stl");
}

TEST(Urdf, PrintsNothing) {
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  message_of(kLinks + joint("j", "a", "nowhere"));
  EXPECT_EQ(::testing::internal::GetCapturedStderr() + ::testing::internal::GetCapturedStdout(), "");
}

TEST(Urdf, ArmsOfTheDataFolder) {
  DEPTHGRID_REQUIRE_ROBOT_DATA();
  const RobotModel lwr(load_urdf(robot_data() / "kuka_lwr/lwr_simplified.urdf"));
  EXPECT_EQ(lwr.joints().size(), 7U);
  UrdfOptions options;
  options.packages["franka_description"] = robot_data() / "franka_panda";
  const RobotModel panda(load_urdf(robot_data() / "franka_panda/franka_panda.urdf", options));
  ASSERT_EQ(panda.joints().size(), 8U);  // the second finger mimics the first
  EXPECT_EQ(panda.joints()[0].name, "panda_joint1");
  EXPECT_EQ(panda.joints()[7].type, JointType::prismatic);
  EXPECT_DOUBLE_EQ(panda.joints()[3].upper, -0.0698);
  EXPECT_THAT(test::thrown_message([&] { (void)panda.link_index("panda_link9"); }), HasSubstr("'panda_link9'"));
}

}  // namespace
}  // namespace depthgrid::robot
