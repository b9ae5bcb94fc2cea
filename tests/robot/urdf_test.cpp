// URDF files: what is read, and that every fault ends in one line that names the file and what is wrong.
#include "depthgrid/robot/urdf.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>
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
  EXPECT_THAT(test::thrown_message([] { (void)load_urdf("/dev/zero"); }), HasSubstr("no such file"));
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
  EXPECT_THAT(message_of(kLinks + joint("j", "a", "b")),
              AllOf(HasSubstr("'a'"), HasSubstr("'c'"), HasSubstr("one root")));
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
  EXPECT_THAT(with("", "revolute", "<limit lower='1' upper='2' velocity='-1' effort='4'/>"),
              AllOf(HasSubstr("'j'"), HasSubstr("speed")));
  EXPECT_THAT(with("<mimic joint='missing'/>"), AllOf(HasSubstr("'j'"), HasSubstr("'missing'")));
  EXPECT_THAT(with("<mimic joint='j'/>"), AllOf(HasSubstr("'j'"), HasSubstr("circle")));
  EXPECT_THAT(with("<mimic joint='k' multiplier='1e308'/><mimic joint='k'/>"), HasSubstr("more than one <mimic>"));
  EXPECT_THAT(with("<origin xyz='0 0 1e308'/>"), AllOf(HasSubstr("'j'"), HasSubstr("30 m")));
  EXPECT_THAT(with("<origin xyz='0 0 333'/>"), AllOf(HasSubstr("333 m"), HasSubstr("did you mean 0.333?")));
  EXPECT_THAT(with("<origin rpy='0 0 90'/>"), AllOf(HasSubstr("in degrees?"), HasSubstr("1.570796327)?")));
  EXPECT_THAT(with("", "revolute", "<limit lower='-170' upper='170' velocity='3' effort='4'/>"),
              AllOf(HasSubstr("limit lower is -170 rad"), HasSubstr("did you mean -2.96")));
  EXPECT_THAT(with("", "prismatic", "<limit lower='0' upper='850' velocity='3' effort='4'/>"),
              AllOf(HasSubstr("limit upper is 850 m"), HasSubstr("did you mean 0.85?")));
  EXPECT_THAT(with("<origin rpy='0 1e300 0'/>"), AllOf(HasSubstr("1e+300"), HasSubstr("radians")));
  EXPECT_THAT(with("<origin rpy='0 0 0' quat_xyzw='0 0 0 1'/>"), HasSubstr("must have one"));
  EXPECT_THAT(with("<origin quat_xyzw='0 0 0 2'/>"), AllOf(HasSubstr("0 0 0 2"), HasSubstr("length 1")));
  EXPECT_THAT(with("<Origin xyz='0 0 1'/>"), AllOf(HasSubstr("'j'"), HasSubstr("'Origin'"), HasSubstr("'origin'")));
  EXPECT_THAT(with("<limits lower='0'/>"), HasSubstr("'limit'"));
  EXPECT_THAT(with("<origin xyz='${x} 0 0'/>"), HasSubstr("xacro"));
}

// A file of SolidWorks states effort and velocity as 0.
TEST(Urdf, ASpeedOfZeroIsNotStated) {
  for (const char* limit :
       {"<limit lower='0' upper='1.7' effort='0' velocity='0'/>", "<limit lower='0' upper='1.7'/>"}) {
    const RobotModel model(parse_urdf(std::string("<robot name='r'><link name='a'/><link name='b'/>") +
                                          joint("j", "a", "b", "", "revolute", limit) + "</robot>",
                                      "arm.urdf"));
    EXPECT_EQ(model.joints()[0].max_speed, std::numeric_limits<double>::infinity());
    EXPECT_EQ(model.joints()[0].upper, 1.7);
  }
}

TEST(Urdf, AMimicOfAMimicFollowsTheLastOfThem) {
  const std::string links = "<robot name='r'><link name='a'/><link name='b'/><link name='c'/><link name='d'/>";
  const RobotModel model(
      parse_urdf(links + joint("l", "c", "d", "<axis xyz='0 0 1'/><mimic joint='k' multiplier='3' offset='0.25'/>") +
                     joint("k", "b", "c", "<axis xyz='0 0 1'/><mimic joint='j' multiplier='2' offset='0.5'/>") +
                     joint("j", "a", "b", "<axis xyz='0 0 1'/>") + "</robot>",
                 "arm.urdf"));
  ASSERT_EQ(model.joints().size(), 1U);
  const LinkJoint& last = model.joint_of_link(model.link_index("d"));
  EXPECT_EQ(last.multiplier, 6);
  EXPECT_EQ(last.offset, 3 * 0.5 + 0.25);
  constexpr double kPosition = 0.1;  // of j; k stands at 0.7 and l at 2.35, all about one axis
  const Pose pose = link_poses(model, {kPosition}).back();
  EXPECT_LT((pose.linear() - Eigen::AngleAxisd(0.1 + 0.7 + 2.35, Eigen::Vector3d::UnitZ()).toRotationMatrix()).norm(),
            1e-12);
  EXPECT_THAT(
      message_of(kLinks + joint("j", "a", "b", "<mimic joint='k'/>") + joint("k", "b", "c", "<mimic joint='j'/>")),
      AllOf(HasSubstr("'j'"), HasSubstr("circle")));
}

TEST(Urdf, AFloatingRobotHangsOnTWorldBase) {
  const std::string base = "<link name='base'><collision><geometry><box size='1 1 1'/></geometry></collision></link>";
  for (const char* type : {"floating", "planar"}) {
    const RobotModel one(parse_urdf(
        "<robot name='r'><link name='world'/>" + base + joint("f", "world", "base", "", type, "") + "</robot>",
        "arm.urdf"));
    ASSERT_EQ(one.links().size(), 1U);
    EXPECT_EQ(one.links()[0].name, "base");
    const RobotModel three(parse_urdf("<robot name='r'><link name='world'/><link name='odom'/><link name='tip'/>" +
                                          base + joint("h", "base", "tip") + joint("f", "odom", "base", "", type, "") +
                                          joint("g", "world", "odom", "", "fixed", "") + "</robot>",
                                      "arm.urdf"));
    ASSERT_EQ(three.links().size(), 2U);
    EXPECT_EQ(three.links()[0].name, "base");
    EXPECT_EQ(three.joints()[0].name, "h");
  }
  // something else hangs on the root, or it has a shape: then the child's place is not the base's
  EXPECT_THAT(message_of(base + "<link name='tip'/>" + joint("f", "base", "tip", "", "floating", "")),
              AllOf(HasSubstr("'f'"), HasSubstr("floating")));
  EXPECT_THAT(message_of(kLinks + joint("f", "a", "b", "", "floating", "") + joint("g", "b", "c", "", "floating", "") +
                         joint("h", "c", "a", "", "fixed", "")),
              HasSubstr("floating"));
}

TEST(Urdf, OriginsByQuaternion) {
  const std::string links = "<robot name='r' version='1.1'><link name='a'/><link name='b'/><link name='c'/>";
  const RobotModel model(
      parse_urdf(links + joint("j", "a", "b", "<origin xyz='1 2 3' quat_xyzw='0.5 -0.5 0.5 0.5'/>", "fixed", "") +
                     joint("k", "a", "c", "<origin xyz='1 2 3'/>", "fixed", "") + "</robot>",
                 "arm.urdf"));
  const std::vector<Pose> poses = link_poses(model, {});
  const Eigen::Quaterniond expected(0.5, 0.5, -0.5, 0.5);
  EXPECT_LT((poses[1].linear() - expected.toRotationMatrix()).norm(), 1e-12);
  EXPECT_EQ(poses[1].translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(poses[2].linear(), Eigen::Matrix3d::Identity());
}

// What distances do not need may be wrong: none of it is looked at.
TEST(Urdf, InertiaMaterialsAndDampingDoNotMatter) {
  const std::string text =
      "<?xml version='1.0'?><!-- made by hand --><robot name='r' xmlns:xacro='x'><material name='white'/>"
      "<material name='white'><color rgba='1 1'/></material>"
      "<link name='a'><inertial><mass value='-1'/><inertia ixx='none'/></inertial><inertial/>"
      "<visual><geometry><mesh filename='package://nobody/a.glb'/></geometry><material/></visual>"
      "<collision><geometry><sphere radius='1'/></geometry></collision></link><link name='b'/>" +
      joint("j", "a", "b",
            "<dynamics damping='x' friction='-1'/><safety_controller k_velocity='?'/><calibration rising='no'/>") +
      "<transmission/><gazebo reference='a'><mu1>0.2</mu1></gazebo><property name='M_PI' value='3'/></robot>";
  EXPECT_EQ(parse_urdf(text, "arm.urdf").links[0].shapes.size(), 1U);
}

TEST(Urdf, LimitsOfSize) {
  std::string nested;
  for (int i = 0; i < 200'000; ++i) {
    nested += "<a>";
  }
  EXPECT_THAT(message_of(nested), HasSubstr("XML"));
  for (int i = 0; i < 200'000; ++i) {
    nested += "</a>";
  }
  EXPECT_THAT(message_of(nested), HasSubstr("nested more than"));
  std::string chain = "<link name='l0'/>";
  for (int i = 1; i < 60'000; ++i) {
    const std::string name = "l" + std::to_string(i);
    chain += "<link name='" + name + "'/>" + joint("j" + name, "l" + std::to_string(i - 1), name, "", "fixed", "");
  }
  RobotDescription robot;  // of no file
  for (int i = 0; i < 60'000; ++i) {
    robot.links.push_back({std::to_string(i), {}});
    if (i > 0) {
      JointDescription fixed;
      fixed.name = fixed.child_link = std::to_string(i);
      fixed.parent_link = std::to_string(i - 1);
      robot.joints.push_back(fixed);
    }
  }
  EXPECT_EQ(RobotModel(robot).links().back().name, "59999");
  EXPECT_THAT(message_of(chain), HasSubstr("more than 10000 elements"));
  EXPECT_THAT(message_of(std::string(40'000'000, ' ')), HasSubstr("bytes"));
}

TEST(Urdf, NothingIsDroppedForASpelling) {
  EXPECT_THAT(message_of("<link name='a'/><Link name='b'/>"), AllOf(HasSubstr("'Link'"), HasSubstr("'link'")));
  EXPECT_THAT(message_of("<link name='a'/><joints/>"), HasSubstr("'joint'"));
  EXPECT_THAT(message_of("<link name='a'><colision/></link>"), AllOf(HasSubstr("'a'"), HasSubstr("'collision'")));
  EXPECT_THAT(message_of("<link name='a'/><xacro:include filename='b'/>"), HasSubstr("xacro FILE"));
  EXPECT_THAT(message_of("<link name='a&#10;b'/>"), HasSubstr("control character"));
  EXPECT_THAT(message_of("<link name='a&#x9b;2Jb'/>"), HasSubstr("'a\\xc2\\x9b2Jb' has a control character"));
  EXPECT_THAT(message_of("<link name='a\xff'/>"),
              HasSubstr("'a\\xff' has a control character in its name, or a byte that is no UTF-8"));
  EXPECT_THAT(test::thrown_message([] { (void)parse_urdf("<sdf/>", "x.urdf"); }), HasSubstr("<sdf>"));
  EXPECT_THAT(test::thrown_message([] { (void)parse_urdf("<robot><link name='a'/></robot><robot/>", "x.urdf"); }),
              HasSubstr("second"));
  EXPECT_THAT(test::thrown_message([] { (void)parse_urdf("<robot version='2.0'/>", "x.urdf"); }), HasSubstr("'2.0'"));
  EXPECT_EQ(parse_urdf("\xEF\xBB\xBF<robot name='r'>\r\n<link name='a'/>\r\n</robot>", "x.urdf").links.size(), 1U);
}

TEST(Urdf, Shapes) {
  const auto with = [](const std::string& geometry) {
    return message_of("<link name='a'><collision><geometry>" + geometry + "</geometry></collision></link>");
  };
  EXPECT_THAT(with("<sphere radius='-1'/>"), AllOf(HasSubstr("'a'"), HasSubstr("-1")));
  EXPECT_THAT(with("<sphere radius='nan'/>"), HasSubstr("nan"));
  EXPECT_THAT(with("<sphere/>"), HasSubstr("radius"));
  EXPECT_THAT(with("<blob/>"), HasSubstr("blob"));
  EXPECT_THAT(with("<cylinder radius='1' length='-1'/>"),
              AllOf(HasSubstr("'a'"), HasSubstr("length"), HasSubstr("-1")));
  EXPECT_THAT(with("<capsule radius='1'/>"), AllOf(HasSubstr("length"), HasSubstr("not stated")));
  EXPECT_THAT(with("<sphere radius='1e308'/>"), HasSubstr("5 m"));
  EXPECT_THAT(with("<sphere radius='60'/>"),
              AllOf(HasSubstr("radius of a sphere is 60 m"), HasSubstr("did you mean 0.06?")));
  EXPECT_THAT(with("<box size='100 200 300'/>"), HasSubstr("did you mean 0.3?"));
  EXPECT_THAT(with("<sphere radius='1'/><box size='1 1 1'/>"), AllOf(HasSubstr("<sphere>"), HasSubstr("<box>")));
  EXPECT_THAT(with("</geometry><geometry>"), HasSubstr("more than one <geometry>"));
  EXPECT_THAT(with("<!-- none -->"), HasSubstr("no shape"));
  EXPECT_THAT(with("<mesh filename='a.stl' scale='1 0 1'/>"), AllOf(HasSubstr("'a.stl'"), HasSubstr("1 0 1")));
  EXPECT_THAT(with("<mesh filename='a.stl' scale='1 2'/>"), HasSubstr("'1 2'"));
  EXPECT_THAT(with("<box size='1 1 -2'/>"), AllOf(HasSubstr("'a'"), HasSubstr("-2")));
  EXPECT_THAT(with("<mesh filename='missing.stl'/>"), AllOf(HasSubstr("'a'"), HasSubstr("folder/missing.stl")));
  EXPECT_THAT(with("<mesh filename='package://nobody/a.stl'/>"), AllOf(HasSubstr("'a'"), HasSubstr("'nobody'")));
  EXPECT_THAT(with("<mesh filename='package://nobody'/>"), HasSubstr("package://NAME/FILE"));
}

// A box of size 0 0 0 is a point, as the maker's files of a known robot have it; a plate and a wire are not.
TEST(Urdf, ShapesThatAreAPointAreLeftOut) {
  const auto shapes = [](const std::string& collision) {
    const std::string text =
        "<robot name='r'><link name='a'><visual><geometry><sphere radius='3'/></geometry></visual>" + collision +
        "</link></robot>";
    return parse_urdf(text, "arm.urdf").links[0].shapes;
  };
  const auto collision = [](const std::string& shape) {
    return "<collision><geometry>" + shape + "</geometry></collision>";
  };
  for (const char* point : {"<box size='0 0 0'/>", "<sphere radius='0'/>", "<cylinder radius='0' length='0'/>"}) {
    const auto visual = shapes(collision(point));
    ASSERT_EQ(visual.size(), 1U);  // the link is still seen
    EXPECT_EQ(std::get<SphereShape>(visual[0].shape).radius_m, 3);
    EXPECT_EQ(shapes(collision(point) + collision("<box size='1 1 1'/>")).size(), 1U);
  }
  for (const char* thin : {"<box size='0 0.1 0'/>", "<box size='1 2 0'/>", "<cylinder radius='1' length='0'/>"}) {
    EXPECT_EQ(std::get_if<SphereShape>(&shapes(collision(thin))[0].shape), nullptr) << thin;
  }
}

TEST(Urdf, Capsules) {
  const RobotDescription robot = parse_urdf(
      "<robot name='r'><link name='a'><collision><origin xyz='1 0 0'/><geometry><capsule radius='0.05' length='0.3'/>"
      "</geometry></collision></link></robot>",
      "arm.urdf");
  EXPECT_EQ(std::get<CapsuleShape>(robot.links[0].shapes[0].shape).length_m, 0.3);
}

/// A folder of the test's own, new every time.
std::filesystem::path new_folder(const std::string& name) {
  const std::filesystem::path root = std::filesystem::path(::testing::TempDir()) / name;
  std::filesystem::remove_all(root);
  std::filesystem::create_directories(root);
  return root;
}

std::filesystem::path mesh_file(const std::string& name, const std::filesystem::path& urdf,
                                const UrdfOptions& options = {}) {
  const RobotDescription robot = parse_urdf("<robot name='r'><link name='a'><collision><geometry><mesh filename='" +
                                                name + "'/></geometry></collision></link></robot>",
                                            urdf, options);
  return std::get<MeshShape>(robot.links[0].shapes[0].shape).file;
}

TEST(Urdf, NamesOfMeshes) {
  const std::filesystem::path root = new_folder("depthgrid_urdf_names");
  std::filesystem::create_directories(root / "my meshes");
  const std::filesystem::path mesh = root / "my meshes" / "m.stl";
  const std::filesystem::path urdf = root / "r.urdf";
  std::ofstream(mesh) << "solid";
  std::ofstream(root / "100%25.stl") << "solid";
  EXPECT_EQ(mesh_file("my meshes/m.stl", urdf), mesh);
  EXPECT_EQ(mesh_file("my%20meshes/m.stl", urdf), mesh);
  EXPECT_EQ(mesh_file("100%25.stl", urdf), root / "100%25.stl");  // as it is written, where there is such a file
  EXPECT_EQ(mesh_file("file://" + root.string() + "/my%20meshes/m.stl", urdf), mesh);
  EXPECT_EQ(mesh_file("file://localhost" + root.string() + "/my%20meshes/m.stl", urdf), mesh);
  EXPECT_EQ(mesh_file("package://depthgrid_urdf_names/my%20meshes/m.stl", urdf), mesh);
  EXPECT_THAT(test::thrown_message([&] { mesh_file("file://elsewhere/m.stl", urdf); }),
              HasSubstr("file:///FOLDER/FILE"));
  EXPECT_THAT(test::thrown_message([&] { mesh_file("http://somewhere/m.stl", urdf); }), HasSubstr("package://"));
  EXPECT_THAT(test::thrown_message([&] { mesh_file("package://nobody/m.stl", urdf); }),
              AllOf(HasSubstr("--package nobody=FOLDER"), HasSubstr("UrdfOptions::packages")));
}

TEST(Urdf, MeshesLieInTheRobotsFolderOrInOneThatIsStated) {
  const std::filesystem::path root = new_folder("depthgrid_urdf_outside");
  std::filesystem::create_directories(root / "robot" / "urdf");
  std::filesystem::create_directories(root / "robot_more");
  const std::filesystem::path urdf = root / "robot" / "urdf" / "r.urdf";
  std::ofstream(root / "robot" / "m.stl") << "solid";
  std::ofstream(root / "robot_more" / "m.stl") << "solid";
  const std::string above = "../m.stl";
  const std::string beside = "../../robot_more/m.stl";
  for (const std::string& name : {above, beside, "file://" + (root / "robot" / "m.stl").string(),
                                  std::string("package://robot/../robot_more/m.stl")}) {
    EXPECT_THAT(test::thrown_message([&] { mesh_file(name, urdf); }),
                AllOf(HasSubstr("outside"), HasSubstr("--package NAME=FOLDER"), HasSubstr("UrdfOptions::packages"),
                      HasSubstr(name)));
  }
  UrdfOptions options;
  options.packages["any"] = root / "robot";
  EXPECT_NO_THROW(mesh_file(above, urdf, options));
  EXPECT_NO_THROW(mesh_file("file://" + (root / "robot" / "m.stl").string(), urdf, options));
  EXPECT_THAT(test::thrown_message([&] { mesh_file(beside, urdf, options); }), HasSubstr("outside"));
  std::ofstream(root / "robot" / "package.xml") << "<package/>";  // now the robot's folder is the package
  EXPECT_NO_THROW(mesh_file(above, urdf));
  EXPECT_THAT(test::thrown_message([&] { mesh_file(beside, urdf); }), HasSubstr("outside"));
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

// A folder that merely has the name, up to the root of the disk, would open all of it to the file.
TEST(Urdf, AFolderOfThePackagesNameMustBeAPackage) {
  const std::filesystem::path root = new_folder("depthgrid_urdf_found");
  const std::filesystem::path urdf = root / "ws" / "arm" / "urdf" / "r.urdf";
  std::filesystem::create_directories(urdf.parent_path());
  std::filesystem::create_directories(root / "ws" / "hand");
  for (const char* file : {"ws/m.stl", "ws/arm/m.stl", "ws/arm/urdf/m.stl", "ws/hand/m.stl"}) {
    std::ofstream(root / file) << "solid";
  }
  EXPECT_EQ(mesh_file("package://urdf/m.stl", urdf), root / "ws/arm/urdf/m.stl");
  EXPECT_EQ(mesh_file("package://arm/m.stl", urdf), root / "ws/arm/m.stl");
  const auto refused = [](const std::filesystem::path& folder, const std::string& name) {
    return AllOf(HasSubstr("no folder is stated for package '" + name + "', and " + folder.string() +
                           " holds no package.xml: state its folder with --package " + name + "=FOLDER"),
                 Not(HasSubstr("\n")));
  };
  EXPECT_THAT(test::thrown_message([&] { mesh_file("package://ws/m.stl", urdf); }), refused(root / "ws", "ws"));
  EXPECT_THAT(test::thrown_message([&] { mesh_file("package://hand/m.stl", urdf); }),
              refused(root / "ws/hand", "hand"));
  EXPECT_THAT(test::thrown_message([&] { mesh_file("package://etc/passwd", urdf); }), refused("/etc", "etc"));
  EXPECT_THAT(test::thrown_message([&] { mesh_file("package://../m.stl", urdf); }), HasSubstr("'..' is no name"));
  std::ofstream(root / "ws/hand/package.xml") << "<package/>";
  EXPECT_EQ(mesh_file("package://hand/m.stl", urdf), root / "ws/hand/m.stl");
  UrdfOptions options;
  options.packages["ws"] = root / "ws";
  EXPECT_EQ(mesh_file("package://ws/m.stl", urdf, options), root / "ws/m.stl");
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
