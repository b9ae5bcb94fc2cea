// Random meshes and scenes in every format: the library's corners are those that the test multiplied out itself, and
// the capsules around them, scaled and moved as a URDF says, contain every one.
#include <gtest/gtest.h>

#include <algorithm>

#include "depthgrid/robot/link_capsules.hpp"
#include "depthgrid/robot/mesh.hpp"
#include "depthgrid/robot/urdf.hpp"
#include "robot/collada_twin.hpp"
#include "support/random_run.hpp"

namespace depthgrid::robot {
namespace {

using Eigen::Vector3d;

std::filesystem::path written(const std::string& name, const std::string& text) {
  const auto file = std::filesystem::path(::testing::TempDir()) / ("depthgrid_random_" + name);
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

/// The farthest that a point of `some` is from all of `others`.
double farthest(const std::vector<Vector3d>& some, const std::vector<Vector3d>& others) {
  double most = 0;
  for (const Vector3d& p : some) {
    double least = 1e9;
    for (const Vector3d& q : others) {
      least = std::min(least, (p - q).norm());
    }
    most = std::max(most, least);
  }
  return most;
}

/// Random place and scale in a URDF: the capsule contains each corner, and one of them is on it.
void expect_contained(const std::filesystem::path& file, const std::vector<Vector3d>& corners, Random& random,
                      const std::string& what) {
  const Vector3d scale(random.uniform(0.1, 3), random.uniform(-2, -0.1), random.uniform(0.1, 3));
  const Vector3d rpy = random.in_cube(1.5);
  const Vector3d xyz = random.in_cube(1);
  std::ostringstream text = exact_text();
  text << "<robot name='r'><link name='a'><collision><origin xyz='" << xyz.transpose() << "' rpy='" << rpy.transpose()
       << "'/><geometry><mesh filename='" << file.filename().string() << "' scale='" << scale.transpose()
       << "'/></geometry></collision></link></robot>";
  const RobotModel model(parse_urdf(text.str(), file.parent_path() / "r.urdf"));
  const std::vector<LinkCapsule> capsules = link_capsules(model);
  ASSERT_EQ(capsules.size(), 1U) << what;
  double most_m = -1;
  for (const Vector3d& corner : corners) {
    const Vector3d p = Eigen::Translation3d(xyz) * Eigen::AngleAxisd(rpy.z(), Vector3d::UnitZ()) *
                       Eigen::AngleAxisd(rpy.y(), Vector3d::UnitY()) * Eigen::AngleAxisd(rpy.x(), Vector3d::UnitX()) *
                       Vector3d(scale.cwiseProduct(corner));
    most_m = std::max(most_m, distance_to_axis(capsules[0].capsule, p) - capsules[0].capsule.radius_m);
  }
  EXPECT_LE(most_m, 1e-9) << what;
  EXPECT_GE(most_m, -1e-9) << what;
}

void expect_corners(const std::filesystem::path& file, const std::vector<Vector3d>& corners, double tolerance,
                    const std::string& what) {
  const std::vector<Vector3d> found = mesh_points(file);
  EXPECT_EQ(found.size() % 3, 0U);
  EXPECT_LE(farthest(found, corners), tolerance) << what;
  EXPECT_LE(farthest(corners, found), tolerance) << what;
}

TEST(RandomMeshes, Obj) {
  const test::RandomRun run = test::random_run(200);
  for (std::int64_t i = 0; i < run.count; ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i));
    const RandomSurface surface(random, false);
    const auto file = written("obj.obj", obj_text(surface, random));
    const std::string what = "case " + std::to_string(i) + "; " + run.reproduce();
    expect_corners(file, surface.used(), 0, what);
    if (i % 10 == 0) {
      expect_contained(file, surface.used(), random, what);
    }
  }
}

TEST(RandomMeshes, Stl) {
  const test::RandomRun run = test::random_run(200);
  for (std::int64_t i = 0; i < run.count; ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i));
    const std::string what = "case " + std::to_string(i) + "; " + run.reproduce();
    const RandomSurface surface(random, true);
    expect_corners(written("ascii.STL", ascii_stl_text(surface, random)), surface.used(), 0, what);
    const auto file = written("binary.stl", binary_stl_text(surface, random));
    expect_corners(file, surface.used(), 1e-7, what);
    if (i % 10 == 0) {
      expect_contained(file, plain_read(file), random, what);
    }
  }
}

TEST(RandomMeshes, ColladaScenes) {
  const test::RandomRun run = test::random_run(300);
  for (std::int64_t i = 0; i < run.count; ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i));
    const std::string what = "case " + std::to_string(i) + "; " + run.reproduce();
    const RandomScene scene(random);
    const auto file = written("scene.dae", scene.text);
    double size = 1;
    for (const Vector3d& corner : scene.corners) {
      size = std::max(size, corner.norm());
    }
    expect_corners(file, scene.corners, 1e-12 * size, what);
    if (i % 10 == 0) {
      expect_contained(file, scene.corners, random, what);
    }
    if (HasFailure()) {
      FAIL() << scene.text;
    }
  }
}

TEST(RandomMeshes, RobotsOfTheDataFolder) {
  DEPTHGRID_REQUIRE_ROBOT_DATA();
  int count = 0;
  for (const auto& item : std::filesystem::recursive_directory_iterator(robot_data())) {
    if (const auto ending = item.path().extension(); ending == ".stl" || ending == ".obj") {
      EXPECT_EQ(mesh_points(item.path()), plain_read(item.path())) << item.path();
      ++count;
    }
  }
  EXPECT_GE(count, 20);
}

}  // namespace
}  // namespace depthgrid::robot
