// Capsules contain what they stand for and are not much larger.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iostream>
#include <sstream>

#include "depthgrid/robot/capsule_fit.hpp"
#include "depthgrid/robot/control_points.hpp"
#include "depthgrid/robot/kuka_lwr4.hpp"
#include "depthgrid/robot/link_capsules.hpp"
#include "depthgrid/robot/mesh.hpp"
#include "depthgrid/robot/urdf.hpp"
#include "robot/robot_support.hpp"
#include "support/random_run.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::robot {
namespace {

using Eigen::Vector3d;

double volume(const Capsule& c) {
  return std::numbers::pi * c.radius_m * c.radius_m * ((c.b - c.a).norm() + 4.0 / 3.0 * c.radius_m);
}

/// How far p lies outside all of the capsules; negative inside.
double outside_m(const std::vector<Capsule>& capsules, const Vector3d& p) {
  double least = 1e9;
  for (const Capsule& capsule : capsules) {
    least = std::min(least, distance_to_axis(capsule, p) - capsule.radius_m);
  }
  return least;
}

TEST(CapsuleFit, FindsACapsuleFromPointsOnIt) {
  const test::RandomRun run = test::random_run(30);
  for (std::int64_t i = 0; i < run.count; ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i));
    const Capsule hidden{random.in_cube(0.3), random.in_cube(0.3), random.uniform(0.03, 0.15)};
    std::vector<Vector3d> points;
    for (int k = 0; k < 800; ++k) {
      points.push_back(hidden.a + random.uniform(0, 1) * (hidden.b - hidden.a) + hidden.radius_m * random.unit());
    }
    const Capsule found = fit_capsule(points);
    for (const Vector3d& point : points) {
      ASSERT_LE(outside_m({found}, point), 0.0) << "case " << i << "; " << run.reproduce();
    }
    EXPECT_LT(volume(found), 1.12 * volume(hidden)) << "case " << i << "; " << run.reproduce();
  }
}

TEST(CapsuleFit, FewPoints) {
  const std::vector<Vector3d> one{{1, 2, 3}};
  EXPECT_LT((fit_capsule(one).a - one[0]).norm() + fit_capsule(one).radius_m, 1e-9);
  const std::vector<Vector3d> flat{{0, 0, 0}, {0.2, 0, 0}, {0, 0.1, 0}, {0.2, 0.1, 0}};
  for (const Vector3d& point : flat) {
    EXPECT_LE(outside_m({fit_capsule(flat)}, point), 0.0);
  }
  EXPECT_LT(fit_capsule(flat).radius_m, 0.052);
  EXPECT_NE(test::thrown_message([] { (void)fit_capsule({}); }), "");
  const std::vector<Vector3d> none{{0, std::nan(""), 0}};
  EXPECT_NE(test::thrown_message([&] { (void)fit_capsule(none); }), "");
}

TEST(CapsuleFit, CylindersAndBoxesAreContained) {
  const test::RandomRun run = test::random_run(200);
  for (std::int64_t i = 0; i < run.count; ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i));
    const CylinderShape cylinder{random.uniform(0.01, 0.3), random.uniform(0.01, 1)};
    const BoxShape box{Vector3d(random.uniform(0.02, 1), random.uniform(0.02, 1), random.uniform(0.02, 1))};
    const Capsule round = around(cylinder);
    const std::vector<Capsule> angular = around(box);
    for (int k = 0; k < 50; ++k) {
      const double turn = random.uniform(0, 7);
      const Vector3d rim(cylinder.radius_m * std::cos(turn), cylinder.radius_m * std::sin(turn),
                         (k % 2 == 0 ? 0.5 : -0.5) * cylinder.length_m);
      ASSERT_LE(outside_m({round}, rim), 1e-12);
      Vector3d face = random.in_cube(0.5).cwiseProduct(box.size_m);
      face[k % 3] = (k % 2 == 0 ? 0.5 : -0.5) * box.size_m[k % 3];
      ASSERT_LE(outside_m(angular, face), 1e-12) << box.size_m.transpose();
    }
    EXPECT_LE(volume(round), 3.1 * std::numbers::pi * cylinder.radius_m * cylinder.radius_m *
                                 std::max(cylinder.length_m, 1.3 * cylinder.radius_m));
    EXPECT_LE(angular.size(), 8U);
  }
}

TEST(LinkCapsules, ACylinderBetweenTwoSpheresIsOneCapsule) {
  const std::vector<LinkCapsule> capsules = link_capsules(kuka_lwr4());
  ASSERT_EQ(capsules.size(), 8U);
  for (std::size_t i = 0; i < capsules.size(); ++i) {
    EXPECT_EQ(capsules[i].link, i);
    EXPECT_GT(capsules[i].capsule.radius_m, 0.04);
    EXPECT_LT(capsules[i].capsule.radius_m, 0.1);
  }
  EXPECT_NEAR(capsules[1].capsule.radius_m, 0.07, 1e-6);
  EXPECT_LT((capsules[4].capsule.a - Vector3d(-0.002, 0.032, -0.002)).norm(), 1e-6);
  EXPECT_LT((capsules[4].capsule.b - Vector3d(0, 0, 0.163)).norm(), 1e-6);
}

// Neighbours overlap, and the published axis of the arm runs inside: nothing of it is left bare in any pose.
TEST(LinkCapsules, OfTheKukaHangTogether) {
  const RobotModel model = kuka_lwr4();
  const std::vector<LinkCapsule> capsules = link_capsules(model);
  const test::RandomRun run = test::random_run(100);
  for (std::int64_t i = 0; i < run.count; ++i) {
    Random random(run.seed + static_cast<std::uint64_t>(i));
    const std::vector<Pose> poses = link_poses(model, random.positions(model));
    std::vector<Capsule> placed(capsules.size());
    place(capsules, poses, placed);
    for (const std::size_t link : {2U, 4U, 6U, 7U}) {  // shoulder to elbow to wrist to flange
      const Vector3d from = link == 2 ? Vector3d(0, 0, 0) : Vector3d(poses[link == 7 ? 6 : link - 2].translation());
      const Vector3d to = poses[link].translation();
      for (double part = 0; part <= 1; part += 0.02) {
        ASSERT_LE(outside_m(placed, from + part * (to - from)), 0.0) << "to link " << link << " at " << part;
      }
    }
  }
}

TEST(LinkCapsules, Options) {
  const RobotModel model = kuka_lwr4();
  EXPECT_EQ(link_capsules(model, {{"lwr_0_link"}, 0.0}).size(), 7U);
  EXPECT_NEAR(link_capsules(model, {{}, 0.02})[1].capsule.radius_m, 0.09, 1e-6);
  EXPECT_NE(test::thrown_message([&] { (void)link_capsules(model, {{"nothing"}, 0.0}); }), "");
  EXPECT_NE(test::thrown_message([&] { (void)link_capsules(model, {{}, -1.0}); }), "");
}

TEST(LinkCapsules, ACapsuleOfTheFileIsThatCapsule) {
  const RobotModel model(parse_urdf(
      "<robot name='r'><link name='a'><collision><origin xyz='1 0 0'/><geometry><capsule radius='0.05' length='0.3'/>"
      "</geometry></collision></link></robot>",
      "arm.urdf"));
  const std::vector<LinkCapsule> capsules = link_capsules(model);
  ASSERT_EQ(capsules.size(), 1U);
  EXPECT_EQ(capsules[0].capsule.a, Vector3d(1, 0, -0.15));
  EXPECT_EQ(capsules[0].capsule.b, Vector3d(1, 0, 0.15));
  EXPECT_EQ(capsules[0].capsule.radius_m, 0.05);
}

TEST(LinkCapsules, PlatesAndWiresAreContained) {
  for (const Vector3d& size : {Vector3d(0.4, 0.2, 0), Vector3d(0, 0.3, 0), Vector3d(0.1, 0, 0.1)}) {
    const std::vector<Capsule> capsules = around(BoxShape{size});
    Random random(1);
    for (int k = 0; k < 100; ++k) {
      EXPECT_LE(outside_m(capsules, random.in_cube(0.5).cwiseProduct(size)), 1e-12) << size.transpose();
    }
    EXPECT_LE(capsules.size(), 8U);
  }
}

TEST(LinkCapsules, MeshesThatAreNone) {
  const auto file = std::filesystem::path(::testing::TempDir()) / "depthgrid_bad.stl";
  std::ofstream(file) << "nothing that is a mesh";
  EXPECT_THAT(test::thrown_message([&] { (void)mesh_points(file); }), ::testing::HasSubstr(file.string()));
}

/// Volume of a closed surface of triangles in an OBJ file, and its corners; read here, not by the library.
struct PlainMesh {
  std::vector<Vector3d> corners;
  double volume_m3 = 0;

  explicit PlainMesh(const std::filesystem::path& file) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
      std::istringstream words(line);
      std::string kind;
      words >> kind;
      if (kind == "v") {
        Vector3d p;
        words >> p.x() >> p.y() >> p.z();
        corners.push_back(p);
      } else if (kind == "f") {
        std::vector<std::size_t> face;
        for (std::string word; words >> word;) {
          face.push_back(std::stoul(word) - 1);
        }
        for (std::size_t k = 2; k < face.size(); ++k) {
          volume_m3 += corners[face[0]].dot(corners[face[k - 1]].cross(corners[face[k]])) / 6;
        }
      }
    }
  }
};

TEST(LinkCapsules, OfThePandaContainEveryCornerOfItsMeshes) {
  DEPTHGRID_REQUIRE_ROBOT_DATA();
  UrdfOptions options;
  options.packages["franka_description"] = robot_data() / "franka_panda";
  const RobotModel model(load_urdf(robot_data() / "franka_panda/franka_panda.urdf", options));
  const std::vector<LinkCapsule> capsules = link_capsules(model);
  ASSERT_EQ(capsules.size(), model.links().size());
  for (const LinkCapsule& item : capsules) {
    const LinkShape& shape = model.links()[item.link].shapes[0];
    const PlainMesh mesh(std::get<MeshShape>(shape.shape).file);
    ASSERT_GT(mesh.corners.size(), 50U);
    double most_m = -1;
    for (const Vector3d& corner : mesh.corners) {
      most_m = std::max(most_m, outside_m({item.capsule}, shape.T_link_shape * corner));
    }
    EXPECT_LE(most_m, 1e-9) << model.links()[item.link].name;
    EXPECT_GE(most_m, -1e-9) << model.links()[item.link].name;
    const double looseness = volume(item.capsule) / mesh.volume_m3;
    std::cout << model.links()[item.link].name << ": " << looseness << " times the mesh, radius "
              << item.capsule.radius_m << " m\n";
    EXPECT_GT(looseness, 1.0);
    EXPECT_LT(looseness, 4.0) << model.links()[item.link].name;
  }
}

TEST(LinkCapsules, OfTheSimplifiedLwrContainItsShapes) {
  DEPTHGRID_REQUIRE_ROBOT_DATA();
  const RobotModel model(load_urdf(robot_data() / "kuka_lwr/lwr_simplified.urdf"));
  const std::vector<LinkCapsule> capsules = link_capsules(model, {{"base"}, 0.0});
  EXPECT_EQ(model.links().size(), 9U);
  EXPECT_GE(capsules.size(), 8U);
  Random random(1);
  for (std::size_t link = 1; link < model.links().size(); ++link) {
    std::vector<Capsule> mine;
    for (const LinkCapsule& item : capsules) {
      if (item.link == link) {
        mine.push_back(item.capsule);
      }
    }
    for (const LinkShape& shape : model.links()[link].shapes) {
      for (int k = 0; k < 200; ++k) {
        Vector3d p = Vector3d::Zero();
        if (const auto* sphere = std::get_if<SphereShape>(&shape.shape)) {
          p = sphere->radius_m * random.unit();
        } else if (const auto* cylinder = std::get_if<CylinderShape>(&shape.shape)) {
          const double turn = random.uniform(0, 7);
          p = {cylinder->radius_m * std::cos(turn), cylinder->radius_m * std::sin(turn),
               (k % 2 - 0.5) * cylinder->length_m};
        } else if (const auto* box = std::get_if<BoxShape>(&shape.shape)) {
          p = random.in_cube(0.5).cwiseProduct(box->size_m);
        }
        ASSERT_LE(outside_m(mine, shape.T_link_shape * p), 1e-9) << model.links()[link].name;
      }
    }
  }
}

TEST(ControlPoints, BallsCoverTheCapsules) {
  const RobotModel model = kuka_lwr4();
  const std::vector<LinkCapsule> capsules = link_capsules(model);
  EXPECT_NE(test::thrown_message([&] { (void)cover_with_balls(capsules, 0.0); }), "");
  Random random(7);
  for (const double spacing_m : {0.02, 0.05, 1.0}) {
    const std::vector<ControlPoint> balls = cover_with_balls(capsules, spacing_m);
    for (const LinkCapsule& item : capsules) {
      for (int k = 0; k < 500; ++k) {
        const Capsule& c = item.capsule;
        const Vector3d p = c.a + random.uniform(0, 1) * (c.b - c.a) + c.radius_m * random.unit();
        double outside = 1;
        for (const ControlPoint& ball : balls) {
          outside = ball.link == item.link ? std::min(outside, (p - ball.p_link).norm() - ball.radius_m) : outside;
        }
        ASSERT_LE(outside, 1e-12);
      }
    }
    std::vector<Vector3d> placed(balls.size());
    const std::vector<Pose> poses = link_poses(model, random.positions(model));
    place(balls, poses, placed);
    EXPECT_EQ(placed.back(), poses[balls.back().link] * balls.back().p_link);
  }
}

}  // namespace
}  // namespace depthgrid::robot
