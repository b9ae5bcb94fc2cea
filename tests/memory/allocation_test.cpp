// From the first image on nothing allocates: images in, snapshots, what is put in.
#include <gtest/gtest.h>

#include "depthgrid/memory/memory_store.hpp"
#include "depthgrid/memory/voxel_set.hpp"
#include "memory/small_cell.hpp"
#include "support/allocation_guard.hpp"

namespace depthgrid::memory {
namespace {

TEST(NoAllocation, FromImageToMemory) {
  DEPTHGRID_REQUIRE_ALLOCATION_COUNT();
  views::ViewStore views(small_rig(2), small_settings(2));
  MemoryStore store(views, small_memory());
  const Wall far(3.0F);
  const Wall near = Wall(3.0F).put(30, 30, 120, 100, 1.0F);
  const Capsule held{{0, 0, -0.05}, {0, 0, 0.05}, 0.03};
  const test::AllocationGuard guard;
  for (int n = 0; n < 10; ++n) {
    const Wall& wall = n % 3 == 0 ? far : near;
    for (std::size_t k = 0; k < 2; ++k) {
      ASSERT_TRUE(views.update(k, wall.frame(0.03 * n + 0.01 * static_cast<double>(k))).taken());
      store.take(k);
    }
    MemorySnapshot snapshot = store.snapshot();
    snapshot = store.snapshot();
    EXPECT_TRUE(snapshot.voxels().count() >= 0 && snapshot.reach_m(0.03 * n) >= 0);
    EXPECT_GE(snapshot.impossible().images, 0);
    EXPECT_NE(store.past({0, 0, 0.15}, 0.1).state, PastState::not_told);
    EXPECT_TRUE(store.occupy({&held, 1}, 0.01, 0.03 * n));
  }
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_GT(store.count().impossible, 0);
}

}  // namespace
}  // namespace depthgrid::memory
