// The memory after any images, in whatever order, is the one that looks at every voxel and every pixel has.
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <iostream>
#include <vector>

#include "memory/random_play.hpp"
#include "support/random_run.hpp"

namespace depthgrid::memory {
namespace {

using reference::Random;

struct Tally {
  std::int64_t images = 0, voxels = 0, carved = 0, put_back = 0, brinks = 0;
};

void expect_same(const MemoryTwin& twin, const VoxelSet& voxels) {
  int more = 0;
  int fewer = 0;
  for (int z = 0; z < voxels.voxels()[2]; ++z) {
    for (int y = 0; y < voxels.voxels()[1]; ++y) {
      for (int x = 0; x < voxels.voxels()[0]; ++x) {
        more += voxels.contains(x, y, z) && !twin.contains(x, y, z) ? 1 : 0;
        fewer += !voxels.contains(x, y, z) && twin.contains(x, y, z) ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(fewer, 0) << "voxels are missing";
  EXPECT_EQ(more, 0) << "voxels should have been taken out";
}

void compare(Random& random, Tally& tally) {
  RandomPlay play(random);
  const MemoryTwin& twin = play.twin;
  for (int n = 0; n < 6; ++n) {
    // After some images nothing comes for long.
    ASSERT_TRUE(play.next(random, {-6, -1.5})) << play.text();
    const MemorySnapshot memory = play.store.snapshot();
    EXPECT_DOUBLE_EQ(memory.reach_m(memory.time_s()), twin.pending_m() + 0.5 * play.cell.memory.thinnest_hidden_m);
    expect_same(twin, memory.voxels());
    if (testing::Test::HasFailure()) {
      FAIL() << play.text();
    }
    tally.voxels += memory.voxels().voxels()[0] * memory.voxels().voxels()[1] * memory.voxels().voxels()[2];
    ++tally.images;
  }
  tally.carved += twin.carved();
  tally.put_back += twin.put_back();
  tally.brinks += twin.brinks();
}

TEST(Carving, IsThatOfEveryVoxelAndEveryPixel) {
  const test::RandomRun run = test::random_run(60);
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
  std::cout << tally.images << " images, " << tally.voxels << " voxels, " << tally.carved << " taken out, "
            << tally.put_back << " put back, " << tally.brinks << " on the brink\n";
  EXPECT_TRUE((tally.carved > tally.voxels / 50 && tally.put_back > 20) || run.count < 60);
  EXPECT_LE(tally.brinks, 1 + tally.voxels / 1000);
}

}  // namespace
}  // namespace depthgrid::memory
