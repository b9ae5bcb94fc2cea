// Ray-cast depth against the analytic scene: the same but for rounding and for pixels whose centre ray passes an edge
// within rounding.
#include "lab/workcell/depth_caster.hpp"

#include <gtest/gtest.h>

#include <cstdio>

#include "depthgrid/core/error.hpp"
#include "depthgrid/simulation/demo_scene.hpp"
#include "simulation/random_scenes.hpp"

namespace depthgrid::workcell::testing {
namespace {

using simulation::BodyKind;
using simulation::contains;
using simulation::mesh_of;
using simulation::nearest_point;
using simulation::TriangleMesh;
using simulation::Workcell;
using simulation::WorkcellBody;
using simulation::testing::count;
using simulation::testing::Random;
using simulation::testing::seed;

const PinholeCamera kCamera{320, 240, 262.5, 262.5, 160, 120};

/// How two depth images of the same scene differ.
struct Difference {
  long pixels = 0;
  long others = 0;       ///< another surface seen: differ by more than 1 mm
  double largest_m = 0;  ///< of all others
  double sum_m = 0;
};

void compare(const DepthImage& cast, const DepthImage& exact, Difference& difference) {
  for (int v = 0; v < cast.height_px(); ++v) {
    for (int u = 0; u < cast.width_px(); ++u) {
      const double off_m = std::abs(static_cast<double>(cast.at(u, v)) - exact.at(u, v));
      ++difference.pixels;
      if (off_m > 1e-3) {
        ++difference.others;
      } else {
        difference.largest_m = std::max(difference.largest_m, off_m);
        difference.sum_m += off_m;
      }
    }
  }
}

WorkcellBody body(const char* name, BodyKind kind = BodyKind::object) {
  WorkcellBody result;
  result.name = name;
  result.kind = kind;
  return result;
}

/// Capsules, boxes, spheres and a wall, each in a body with a pose of its own.
Workcell random_cell(Random& random) {
  Workcell cell;
  WorkcellBody room = body("room", BodyKind::room);
  room.planes.push_back({Eigen::Vector3d::UnitZ(), -1.5});
  room.planes.push_back({Eigen::Vector3d::UnitX(), -3});
  cell.bodies.push_back(room);
  for (int i = 0; i < 12; ++i) {
    WorkcellBody part = body(("part " + std::to_string(i)).c_str(), i % 2 == 0 ? BodyKind::robot : BodyKind::person);
    part.T_world_body = random.pose(1);
    const Eigen::Vector3d a = random.in_cube(0.3);
    part.capsules.push_back({a, a + random.uniform(0.01, 0.5) * random.unit(), random.uniform(0.02, 0.15)});
    if (i % 3 == 0) {
      part.boxes.push_back({random.pose(0.3), {random.uniform(0.02, 0.3), 0.1, 0.05}});
      part.spheres.push_back({random.in_cube(0.5), random.uniform(0.02, 0.2)});
    }
    cell.bodies.push_back(part);
  }
  return cell;
}

TEST(DepthCaster, SolidsAreThoseOfTheAnalyticSceneWhateverMoves) {
  Random random(seed());
  Workcell cell = random_cell(random);
  DepthCaster caster(cell);
  Difference difference;
  DepthImage depth_m;
  for (int n = 0; n < count(20); ++n) {
    cell = random_cell(random);  // the same bodies, other poses and measures
    caster.update(cell);
    const Pose T_world_camera = look_at(random.unit() * 2.8, random.in_cube(0.5));
    caster.render(kCamera, T_world_camera, depth_m);
    compare(depth_m, scene_of(cell).render(kCamera, T_world_camera).depth_m, difference);
  }
  std::printf("[ figures  ] other surface %.1e of the pixels, others off by %.1e m at most, %.1e m on average\n",
              static_cast<double>(difference.others) / static_cast<double>(difference.pixels), difference.largest_m,
              difference.sum_m / static_cast<double>(difference.pixels));
  EXPECT_LT(difference.others, difference.pixels / 50000) << "only centres within rounding of an edge may differ";
  EXPECT_LT(difference.sum_m / static_cast<double>(difference.pixels), 2e-6);
}

TEST(DepthCaster, TheDemoIsTheSame) {
  const simulation::DemoScene demo = simulation::demo_scene();
  Workcell cell;
  WorkcellBody arm = body("arm", BodyKind::robot);
  arm.capsules.assign(demo.arm.links.begin(), demo.arm.links.end());
  cell.bodies.push_back(arm);
  const DepthCaster caster(cell);
  simulation::Scene scene = scene_of(cell);
  Difference difference;
  for (const RigCamera& camera : demo.rig.cameras) {
    DepthImage depth_m;
    BodyImage bodies;
    caster.render(camera.intrinsics, camera.T_world_camera, depth_m, bodies);
    const simulation::View view = scene.render(camera.intrinsics, camera.T_world_camera);
    compare(depth_m, view.depth_m, difference);
    for (std::size_t i = 0; i < bodies.body.size(); ++i) {
      ASSERT_EQ(bodies.body[i] == BodyImage::kNone, depth_m.data()[i] == 0) << i;
    }
  }
  EXPECT_LT(difference.others, 10);
  EXPECT_LT(difference.largest_m, 1e-3);
}

TEST(DepthCaster, MeshesAreWithinTheirTessellationAndFollowTheirPose) {
  Random random(seed());
  constexpr int kSegments = 96;
  Difference difference;
  for (int n = 0; n < count(10); ++n) {
    const Capsule link{random.in_cube(0.2), random.in_cube(0.2), random.uniform(0.05, 0.2)};
    const simulation::Box block{random.pose(0.1), {0.2, 0.1, 0.15}};
    Workcell meshes;
    Workcell solids;
    for (const char* name : {"link", "block"}) {
      meshes.bodies.push_back(body(name));
      solids.bodies.push_back(body(name));
    }
    meshes.bodies[0].mesh = std::make_shared<TriangleMesh>(mesh_of(link, kSegments));
    solids.bodies[0].capsules = {link};
    meshes.bodies[1].mesh = std::make_shared<TriangleMesh>(mesh_of(block));
    solids.bodies[1].boxes = {block};
    DepthCaster caster(meshes);
    for (int move = 0; move < 2; ++move) {
      for (std::size_t i = 0; i < 2; ++i) {
        meshes.bodies[i].T_world_body = solids.bodies[i].T_world_body = random.pose(0.5);
      }
      caster.update(meshes);
      const Pose T_world_camera = look_at(random.unit() * 2.5, random.in_cube(0.2));
      DepthImage depth_m;
      BodyImage bodies;
      caster.render(kCamera, T_world_camera, depth_m, bodies);
      const DepthImage exact = scene_of(solids).render(kCamera, T_world_camera).depth_m;
      compare(depth_m, exact, difference);
      for (int v = 0; v < kCamera.height_px; ++v) {
        for (int u = 0; u < kCamera.width_px; ++u) {
          const std::uint16_t seen = bodies.body[depth_m.index(u, v)];
          if (depth_m.at(u, v) == 0) {
            ASSERT_EQ(seen, BodyImage::kNone);
            continue;
          }
          // The point lies on the body that it is said to be of.
          const Eigen::Vector3d p = T_world_camera * deproject(kCamera, {u + 0.5, v + 0.5, depth_m.at(u, v)});
          const Eigen::Vector3d q = solids.bodies[seen].T_world_body.inverse() * p;
          const double off_m = seen == 0 ? (nearest_point(link, q) - q).norm() : (nearest_point(block, q) - q).norm();
          ASSERT_LT(off_m, 1e-5) << "outside the solid";
          if (seen == 0) {
            const double depth_below_m = simulation::inscribed_depth_m(link.radius_m, kSegments) + 1e-5;
            Capsule core = link;
            core.radius_m -= depth_below_m;
            ASSERT_FALSE(contains(core, q)) << "deeper than the mesh may lie";
          }
        }
      }
    }
  }
  // The rim of a link is lost by fractions of a millimetre, seldom a pixel's centre.
  EXPECT_LT(difference.others, difference.pixels / 1000);
}

TEST(DepthCaster, ImageSizesThatAreNoMultipleOfAPacketAreWhole) {
  Workcell cell;
  cell.bodies.push_back(body("ball"));
  cell.bodies[0].spheres = {{{0, 0, 2}, 3.0 / 4}};
  const DepthCaster caster(cell);
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(5, 3), std::pair(17, 6)}) {
    const PinholeCamera camera{width, height, 10, 10, width / 2.0, height / 2.0};
    DepthImage depth_m;
    caster.render(camera, Pose::Identity(), depth_m);
    Difference difference;
    compare(depth_m, scene_of(cell).render(camera, Pose::Identity()).depth_m, difference);
    EXPECT_EQ(difference.pixels, width * height);
    EXPECT_EQ(difference.others, 0);
    EXPECT_LT(difference.largest_m, 1e-5);
  }
}

TEST(DepthCaster, ACameraInsideASolidSeesNothing) {
  Workcell cell;
  cell.bodies.push_back(body("ball"));
  cell.bodies[0].spheres = {{{0, 0, 0}, 0.5}};
  cell.bodies[0].T_world_body.translation().x() = 1;
  cell.bodies.push_back(body("wall", BodyKind::room));
  cell.bodies[1].planes = {{-Eigen::Vector3d::UnitZ(), -3}};
  const DepthCaster caster(cell);
  Pose T_world_camera = Pose::Identity();
  DepthImage depth_m;
  caster.render(kCamera, T_world_camera, depth_m);
  EXPECT_EQ(depth_m.at(10, 10), 3.0F);
  T_world_camera.translation().x() = 1.2;
  caster.render(kCamera, T_world_camera, depth_m);
  EXPECT_EQ(depth_m.at(10, 10), 0.0F);
}

TEST(DepthCaster, BrokenCellsAreRefusedWithTheirName) {
  const auto refusal = [](const Workcell& first, const Workcell& next) {
    try {
      DepthCaster caster(first);
      caster.update(next);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  Workcell cell;
  cell.bodies.push_back(body("link"));
  EXPECT_EQ(refusal(cell, cell), "body 'link': has no shape");
  cell.bodies[0].spheres = {{}};
  EXPECT_EQ(refusal(cell, cell), "accepted");
  Workcell next = cell;
  next.bodies[0].spheres.emplace_back();
  EXPECT_EQ(refusal(cell, next), "body 'link' now has 2 spheres, had 1; shapes may move but neither come nor go");
  next = cell;
  next.bodies[0].T_world_body.linear()(0, 0) = 2;
  EXPECT_EQ(
      refusal(cell, next),
      "body 'link': rotation deviates from orthonormal by 3, must be at most 1e-09, and must not be a reflection");
  next = cell;
  next.bodies.push_back(next.bodies[0]);
  EXPECT_EQ(refusal(next, next), "two bodies are called 'link', names must be distinct");
  next = cell;
  TriangleMesh mesh;
  mesh.vertices_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 3}};
  next.bodies[0].mesh = std::make_shared<TriangleMesh>(mesh);
  EXPECT_EQ(refusal(next, next), "body 'link': mesh: triangle 0 has corners 0 1 3, must be indices of 3 vertices");
}

}  // namespace
}  // namespace depthgrid::workcell::testing
