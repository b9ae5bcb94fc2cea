// Rendered depth, robot intervals and distances of random scenes against marching along the rays.
#include "depthgrid/simulation/scene.hpp"

#include <gtest/gtest.h>

#include "depthgrid/core/error.hpp"
#include "simulation/random_scenes.hpp"

namespace depthgrid::simulation::testing {
namespace {

const PinholeCamera kCamera{24, 18, 20, 21, 11.3, 9.4};
constexpr double kFarthest = 15;

/// Depths are floats: half a unit in the last place below 16 m, along a ray of at most twice that length.
constexpr double kFloatRounding = 2e-6;

struct RandomScene {
  Scene scene;
  std::vector<Solid> obstacles;
  std::vector<Solid> robot;
  std::string text;
};

RandomScene random_scene(Random& random) {
  RandomScene result;
  const int solids = random.integer(1, 7);
  for (int i = 0; i < solids; ++i) {
    const Solid solid = random.solid();
    const bool robot = random.integer(0, 1) == 1;
    solid.add(result.scene, robot ? Body::robot : Body::obstacle);
    (robot ? result.robot : result.obstacles).push_back(solid);
    result.text += (robot ? "\n  robot " : "\n  obstacle ") + solid.text;
  }
  return result;
}

double nearest_of(const std::vector<Solid>& solids, double padding_m, const Eigen::Vector3d& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Solid& solid : solids) {
    nearest = std::min(nearest, solid.grown(padding_m)(p));
  }
  return nearest;
}

/// The first depth at or beyond `from_m` where the signed distance is below -kFloatRounding, by steps that cannot jump
/// over anything deeper than the smallest step; kFarthest when there is none.
template <class SignedDistanceAtDepth>
double first_inside(double from_m, double ray_length, const SignedDistanceAtDepth& signed_distance) {
  double z = from_m;
  while (z < kFarthest) {
    const double d = signed_distance(z);
    if (d < -kFloatRounding) {
      return z;
    }
    z += std::max(d, 1e-4) / ray_length;
  }
  return kFarthest;
}

TEST(Scene, EveryPixelEndsAtTheFirstSurfaceOfItsCentreRay) {
  for (int n = 0; n < count(150); ++n) {
    Random random(seed() + static_cast<unsigned long>(n));
    const RandomScene world = random_scene(random);
    const Pose T_world_camera = look_at(random.unit() * 4, random.in_cube(0.5));
    const View view = world.scene.render(kCamera, T_world_camera);
    const auto scene_distance = [&](const Eigen::Vector3d& p) {
      return std::min(nearest_of(world.obstacles, 0, p), nearest_of(world.robot, 0, p));
    };
    if (scene_distance(T_world_camera.translation()) <= 0) {
      for (int v = 0; v < kCamera.height_px; ++v) {
        for (int u = 0; u < kCamera.width_px; ++u) {
          ASSERT_EQ(view.depth_m.at(u, v), 0.0F);
        }
      }
      continue;
    }
    for (int v = 0; v < kCamera.height_px; ++v) {
      for (int u = 0; u < kCamera.width_px; ++u) {
        const Eigen::Vector3d ray((u + 0.5 - 11.3) / 20, (v + 0.5 - 9.4) / 21, 1);
        const auto at = [&](double z) { return scene_distance(T_world_camera * Eigen::Vector3d(ray * z)); };
        const double depth = view.depth_m.at(u, v);
        const std::string where = "case seed " + std::to_string(seed() + static_cast<unsigned long>(n)) + ", pixel " +
                                  std::to_string(u) + " " + std::to_string(v) + ", depth " + std::to_string(depth) +
                                  world.text;
        const double marched = first_inside(0, ray.norm(), at);
        if (depth == 0) {
          ASSERT_EQ(marched, kFarthest) << where;
        } else if (depth < kFarthest) {
          ASSERT_NEAR(at(depth), 0, kFloatRounding) << where;
          ASSERT_GE(marched, depth - kFloatRounding) << where;
        }
      }
    }
  }
}

TEST(Scene, RobotIntervalIsTheContiguousPartOfThePaddedRobotAtItsFirstSurface) {
  int gaps = 0;
  int behind_padding = 0;
  for (int n = 0; n < count(150); ++n) {
    Random random(seed() + static_cast<unsigned long>(n));
    const RandomScene world = random_scene(random);
    const Pose T_world_camera = look_at(random.unit() * 4, random.in_cube(0.5));
    const double padding_m = random.integer(0, 2) == 0 ? 0.0 : random.uniform(0, 0.1);
    const View view = world.scene.render(kCamera, T_world_camera, padding_m);
    for (int v = 0; v < kCamera.height_px; ++v) {
      for (int u = 0; u < kCamera.width_px; ++u) {
        const Eigen::Vector3d ray((u + 0.5 - 11.3) / 20, (v + 0.5 - 9.4) / 21, 1);
        const auto at = [&](double z) {
          return nearest_of(world.robot, padding_m, T_world_camera * Eigen::Vector3d(ray * z));
        };
        const double near_m = view.robot_near_m.at(u, v);
        const double far_m = view.robot_far_m.at(u, v);
        const std::string where = "case seed " + std::to_string(seed() + static_cast<unsigned long>(n)) + ", pixel " +
                                  std::to_string(u) + " " + std::to_string(v) + ", interval " + std::to_string(near_m) +
                                  " " + std::to_string(far_m) + ", padding " + std::to_string(padding_m) + world.text;
        if (near_m == 0) {
          ASSERT_EQ(far_m, 0) << where;
          ASSERT_EQ(first_inside(0, ray.norm(), at), kFarthest) << where;
          continue;
        }
        ASSERT_LE(near_m, far_m) << where;
        const double padding_begins = first_inside(0, ray.norm(), at);
        const double surface_m = first_inside(0, ray.norm(), [&](double z) {
          return nearest_of(world.robot, 0, T_world_camera * Eigen::Vector3d(ray * z));
        });
        if (surface_m < kFarthest) {
          ASSERT_LE(near_m, surface_m + kFloatRounding) << where;
          ASSERT_GE(far_m, surface_m - kFloatRounding) << where;
          behind_padding += padding_begins < near_m - 1e-3 ? 1 : 0;
        } else if (far_m < kFarthest) {  // else its surface lies farther away than the march went
          ASSERT_GE(padding_begins, near_m - kFloatRounding) << where;
        }
        if (near_m >= kFarthest) {
          continue;
        }
        for (int i = 0; i <= 400; ++i) {
          const double z = near_m + (std::min(far_m, kFarthest) - near_m) * i / 400;
          ASSERT_LE(at(z), kFloatRounding) << where << "\n  outside at depth " << z;
        }
        if (far_m < kFarthest) {
          ASSERT_NEAR(at(far_m), 0, kFloatRounding) << where;
          // A part of the robot that begins right behind the exit would have to be merged; a graze of the surface is
          // none.
          const double again = first_inside(far_m + kFloatRounding, ray.norm(), at);
          ASSERT_TRUE(again == kFarthest || at(0.5 * (far_m + again)) > -kFloatRounding) << where;
          gaps += again < kFarthest ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(behind_padding, 0) << "no ray left the padding before it met the robot: nothing tested there";
  EXPECT_GT(gaps, 0) << "no case had a second part of the robot behind the first: nothing tested there";
}

TEST(Scene, DistanceIsThatOfTheNearestObstacleAndIgnoresTheRobot) {
  for (int n = 0; n < count(3000); ++n) {
    Random random(seed() + static_cast<unsigned long>(n));
    const RandomScene world = random_scene(random);
    const Eigen::Vector3d p = random.in_cube(2.5);
    const SceneDistance answer = world.scene.distance(p);
    const double expected = nearest_of(world.obstacles, 0, p);
    const std::string where =
        "case seed " + std::to_string(seed() + static_cast<unsigned long>(n)) + ", point " + code(p) + world.text;
    if (world.obstacles.empty()) {
      ASSERT_TRUE(std::isinf(answer.distance_m)) << where;
      ASSERT_TRUE(answer.nearest_world.hasNaN()) << where;
      continue;
    }
    ASSERT_NEAR(answer.distance_m, std::max(0.0, expected), 1e-9) << where;
    ASSERT_NEAR((answer.nearest_world - p).norm(), answer.distance_m, 1e-9) << where;
    ASSERT_EQ(world.scene.contains(p, Body::obstacle), answer.distance_m == 0) << where;
    if (std::abs(nearest_of(world.robot, 0, p)) > 1e-9) {
      ASSERT_EQ(world.scene.contains(p, Body::robot), nearest_of(world.robot, 0, p) < 0) << where;
    }
  }
}

TEST(Scene, DepthIsZNotRangeAndPixelsAreSampledAtTheirCentres) {
  Scene scene;
  scene.add(Plane{-Eigen::Vector3d::UnitZ(), -2});  // solid from z = 2 on
  Box edge;                                         // covers x >= 0.002 at z = 1 ... 1.5
  edge.T_world_box.translation() = Eigen::Vector3d(1.002, 0, 1.25);
  edge.half_size_m = {1, 3, 0.25};
  scene.add(edge);
  const PinholeCamera camera{100, 80, 100, 100, 50, 40};
  const View view = scene.render(camera, Pose::Identity());
  EXPECT_EQ(view.depth_m.at(0, 0), 2.0F);
  EXPECT_EQ(view.depth_m.at(49, 79), 2.0F);
  // The centre of pixel 50 looks along x = 0.005 z; sampled at its left edge it would miss the box.
  EXPECT_EQ(view.depth_m.at(50, 40), 1.0F);
  EXPECT_EQ(view.depth_m.at(99, 0), 1.0F);
  EXPECT_EQ(view.robot_near_m.at(50, 40), 0.0F);
}

TEST(Scene, SphereHasTheDepthOfItsQuadratic) {
  Scene scene;
  scene.add(Sphere{{0.1, -0.2, 2}, 0.3}, Body::robot);
  const PinholeCamera camera{64, 48, 60, 60, 32, 24};
  const View view = scene.render(camera, Pose::Identity(), 0.05);
  const auto root = [](double x, double y, double r) {
    const double a = x * x + y * y + 1;
    const double b = -2 * (0.1 * x - 0.2 * y + 2);
    const double c = 0.01 + 0.04 + 4 - r * r;
    return std::pair((-b - std::sqrt(b * b - 4 * a * c)) / (2 * a), (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a));
  };
  const auto surface = root(2.5 / 60, -5.5 / 60, 0.3);
  const auto padded = root(2.5 / 60, -5.5 / 60, 0.35);
  EXPECT_NEAR(view.depth_m.at(34, 18), surface.first, 1e-6);
  EXPECT_NEAR(view.robot_near_m.at(34, 18), padded.first, 1e-6);
  EXPECT_NEAR(view.robot_far_m.at(34, 18), padded.second, 1e-6);
}

TEST(Scene, CameraInsideASolidMeasuresNothing) {
  Scene scene;
  scene.add(Sphere{{0, 0, 0}, 0.2}, Body::robot);
  scene.add(Plane{-Eigen::Vector3d::UnitZ(), -2});
  const PinholeCamera camera{16, 12, 15, 15, 8, 6};
  const View inside = scene.render(camera, Pose::Identity());
  EXPECT_EQ(inside.depth_m.at(8, 6), 0.0F);
  EXPECT_EQ(inside.depth_m.at(0, 0), 0.0F);

  Pose in_padding = Pose::Identity();
  in_padding.translation().z() = 0.25;
  const View padded = scene.render(camera, in_padding, 0.1);
  EXPECT_EQ(padded.depth_m.at(8, 6), 1.75F);
  EXPECT_GT(padded.robot_near_m.at(8, 6), 0.0F);
  EXPECT_LT(padded.robot_near_m.at(8, 6), 1e-30F);
  EXPECT_GT(padded.robot_far_m.at(8, 6), 0.0F);
}

TEST(Scene, BrokenArgumentsAreRefused) {
  Scene scene;
  EXPECT_THROW(scene.add(Sphere{{0, 0, 0}, 0}), Error);
  EXPECT_THROW(scene.add(Plane{{1, 1, 0}, 0}), Error);
  const PinholeCamera camera{16, 12, 15, 15, 8, 6};
  EXPECT_THROW((void)scene.render(camera, Pose::Identity(), -0.01), Error);
  EXPECT_THROW((void)scene.render({16, 12, 0, 15, 8, 6}, Pose::Identity()), Error);
  EXPECT_TRUE(std::isinf(scene.distance({0, 0, 0}).distance_m)) << "a refused solid must not stay in the scene";
}

}  // namespace
}  // namespace depthgrid::simulation::testing
