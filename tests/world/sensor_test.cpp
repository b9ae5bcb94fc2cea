// The sensors keep what their margins promise: of everything in a pixel's square, some reading within the filter radius
// less its margin is no farther than it.
#include "world/sensor.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random_run.hpp"

namespace depthgrid::world {
namespace {

using Eigen::Vector3d;

/// Least D - m(D) of the neighbourhood; 0 where something was not measured or lies outside.
double free_m(const DepthView& view, const MeasurementRule& rule, const SensorMargin& margin, int u, int v) {
  double least_m = std::numeric_limits<double>::infinity();
  for (int j = v - margin.lateral_px; j <= v + margin.lateral_px; ++j) {
    for (int i = u - margin.lateral_px; i <= u + margin.lateral_px; ++i) {
      const bool inside = i >= 0 && j >= 0 && i < view.width_px && j < view.height_px;
      const auto depth_m = inside ? measured_depth_m(view, rule, i, j) : std::nullopt;
      least_m = std::min(least_m, depth_m ? *depth_m - depth_margin_m(margin, *depth_m) : 0.0);
    }
  }
  return least_m;
}

/// Without what moves: a long exposure would not show all of it at one instant.
World still_world(std::uint64_t seed, Broken broken) {
  World world = make_world({seed, 0, broken});
  for (Solid& solid : world.solids) {
    const Capsule at = solid.at(1);
    solid.a = {std::make_shared<const Path>(std::vector<Path::Stop>{{0, at.a}})};
    solid.b = {std::make_shared<const Path>(std::vector<Path::Stop>{{0, at.b}})};
  }
  world.robot.clear();
  return world;
}

struct Found {
  std::int64_t looked = 0;
  std::int64_t free_though_there = 0;
  double tightest_m = 1;  ///< by how much a point was not free
};

Found look(const test::RandomRun& run, Broken broken) {
  Found found;
  for (std::int64_t i = 0; i < run.count; ++i) {
    const std::uint64_t seed = run.seed + static_cast<std::uint64_t>(i);
    const World world = still_world(seed, broken);
    Random random(seed, 201);
    for (std::size_t k = 0; k < world.cameras.size(); ++k) {
      const RigCamera& camera = world.rig.cameras[k];
      Sensor sensor(world, k);
      const Exposure exposure{k, 0, 1.0, 1.0, 1.0};
      const DepthView view = sensor.take(exposure);
      for (const Solid& solid : world.solids) {
        for (int n = 0; n < 100; ++n) {
          const Capsule at = solid.at(1);
          const Vector3d p = at.a + random.uniform(0, 1) * (at.b - at.a) + solid.radius_m * random.direction();
          const Vector3d p_camera = true_pose(world, exposure).inverse(Eigen::Isometry) * p;
          const DepthPoint pixel = project(camera.intrinsics, p_camera);
          const int u = static_cast<int>(std::floor(pixel.x_px));
          const int v = static_cast<int>(std::floor(pixel.y_px));
          const Vector3d over = (p - world.box().high_world).cwiseMax(world.box().low_world - p);
          if (p_camera.z() > camera.rule.near_m && camera.intrinsics.contains(u, v) && over.maxCoeff() < 0) {
            const double behind_m = p_camera.z() - free_m(view, camera.rule, world.settings.margins[k].sensor, u, v);
            ++found.looked;
            found.free_though_there += behind_m < 0 ? 1 : 0;
            found.tightest_m = std::min(found.tightest_m, behind_m);
          }
        }
      }
    }
  }
  return found;
}

TEST(Sensor, NothingInAPixelIsNearerThanItsReadingsLessTheirMargins) {
  const test::RandomRun run = test::random_run(150);
  const Found found = look(run, Broken::none);
  EXPECT_GT(found.looked, 500 * run.count);
  EXPECT_EQ(found.free_though_there, 0) << run.reproduce();
  EXPECT_LT(found.tightest_m, 0.15 / static_cast<double>(run.count))
      << "the bound is put to the test; " << run.reproduce();
}

TEST(Sensor, BrokenReadingsAndThinThingsAreFreeThoughTheyAreThere) {
  const test::RandomRun run = test::random_run(20);
  for (const Broken broken : {Broken::readings, Broken::thinner, Broken::clear}) {
    EXPECT_GT(look(run, broken).free_though_there, 0) << to_string(broken) << "; " << run.reproduce();
  }
}

}  // namespace
}  // namespace depthgrid::world
