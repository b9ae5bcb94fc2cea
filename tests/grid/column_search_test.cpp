// Every instruction set of this machine gives the answers of one cell after the other.
#include "depthgrid/grid/column_search.hpp"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include "reference/random_problem.hpp"
#include "support/random_run.hpp"

namespace depthgrid::grid {
namespace {

/// The same rays behind another type, so that the walk over one cell after the other is taken.
struct PlainRay {
  ClosedFormMap::Ray ray;
  [[nodiscard]] Confirmation confirm(int n, const float* depth_m) const noexcept { return ray.confirm(n, depth_m); }
};

TEST(ColumnSearch, EveryInstructionSetEqualsOneCellAfterTheOther) {
  const test::RandomRun run = test::random_run(3000);
  const PinholeCamera camera{64, 48, 50, 50, 32, 24};
  std::int64_t hits = 0;
  int targets = 0;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    ++targets;
    reference::Random random(run.seed);
    for (std::int64_t i = 0; i < run.count; ++i) {
      const DepthGrid grid(camera, {random.uniform(0.1, 1), random.uniform(0.005, 0.03), 0, random.integer(1, 200)});
      const int count = random.integer(0, 3);
      std::vector<SecondaryCamera> secondaries;
      std::vector<std::vector<float>> images;
      std::vector<const float*> depths_m;
      for (int k = 0; k < count; ++k) {
        const Pose pose = look_at(random.direction() * random.uniform(0.5, 3), random.in_cube(0.3),
                                  Eigen::Vector3d(0.1, 0.9, 0.2).normalized());
        const Pose principal = look_at(Eigen::Vector3d(0, 0, -1.5), Eigen::Vector3d::Zero(), -Eigen::Vector3d::UnitY());
        secondaries.push_back({camera, pose.inverse() * principal});
        images.emplace_back(64 * 48);
        for (float& depth : images.back()) {
          depth = random.chance(0.2) ? 0.0F : static_cast<float>(random.uniform(0.5, 8));
        }
      }
      for (const auto& image : images) {
        depths_m.push_back(image.data());
      }
      const ClosedFormMap map(grid, secondaries);
      const int u = random.integer(0, 63);
      const int v = random.integer(0, 47);
      std::vector<ClosedFormMap::Ray> rays;
      std::vector<PlainRay> plain;
      for (int k = 0; k < count; ++k) {
        rays.push_back(map.ray(u, v, static_cast<std::size_t>(k)));
        plain.push_back({rays.back()});
      }
      const int first = random.integer(0, grid.count() - 1);
      const int last = random.integer(first, grid.count() - 1);
      const int start = random.integer(first, last);
      const ColumnHit slow = search_outwards(std::span<const PlainRay>(plain), depths_m, start, first, last);
      const ColumnHit wide = search_outwards_wide(rays, depths_m, start, first, last);
      const ColumnHit fast = search_outwards(std::span<const ClosedFormMap::Ray>(rays), depths_m, start, first, last);
      for (const ColumnHit& other : {wide, fast}) {
        ASSERT_TRUE(other.j == slow.j && other.beyond == slow.beyond && other.before == slow.before)
            << hwy::TargetName(target) << " case " << i << ", start " << start << " in [" << first << ", " << last
            << "]: j " << other.j << other.beyond << other.before << ", one after the other: " << slow.j << slow.beyond
            << slow.before << "; " << run.reproduce();
      }
      hits += slow.beyond || slow.before ? 1 : 0;
    }
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  EXPECT_GE(targets, 1);
  EXPECT_TRUE(hits > 0 || run.count < 10);
  RecordProperty("targets", targets);
}

}  // namespace
}  // namespace depthgrid::grid
