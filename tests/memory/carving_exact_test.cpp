// What single precision decides about voxels, a block of them at once, is what the exact test says of each; and the
// planes that it begins with hold what the pixels show.
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <vector>

#include "depthgrid/core/pose.hpp"
#include "depthgrid/memory/carving.hpp"
#include "depthgrid/memory/depth_planes.hpp"
#include "depthgrid/views/ball_query.hpp"
#include "depthgrid/views/view_store.hpp"
#include "reference/random_problem.hpp"
#include "support/random_run.hpp"

namespace depthgrid::memory {
namespace {

using Eigen::Vector3d;
using reference::Random;

/// Slanted planes, with noise, steps, holes and a robot before, in or behind them.
class Scene {
 public:
  explicit Scene(Random& random) {
    camera.id = "0";
    const bool tiny = random.chance(0.1);  // fewer pixels than lanes
    const int width_px = tiny ? random.integer(2, 6) : random.integer(8, 200);
    const int height_px = tiny ? random.integer(2, 3) : random.integer(6, 150);
    const double focal_px = random.uniform(0.6, 1.5) * width_px;
    camera.intrinsics = {width_px,
                         height_px,
                         focal_px,
                         focal_px * random.uniform(0.9, 1.1),
                         width_px * random.uniform(0.3, 0.7),
                         height_px * random.uniform(0.3, 0.7)};
    camera.rule.near_m = random.chance(0.5) ? 0.0 : random.uniform(0.1, 1.2);
    camera.T_world_camera =
        look_at(random.uniform(0.3, 2.5) * random.direction(), random.in_cube(0.2), random.direction());
    depth_m.resize(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px));
    near_m.assign(depth_m.size(), 0.0F);
    far_m.assign(depth_m.size(), 0.0F);
    const double noise_m = random.chance(0.5) ? 0.0 : random.uniform(0, 0.02);
    const double holes = random.chance(0.5) ? 0.0 : random.uniform(0, 0.01);
    const int pieces = random.integer(1, 6);
    for (int n = 0; n < pieces; ++n) {
      const int u0 = n == 0 ? 0 : random.integer(0, width_px - 1);
      const int v0 = n == 0 ? 0 : random.integer(0, height_px - 1);
      const int u1 = n == 0 ? width_px : random.integer(u0 + 1, width_px);
      const int v1 = n == 0 ? height_px : random.integer(v0 + 1, height_px);
      const double inverse = 1 / random.uniform(0.5, 5);
      const double right = random.chance(0.3) ? 0.0 : random.uniform(-1, 1) * inverse / width_px;
      const double down = random.chance(0.3) ? 0.0 : random.uniform(-1, 1) * inverse / height_px;
      const bool robot = n > 0 && random.chance(0.2);
      for (int v = v0; v < v1; ++v) {
        for (int u = u0; u < u1; ++u) {
          const auto at = static_cast<std::size_t>(v * width_px + u);
          const double value = 1 / std::max(inverse + right * (u - u0) + down * (v - v0), 0.05);
          if (robot) {
            near_m[at] = static_cast<float>(value);
            far_m[at] = static_cast<float>(value + 0.2);
          } else {
            depth_m[at] = random.chance(holes) ? 0.0F : static_cast<float>(value + noise_m * random.uniform(-1, 1));
          }
        }
      }
    }
    margins.sensor = {random.uniform(0, 0.02), 0, 0, random.integer(0, 1)};
    margins.smallest_obstacle_m = 0;
    margins.translation_m = random.chance(0.5) ? 0.0 : random.uniform(0, 0.01);
    margins.rotation_rad = random.chance(0.5) ? 0.0 : random.uniform(0, 0.01);
    margins.half_exposure_s = random.uniform(0, 0.01);
  }

  [[nodiscard]] views::Settings settings(Random& random) const {
    views::Settings result;
    result.space = views::BoxSpace{Vector3d::Constant(-1.5), Vector3d::Constant(1.5)};
    result.policies = {views::Policy::obstacle, views::Policy::obstacle, views::Policy::obstacle, 0};
    result.margins = {margins};
    result.v_max_m_s = random.uniform(0, 2);
    return result;
  }

  [[nodiscard]] Frame frame() const {
    const int width_px = camera.intrinsics.width_px;
    const int height_px = camera.intrinsics.height_px;
    Frame result{depth_view(depth_m, width_px, height_px), {}, 1};
    result.robot.near_m = near_m.data();
    result.robot.far_m = far_m.data();
    return result;
  }

  RigCamera camera;
  CameraMargins margins;
  std::vector<float> depth_m, near_m, far_m;
};

struct Tally {
  std::int64_t voxels = 0, free = 0, images = 0, islands = 0;
};

void expect_planes_hold(const views::PreparedImage& image, const PinholeCamera& c, const DepthPlanes& planes) {
  for (std::size_t n = 0; n < planes.level_count(); ++n) {
    const DepthPlanes::Level& level = planes.levels()[n];
    const int side_px = 1 << level.shift;
    for (int j = 0; j + DepthPlanes::kTiles <= level.height; ++j) {
      for (int i = 0; i + DepthPlanes::kTiles <= level.width; ++i) {
        const auto at = static_cast<std::size_t>(level.offset + j * level.width + i);
        for (int v = j * side_px; v < std::min((j + DepthPlanes::kTiles) * side_px, c.height_px); ++v) {
          for (int u = i * side_px; u < std::min((i + DepthPlanes::kTiles) * side_px, c.width_px); ++u) {
            const double free_m = static_cast<double>(image.free_m.at(u, v));
            const double most_m =
                image.has_islands ? std::max(free_m, static_cast<double>(image.island_far_m.at(u, v))) : free_m;
            for (int corner = 0; corner < 4; ++corner) {
              const double x = (u + (corner & 1) - c.cx_px) / c.fx_px;
              const double y = (v + (corner >> 1) - c.cy_px) / c.fy_px;
              const double across = static_cast<double>(planes.x()[at]) * x + static_cast<double>(planes.y()[at]) * y;
              const double begin = std::max(free_m, 2e-3);
              ASSERT_GT((across + static_cast<double>(planes.z_near()[at])) * begin, 1 - 1e-5) << u << ' ' << v;
              ASSERT_GT(static_cast<double>(planes.nearest()[at]) * begin, 1 - 1e-5) << u << ' ' << v;
              ASSERT_LT((across + static_cast<double>(planes.z_far()[at])) * most_m, 1 + 3e-5) << u << ' ' << v;
              ASSERT_LT(static_cast<double>(planes.farthest()[at]) * most_m, 1 + 3e-5) << u << ' ' << v;
            }
          }
        }
      }
    }
  }
}

void compare(Random& random, Tally& tally) {
  const Scene scene(random);
  const Rig rig{.name = "cell", .cameras = {scene.camera}, .T_floor_world = {}};
  views::ViewStore views(rig, scene.settings(random), 2);
  ASSERT_TRUE(views.update(0, scene.frame()).taken());
  const views::Snapshot snapshot = views.snapshot();
  const views::PreparedImage& image = views::prepared(snapshot.view(0));
  Vector3d low = Vector3d::Constant(-0.5) + random.in_cube(0.1);
  Vector3d high = Vector3d::Constant(0.4) + random.in_cube(0.1);
  double voxel_m = random.uniform(0.02, 0.06);
  if (random.chance(0.1)) {  // rows longer than what is looked at in one go
    low = {-1.4, -0.1, -0.1};
    high = {1.4, 0.1, 0.1};
    voxel_m = 0.02;
  }
  PossibleSpace space{.voxels = VoxelSet(low, high, voxel_m)};
  space.pending_m = random.chance(0.1) ? 0.0 : random.uniform(0, space.voxels.voxel_m());
  DepthPlanes planes(scene.camera.intrinsics.width_px, scene.camera.intrinsics.height_px);
  planes.update(image, scene.camera.intrinsics);
  expect_planes_hold(image, scene.camera.intrinsics, planes);
  const Carver carver = make_carver(snapshot, 0, 0, planes, space, 0);
  VoxelSet voxels = space.voxels;
  BlockingPixels blocking(voxels.voxel_blocks().size());
  const std::int64_t removed = carve(carver, blocking, voxels);
  EXPECT_EQ(removed, space.voxels.count() - voxels.count());
  int missing = 0;
  int left = 0;
  const std::array<int, 3>& count = voxels.voxels();
  for (int z = 0; z < count[2]; ++z) {
    for (int y = 0; y < count[1]; ++y) {
      for (int x = 0; x < count[0]; ++x) {
        const Vector3d p = carver.camera.to_camera(voxels.centre_world(x, y, z) - carver.origin_world);
        const bool is_free = !views::meets_not_known_free(carver.camera, views::Clip{}, p, carver.radius_m(p));
        missing += !is_free && !voxels.contains(x, y, z) ? 1 : 0;
        left += is_free && voxels.contains(x, y, z) ? 1 : 0;
        ++tally.voxels;
        tally.free += is_free ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(missing, 0) << "voxels are missing";
  EXPECT_EQ(left, 0) << "voxels should have been taken out";
  ++tally.images;
  tally.islands += carver.camera.has_islands ? 1 : 0;
}

TEST(CarvingExact, EveryVoxelAsTheExactTestSays) {
  const test::RandomRun run = test::random_run(150);
  Tally tally;
  const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  for (std::int64_t n = 0; n < run.count && !testing::Test::HasFailure(); ++n) {
    const test::RandomRun again{run.seed + static_cast<std::uint64_t>(n), 1};
    const std::int64_t target = targets[static_cast<std::size_t>(again.seed) % targets.size()];
    SCOPED_TRACE(again.reproduce() + std::string(", ") + hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    Random random(again.seed);
    compare(random, tally);
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
  std::cout << tally.images << " images, " << tally.islands << " with islands, " << tally.voxels << " voxels, "
            << tally.free << " free\n";
  EXPECT_TRUE((tally.free > tally.voxels / 50 && tally.islands > 5) || run.count < 150);
}

}  // namespace
}  // namespace depthgrid::memory
