// Meshes that are broken, or legal but rare: each ends in its corners or in one line that names the file and the value.
#include "depthgrid/robot/mesh_formats.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>

#include "depthgrid/robot/link_capsules.hpp"
#include "depthgrid/robot/mesh.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::robot {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string message_of(const std::string& ending, const std::string& text) {
  const std::string message = test::thrown_message([&] { (void)mesh_corners(text, ending, "m" + ending + ": "); });
  EXPECT_THAT(message, AllOf(HasSubstr("m" + ending + ": "), Not(HasSubstr("\n")))) << text;
  return message;
}

std::string binary_stl(std::uint32_t count, std::size_t bytes) {
  std::string text(84, '\0');
  text.replace(80, 4, reinterpret_cast<const char*>(&count), 4);
  const float corners[] = {0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0};
  for (std::uint32_t i = 0; i < 2; ++i) {
    text.append(reinterpret_cast<const char*>(corners), sizeof(corners)).append(2, '\0');
  }
  text.resize(bytes);
  return text;
}

TEST(MeshFormats, Stl) {
  EXPECT_EQ(mesh_corners(binary_stl(2, 184), ".stl", "").size(), 6U);
  EXPECT_EQ(mesh_corners(binary_stl(2, 185), ".STL", "").size(), 6U);  // exporters add bytes
  EXPECT_THAT(message_of(".stl", binary_stl(2, 183)),
              AllOf(HasSubstr("2 triangles"), HasSubstr("184"), HasSubstr("183")));
  EXPECT_THAT(message_of(".stl", binary_stl(4'000'000'000U, 184)), HasSubstr("4000000000 triangles"));
  EXPECT_THAT(message_of(".stl", binary_stl(0, 84)), HasSubstr("no face"));
  EXPECT_THAT(message_of(".stl", ""), HasSubstr("0 bytes"));
  EXPECT_THAT(message_of(".stl", "nothing that is a mesh"), HasSubstr("no STL"));
  std::string bad = binary_stl(1, 134);
  bad.replace(96, 4, "\xff\xff\xff\x7f");
  EXPECT_THAT(message_of(".stl", bad), HasSubstr("nan"));
  const std::string facet = "facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet ";
  EXPECT_EQ(
      mesh_corners("solid a b c\n" + facet + facet + "endsolid\nsolid d\n" + facet + "endsolid d", ".stl", "").size(),
      9U);
  EXPECT_EQ(mesh_corners("\xEF\xBB\xBFsolid a\r\n" + facet + "endsolid\r\n", ".stl", "").size(),
            mesh_corners("solid a\n" + facet + "endsolid\n", ".stl", "").size());
  for (const std::string& trailing : {std::string(1, '\0'), std::string("\x1a"), std::string("made by hand\n")}) {
    EXPECT_EQ(mesh_corners("solid a\n" + facet + "endsolid a\n" + trailing, ".stl", "").size(), 3U);
  }
  EXPECT_THAT(message_of(".stl", "solid a\n" + facet + "endsolid a\nmore\n" + facet), HasSubstr("'more' stands where"))
      << "nothing of the mesh is passed over";
  EXPECT_THAT(message_of(".stl", "solid\n" + facet), HasSubstr("cut off"));
  EXPECT_THAT(message_of(".stl", "solid\n" + facet.substr(0, 60)), HasSubstr("stl"));
  EXPECT_THAT(message_of(".stl", "solid\nfacet normal 0 0 1 outer loop vertex 0 0 1e999"), HasSubstr("1e999"));
  EXPECT_THAT(message_of(".stl", "solid\nfacet vertex 0 0 0 endfacet endsolid"), HasSubstr("1 vertices"));
  EXPECT_THAT(message_of(".stl", "solid\nfacte"), HasSubstr("facte"));
  EXPECT_THAT(message_of(".stl", "solid\nendsolid\n"), HasSubstr("no face"));
}

TEST(MeshFormats, Obj) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_EQ(mesh_corners(corners + "f 1 2 3", ".obj", "").size(), 3U);
  EXPECT_EQ(mesh_corners("\xEF\xBB\xBF" + corners + "l 1 2\np 1\nf 1/1/1 2// -1\n", ".obj", "").back(),
            Eigen::Vector3d(0, 1, 0));
  EXPECT_THAT(message_of(".obj", corners), HasSubstr("no face"));
  EXPECT_THAT(message_of(".obj", corners + "f 1 2 4"), AllOf(HasSubstr("line 4"), HasSubstr("'4'")));
  EXPECT_THAT(message_of(".obj", corners + "f 1 2 0"), HasSubstr("'0'"));
  EXPECT_THAT(message_of(".obj", corners + "f 1 2 -4"), HasSubstr("'-4'"));
  EXPECT_THAT(message_of(".obj", corners + "f 1 2 x"), HasSubstr("'x'"));
  EXPECT_THAT(message_of(".obj", corners + "f 1 1 1"), HasSubstr("no area"));
  EXPECT_THAT(message_of(".obj", corners + "v 0 0\nf 1 2 3"), AllOf(HasSubstr("line 4"), HasSubstr("''")));
  EXPECT_THAT(message_of(".obj", corners + "v 0 0 nan\nf 1 2 3"), HasSubstr("nan"));
  EXPECT_THAT(message_of(".obj", corners + "v 0 0 1e300\nf 1 2 4"), HasSubstr("1e+300"));
  EXPECT_THAT(message_of(".obj", corners + "surf 0 1 0 1 1 2 3\n"), HasSubstr("free-form"));
}

/// A triangle (0 0 0), (1 0 0), (0 1 0) in `scene`; more of the file by what is replaced in it.
std::string collada(const std::string& scene,
                    const std::string& faces = "<triangles count='1'>@<p>0 1 2</p></triangles>",
                    const std::string& numbers = "0 0 0 1 0 0 0 1 0", const std::string& unit = "1") {
  std::string all = faces;
  const std::string input = "<input semantic='VERTEX' source='#v' offset='0'/>";
  for (std::size_t at = all.find('@'); at != std::string::npos; at = all.find('@')) {
    all.replace(at, 1, input);
  }
  return "<COLLADA><asset><unit meter='" + unit +
         "'/></asset><library_geometries><geometry id='g'><mesh><source id='p'>" + "<float_array id='pa' count='9'>" +
         numbers + "</float_array><technique_common>" +
         "<accessor source='#pa' count='3' stride='3'/></technique_common></source>" +
         "<vertices id='v'><input semantic='POSITION' source='#p'/></vertices>" + all +
         "</mesh></geometry><geometry id='spline'><spline/></geometry></library_geometries>" +
         "<library_visual_scenes><visual_scene id='s'>" + scene +
         "</visual_scene></library_visual_scenes><scene><instance_visual_scene url='#s'/></scene></COLLADA>";
}

const char* const kNode = "<node><instance_geometry url='#g'/></node>";

TEST(MeshFormats, Collada) {
  const auto of = [](const std::string& text) { return mesh_corners(text, ".dae", ""); };
  EXPECT_EQ(of(collada(kNode))[1], Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(of(collada(kNode, "<triangles count='1'>@<p>0 1 2</p></triangles>", "0 0 0 1 0 0 0 1 0", "0.01"))[1],
            Eigen::Vector3d(0.01, 0, 0));
  EXPECT_EQ(of(collada(kNode, "<tristrips count='1'>@<p>0 1 2 0</p></tristrips>")).size(), 6U);
  // no transform is too small to count
  EXPECT_EQ(of(collada("<node><translate>0 0 1e-9</translate><instance_geometry url='#g'/></node>"))[0].z(), 1e-9);
  EXPECT_EQ(of(collada("<node><lookat>a</lookat></node>" + std::string(kNode))).size(), 3U);  // a camera's
  // nothing that is not shown, and no body where there is none
  for (const char* empty : {"", "<node/>", "<node><instance_light url='#l'/><node/></node>"}) {
    EXPECT_THAT(message_of(".dae", collada(empty)), HasSubstr("no mesh")) << empty;
  }
  EXPECT_THAT(message_of(".dae", collada(kNode, "<lines count='1'>@<p>0 1</p></lines>")), HasSubstr("no mesh"));
}

TEST(MeshFormats, ColladaScenesThatAreBroken) {
  const auto with = [](const std::string& inside) {
    return message_of(".dae", collada("<node>" + inside + "</node>"));
  };
  const std::string mesh = "<instance_geometry url='#g'/>";
  EXPECT_THAT(with("<skew>30 1 0 0 0 1 0</skew>" + mesh), HasSubstr("<skew>"));
  EXPECT_THAT(with("<lookat>0 0 1 0 0 0 0 1 0</lookat>" + mesh), HasSubstr("<lookat>"));
  EXPECT_THAT(with("<matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0.1 1</matrix>" + mesh), HasSubstr("0 0 0 1"));
  EXPECT_THAT(with("<matrix>1 0 0</matrix>" + mesh), HasSubstr("16 finite numbers"));
  EXPECT_THAT(with("<translate>0 0 nan</translate>" + mesh), HasSubstr("'nan'"));
  EXPECT_THAT(with("<translate>0 0 0 0</translate>" + mesh), HasSubstr("more than 3"));
  EXPECT_THAT(with("<rotate>0 0 0 30</rotate>" + mesh), HasSubstr("axis"));
  EXPECT_THAT(with("<scale>0 0 0</scale>" + mesh), HasSubstr("no area"));
  EXPECT_THAT(with("<scale>1e300 1 1</scale>" + mesh), HasSubstr("1e+300"));
  EXPECT_THAT(with("<instance_geometry url='#none'/>"), HasSubstr("'#none'"));
  EXPECT_THAT(with("<instance_geometry url='other.dae#g'/>"), HasSubstr("'other.dae#g'"));
  EXPECT_THAT(with("<instance_geometry url='#spline'/>"), AllOf(HasSubstr("'spline'"), HasSubstr("STL or OBJ")));
  EXPECT_THAT(with("<instance_controller url='#c'/>"), HasSubstr("skeleton"));
  EXPECT_THAT(with("<node id='a'><instance_node url='#a'/></node>"), HasSubstr("without end"));
  EXPECT_THAT(with("<instance_node url='#none'/>"), HasSubstr("'#none'"));
  std::string doubled = mesh;
  for (int i = 0; i < 40; ++i) {  // 2^40 instances
    doubled += "<node id='n" + std::to_string(i) + "'><instance_node url='#n" + std::to_string(i + 1) +
               "'/><instance_node url='#n" + std::to_string(i + 1) + "'/></node>";
  }
  EXPECT_THAT(with(doubled + "<node id='n40'/>"), HasSubstr("100000 times"));
}

TEST(MeshFormats, ColladaGeometriesThatAreBroken) {
  const auto faces = [](const std::string& text) { return message_of(".dae", collada(kNode, text)); };
  EXPECT_THAT(faces("<triangles count='1'>@<p>0 1 3</p></triangles>"),
              AllOf(HasSubstr("'g'"), HasSubstr("index is 3")));
  EXPECT_THAT(faces("<triangles count='1'>@<p>0 1 -1</p></triangles>"), HasSubstr("'-1'"));
  EXPECT_THAT(faces("<triangles count='1'>@<p>0 one 2</p></triangles>"), HasSubstr("'one'"));
  EXPECT_THAT(faces("<triangles count='2'>@<p>0 1 2</p></triangles>"), HasSubstr("count='2'"));
  EXPECT_THAT(faces("<triangles count='2'>@</triangles>"), HasSubstr("0 corners"));
  EXPECT_THAT(faces("<triangles><p>0 1 2</p></triangles>"), HasSubstr("no input VERTEX"));
  EXPECT_THAT(faces("<triangles><input semantic='VERTEX' source='#w'/><p>0 1 2</p></triangles>"), HasSubstr("'#w'"));
  EXPECT_THAT(faces("<triangles>@<input semantic='NORMAL' offset='1'/><p>0 1 2</p></triangles>"),
              HasSubstr("multiple"));
  EXPECT_THAT(faces("<polylist>@<vcount>4</vcount><p>0 1 2</p></polylist>"), HasSubstr("asks for more"));
  EXPECT_THAT(faces("<polylist>@<vcount>2</vcount><p>0 1 2</p></polylist>"), HasSubstr("only 2"));
  const auto numbers = [](const std::string& text) {
    return message_of(".dae", collada(kNode, "<triangles>@<p>0 1 2</p></triangles>", text));
  };
  EXPECT_THAT(numbers("0 0 0 1 0 0 0 1"), AllOf(HasSubstr("8 numbers"), HasSubstr("count 9")));
  EXPECT_THAT(numbers("0 0 0 1 0 0 0 1 x"), HasSubstr("'x'"));
  EXPECT_THAT(message_of(".dae", collada(kNode, "<triangles>@<p>0 1 2</p></triangles>", "0 0 0 1 0 0 0 1 0", "0")),
              HasSubstr("unit is '0'"));
  EXPECT_THAT(message_of(".dae", "<COLLADA/>"), HasSubstr("visual scene"));
  EXPECT_THAT(message_of(".dae", "<html/>"), HasSubstr("<html>"));
  EXPECT_THAT(message_of(".dae", "solid"), HasSubstr("XML"));
}

TEST(MeshFormats, OthersSayWhatToDo) {
  for (const char* ending : {".glb", ".gltf", ".ply", ".3ds", ""}) {
    EXPECT_THAT(message_of(ending, "ply\n"),
                AllOf(HasSubstr("'" + std::string(ending) + "'"), HasSubstr("STL or OBJ")));
  }
}

TEST(MeshFormats, FilesThatAreNot) {
  const auto file = std::filesystem::path(::testing::TempDir()) / "depthgrid_pointer.stl";
  std::ofstream(file) << "version https://git-lfs.github.com/spec/v1\noid sha256:0123\nsize 12345\n";
  EXPECT_THAT(test::thrown_message([&] { (void)mesh_points(file); }),
              AllOf(HasSubstr(file.string()), HasSubstr("Git LFS")));
  EXPECT_THAT(test::thrown_message([] { (void)mesh_points("no/such.stl"); }),
              HasSubstr("no/such.stl: there is no such"));
}

// A robot may be described without a file: scales are looked at where they are used.
TEST(MeshFormats, ScalesOfAMesh) {
  const auto file = std::filesystem::path(::testing::TempDir()) / "depthgrid_scaled.stl";
  std::ofstream(file, std::ios::binary) << binary_stl(2, 184);
  const auto capsules = [&file](const Eigen::Vector3d& scale) {
    RobotDescription robot;
    robot.source = "made";
    robot.links.push_back({"a", {{Pose::Identity(), MeshShape{file, scale}}}});
    return link_capsules(RobotModel(robot));
  };
  EXPECT_EQ(capsules({1, 1, 1}).size(), 1U);
  EXPECT_THAT(test::thrown_message([&] {
                (void)capsules({0, 0, 0});
              }),
              AllOf(HasSubstr(file.string()), HasSubstr("0 0 0")));
  EXPECT_THAT(test::thrown_message([&] { (void)capsules({1000, 1000, 1000}); }), HasSubstr("millimetres"));
  EXPECT_THAT(test::thrown_message([&] { (void)capsules({100, 100, 100}); }), HasSubstr("scale='0.001 0.001 0.001'"));
  EXPECT_THAT(test::thrown_message([&] { (void)capsules({1e-6, 1e-6, 1e-6}); }), HasSubstr("scale='1 1 1'"));
  EXPECT_THAT(test::thrown_message([&] { (void)capsules({std::nan(""), 1, 1}); }), HasSubstr("nan"));
}

}  // namespace
}  // namespace depthgrid::robot
