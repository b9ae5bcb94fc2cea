// Images arrive while others ask: what a snapshot of the memory shows is whole, and stays as it is.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <iostream>
#include <thread>

#include "depthgrid/memory/memory_store.hpp"
#include "depthgrid/memory/voxel_set.hpp"
#include "memory/small_cell.hpp"
#include "support/allocation_guard.hpp"
#include "support/random_run.hpp"

namespace depthgrid::memory {
namespace {

constexpr std::size_t kCameras = 3;
constexpr int kReaders = 3;

/// Voxels, and whether the pyramid over them is theirs.
struct Content {
  explicit Content(const MemorySnapshot& memory) {
    const VoxelSet& set = memory.voxels();
    voxels = set.count();
    VoxelSet again = set;
    again.rebuild();
    for (int level = 1; level < VoxelSet::kLevels; ++level) {
      const std::array<int, 3>& blocks = set.blocks(level);
      for (int z = 0; z < blocks[2]; ++z) {
        for (int y = 0; y < blocks[1]; ++y) {
          for (int x = 0; x < blocks[0]; ++x) {
            whole = whole && set.block(level, x, y, z) == again.block(level, x, y, z);
          }
        }
      }
    }
    reach_m = memory.reach_m(memory.time_s());
  }
  friend bool operator==(const Content& a, const Content& b) {
    return a.voxels == b.voxels && a.whole == b.whole && (a.reach_m == b.reach_m);
  }

  std::int64_t voxels = 0;
  double reach_m = 0;
  bool whole = true;
};

struct Tally {
  std::int64_t broken = 0;     ///< snapshots whose pyramid is that of other voxels
  std::int64_t backwards = 0;  ///< snapshots older than the one before
  std::int64_t changed = 0;    ///< snapshots that were overwritten while held
  std::int64_t odd = 0;        ///< places that are possible since no time
};

void read(const MemoryStore& store, const std::atomic<bool>& stop, std::atomic<std::int64_t>& taken, Tally& tally) {
  std::uint64_t newest = 0;
  while (!stop.load()) {
    const Past past = store.past({0.1, 0.1, 0.1}, 0.03);
    tally.odd += past.state == PastState::possible_again && !(past.possible_since_s >= 0) ? 1 : 0;
    const MemorySnapshot snapshot = store.snapshot();
    const Content content(snapshot);
    tally.broken += content.whole ? 0 : 1;
    tally.backwards += snapshot.version() < newest ? 1 : 0;
    newest = snapshot.version();
    std::this_thread::yield();
    tally.changed += Content(snapshot) == content ? 0 : 1;
    ++taken;
  }
}

TEST(MemoryStoreThreads, SnapshotsAreWholeWhileImagesArrive) {
  const std::int64_t images = std::max<std::int64_t>(test::random_run(3000).count, 300);
  views::ViewStore views(small_rig(kCameras), small_settings(kCameras), 4);
  MemoryStore store(views, small_memory(), kReaders);
  std::atomic<bool> stop = false;
  std::atomic<std::int64_t> taken = 0;
  std::array<Tally, kReaders> tallies;
  std::array<std::int64_t, kCameras> allocations{};
  std::array<std::int64_t, kCameras> sent{};
  std::vector<std::thread> readers;
  readers.reserve(kReaders);
  for (Tally& tally : tallies) {
    readers.emplace_back([&store, &stop, &taken, &tally] { read(store, stop, taken, tally); });
  }
  std::vector<std::thread> writers;
  writers.reserve(kCameras);
  for (std::size_t k = 0; k < kCameras; ++k) {
    writers.emplace_back([&, k] {
      const std::array<Wall, 3> walls{Wall(3.0F), Wall(0.5F), Wall(3.0F).put(30, 30, 120, 100, 1.0F)};
      const Capsule held{{0, 0, -0.05}, {0, 0, 0.05}, 0.03};
      const test::AllocationGuard guard;
      for (int n = 1; n <= images || (taken < images / 10 && n < 1'000'000); ++n) {
        if (views.update(k, walls[static_cast<std::size_t>(n) % 3].frame(0.02 * n)).taken()) {
          store.take(k);
          ++sent[k];
        }
        if (n % 16 == 0) {
          static_cast<void>(store.occupy({&held, 1}, 0.01, 0));
        }
      }
      allocations[k] = guard.allocations();
    });
  }
  for (std::thread& writer : writers) {
    writer.join();
  }
  stop = true;
  for (std::thread& reader : readers) {
    reader.join();
  }
  for (const Tally& tally : tallies) {
    EXPECT_EQ(tally.odd, 0);
    EXPECT_EQ(tally.broken, 0);
    EXPECT_EQ(tally.backwards, 0);
    EXPECT_EQ(tally.changed, 0);
  }
  EXPECT_GT(taken.load(), 0);
  if (test::AllocationGuard::available()) {
    EXPECT_EQ(allocations, (std::array<std::int64_t, kCameras>{}));
  }
  // Every image was looked at, replaced by a newer one, or is the last of its camera and waits.
  const MemoryCount count = store.count();
  const std::int64_t all = sent[0] + sent[1] + sent[2];
  EXPECT_LE(count.images + count.dropped, all + static_cast<std::int64_t>(kCameras));
  EXPECT_GT(count.images, all / 10);
  std::cout << taken << " snapshots, " << count.images << " images, " << count.dropped << " dropped\n";
}

}  // namespace
}  // namespace depthgrid::memory
