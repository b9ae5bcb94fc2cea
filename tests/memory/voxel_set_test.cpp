// A set of voxels answers as a list of them would, and grows as the distance between cubes says.
#include "depthgrid/memory/voxel_set.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "depthgrid/memory/growth.hpp"
#include "reference/random_problem.hpp"
#include "support/random_run.hpp"

namespace depthgrid::memory {
namespace {

using Eigen::Vector3d;
using reference::Random;

/// As meets() may be too far by.
constexpr double kTooFar = 2e-9;

/// A bool for each voxel.
struct Voxels {
  explicit Voxels(const VoxelSet& set)
      : nx(set.voxels()[0]),
        ny(set.voxels()[1]),
        nz(set.voxels()[2]),
        bits(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny) * static_cast<std::size_t>(nz)) {}

  /// What lies outside is in the set.
  [[nodiscard]] bool at(int x, int y, int z) const {
    return x < 0 || y < 0 || z < 0 || x >= nx || y >= ny || z >= nz || bits[index(x, y, z)];
  }
  [[nodiscard]] std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(ny) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(nx) +
           static_cast<std::size_t>(x);
  }

  int nx, ny, nz;
  std::vector<bool> bits;
};

template <class Use>
void for_all(const Voxels& voxels, Use&& use) {
  for (int z = 0; z < voxels.nz; ++z) {
    for (int y = 0; y < voxels.ny; ++y) {
      for (int x = 0; x < voxels.nx; ++x) {
        use(x, y, z);
      }
    }
  }
}

VoxelSet random_region(Random& random) {
  const Vector3d low = random.in_cube(2);
  const double voxel_m = random.uniform(0.01, 0.1);
  const Vector3d size(random.uniform(0.1, 90), random.uniform(0.1, 20), random.uniform(0.1, 20));
  return VoxelSet(low, low + voxel_m * size, voxel_m);
}

/// Some voxels alone and some boxes full of them; sets some by set(), takes others out.
Voxels fill_at_random(Random& random, VoxelSet& set) {
  Voxels voxels(set);
  set.clear();
  const double share = random.chance(0.3) ? 0.0 : std::exp(random.uniform(-8, 0));
  for_all(voxels, [&](int x, int y, int z) {
    if (random.chance(share)) {
      voxels.bits[voxels.index(x, y, z)] = true;
      set.set(x, y, z);
    }
  });
  for (int n = random.integer(0, 3); n > 0; --n) {
    const int x0 = random.integer(0, voxels.nx - 1);
    const int y0 = random.integer(0, voxels.ny - 1);
    const int z0 = random.integer(0, voxels.nz - 1);
    const bool in = random.chance(0.5);
    for (int z = z0; z < std::min(z0 + 9, voxels.nz); ++z) {
      for (int y = y0; y < std::min(y0 + 9, voxels.ny); ++y) {
        for (int x = x0; x < std::min(x0 + 30, voxels.nx); ++x) {
          voxels.bits[voxels.index(x, y, z)] = in;
          if (in) {
            set.set(x, y, z);
          } else {
            set.reset(x, y, z);
          }
        }
      }
    }
  }
  return voxels;
}

/// From the box to the nearest set voxel, or to what lies outside.
double distance_m(const VoxelSet& set, const Voxels& voxels, const Vector3d& low, const Vector3d& high) {
  double least = std::min({(low - set.low_world()).minCoeff(), (set.high_world() - high).minCoeff()});
  least = std::max(least, 0.0);
  for_all(voxels, [&](int x, int y, int z) {
    if (voxels.at(x, y, z)) {
      const Vector3d from = set.low_world() + set.voxel_m() * Vector3d(x, y, z);
      const Vector3d to = from + Vector3d::Constant(set.voxel_m());
      least = std::min(least, (from - high).cwiseMax(low - to).cwiseMax(0).norm());
    }
  });
  return least;
}

TEST(VoxelSet, MeetsWhatIsWithinReach) {
  const test::RandomRun run = test::random_run(150);
  int met = 0;
  int missed = 0;
  int spared = 0;
  for (std::int64_t n = 0; n < run.count && !testing::Test::HasFailure(); ++n) {
    const test::RandomRun again{run.seed + static_cast<std::uint64_t>(n), 1};
    SCOPED_TRACE(again.reproduce());
    Random random(again.seed);
    VoxelSet set = random_region(random);
    const Voxels voxels = fill_at_random(random, set);
    EXPECT_EQ(set.count(), std::count(voxels.bits.begin(), voxels.bits.end(), true));
    for (int q = 0; q < 20; ++q) {
      const Vector3d size = set.high_world() - set.low_world();
      const Vector3d low =
          set.low_world() +
          Vector3d(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)).cwiseProduct(size);
      const Vector3d high = low + std::exp(random.uniform(-7, 0)) * size.minCoeff() * Vector3d::Ones();
      const double least_m = distance_m(set, voxels, low, high);
      for (const double reach_m : {0.0, 0.5 * least_m, least_m - kTooFar, least_m, least_m + 0.01}) {
        if (reach_m < 0) {
          continue;
        }
        const bool meets = set.meets(low, high, reach_m);
        EXPECT_EQ(meets, reach_m > least_m - kTooFar) << least_m << " m away, reach " << reach_m;
        EXPECT_TRUE(set.may_meet(low, high, reach_m) || !meets);
        met += meets ? 1 : 0;
        missed += meets ? 0 : 1;
        spared += set.may_meet(low, high, reach_m) ? 0 : 1;
      }
    }
  }
  EXPECT_TRUE((met > 500 && missed > 300 && spared > 200) || run.count < 100)
      << met << ", " << missed << ", " << spared;
}

TEST(VoxelSet, SaysThatWhatIsNoNumberMayBeOccupied) {
  VoxelSet set(Vector3d::Zero(), Vector3d::Ones(), 0.1);
  set.clear();
  const Vector3d middle = Vector3d::Constant(0.5);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(set.meets(middle, middle, 0.1));
  EXPECT_TRUE(set.meets(middle, middle, nan));
  EXPECT_TRUE(set.meets(middle, middle, std::numeric_limits<double>::infinity()));
  EXPECT_TRUE(set.meets(Vector3d(0.5, nan, 0.5), middle, 0.1));
  EXPECT_TRUE(set.may_meet(middle, Vector3d(0.5, 0.5, nan), 0.1));
  EXPECT_TRUE(set.may_meet(middle, middle, nan));
}

TEST(VoxelSet, EnlargesItsRegionToWholeBlocks) {
  const VoxelSet set(Vector3d::Zero(), Vector3d(0.11, 0.4, 0.41), 0.1);
  EXPECT_EQ(set.voxels(), (std::array<int, 3>{4, 4, 8}));
  EXPECT_LT((set.high_world() - Vector3d(0.4, 0.4, 0.8)).norm(), 1e-12);
  EXPECT_EQ(set.count(), 4 * 4 * 8);
}

TEST(Growth, AddsEveryNeighbourAndComesInAtTheBorder) {
  const test::RandomRun run = test::random_run(150);
  for (std::int64_t n = 0; n < run.count && !testing::Test::HasFailure(); ++n) {
    const test::RandomRun again{run.seed + static_cast<std::uint64_t>(n), 1};
    SCOPED_TRACE(again.reproduce());
    Random random(again.seed);
    VoxelSet set = random_region(random);
    const Voxels before = fill_at_random(random, set);
    std::vector<Block> scratch(set.voxel_blocks().size());
    dilate(set, scratch);
    set.rebuild();
    for_all(before, [&](int x, int y, int z) {
      bool near = false;
      for (int i = 0; i < 27; ++i) {
        near = near || before.at(x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1);
      }
      EXPECT_EQ(set.contains(x, y, z), near) << x << ", " << y << ", " << z;
    });
    const Voxels after = [&] {
      Voxels voxels(set);
      for_all(voxels, [&](int x, int y, int z) { voxels.bits[voxels.index(x, y, z)] = set.contains(x, y, z); });
      return voxels;
    }();
    const Vector3d somewhere = 0.5 * (set.low_world() + set.high_world());
    const double least_m = distance_m(set, after, somewhere, somewhere);
    EXPECT_FALSE(least_m > kTooFar && set.meets(somewhere, somewhere, least_m - kTooFar));
    EXPECT_TRUE(set.meets(somewhere, somewhere, least_m));
  }
}

/// Whatever was possible before a motion is, moved by no more, possible after it.
TEST(Growth, HoldsWhateverMoves) {
  const test::RandomRun run = test::random_run(300);
  for (std::int64_t n = 0; n < run.count && !testing::Test::HasFailure(); ++n) {
    const test::RandomRun again{run.seed + static_cast<std::uint64_t>(n), 1};
    SCOPED_TRACE(again.reproduce());
    Random random(again.seed);
    PossibleSpace space{.voxels = random_region(random)};
    Voxels voxels = fill_at_random(random, space.voxels);
    std::vector<Block> scratch(space.voxels.voxel_blocks().size());
    const auto set_voxel = std::find(voxels.bits.begin(), voxels.bits.end(), true);
    if (set_voxel == voxels.bits.end()) {
      continue;
    }
    const auto place = static_cast<int>(set_voxel - voxels.bits.begin());
    const Vector3d cell(place % voxels.nx, place / voxels.nx % voxels.ny, place / voxels.nx / voxels.ny);
    Vector3d x =
        space.voxels.low_world() + space.voxels.voxel_m() * (cell + Vector3d::Constant(0.5) + random.in_cube(0.5));
    for (int step = 0; step < 6; ++step) {
      const double motion_m = std::exp(random.uniform(-4, 1)) * space.voxels.voxel_m();
      const bool diagonal = random.chance(0.3);
      x += motion_m * (diagonal ? Vector3d(1, 1, 1).normalized() : random.direction());
      grow(space, motion_m, scratch);
      EXPECT_TRUE(space.voxels.meets(x, x, space.pending_m))
          << "after " << step << " motions, the last by " << motion_m;
      EXPECT_LT(space.pending_m, space.voxels.voxel_m());
    }
  }
}

TEST(Growth, FillsTheRegionFromItsBorder) {
  PossibleSpace space{.voxels = VoxelSet(Vector3d::Zero(), Vector3d::Ones(), 0.05)};
  std::vector<Block> scratch(space.voxels.voxel_blocks().size());
  space.voxels.clear();
  const Vector3d middle = Vector3d::Constant(0.5);
  grow(space, 0.42, scratch);
  EXPECT_FALSE(space.voxels.meets(middle, middle, space.pending_m));
  EXPECT_FALSE(space.is_everything);
  grow(space, 0.09, scratch);
  EXPECT_TRUE(space.voxels.meets(middle, middle, space.pending_m));
  grow(space, std::numeric_limits<double>::infinity(), scratch);
  EXPECT_TRUE(space.is_everything);
  EXPECT_EQ(space.pending_m, 0);
  EXPECT_EQ(space.voxels.count(), 20 * 20 * 20);
}

}  // namespace
}  // namespace depthgrid::memory
