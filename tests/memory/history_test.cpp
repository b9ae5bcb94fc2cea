// Since when something may be where, and from where it may have come: against every state that the memory was in.
#include "depthgrid/memory/history.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>
#include <vector>

#include "depthgrid/memory/memory_store.hpp"
#include "memory/random_play.hpp"
#include "memory/small_cell.hpp"
#include "support/random_run.hpp"

namespace depthgrid::memory {
namespace {

using Eigen::Vector3d;
using reference::Random;

struct Voxel {
  int x = 0, y = 0, z = 0;
  friend bool operator==(const Voxel&, const Voxel&) = default;
};

template <class Use>
void for_all(const VoxelSet& set, Use&& use) {
  for (int z = 0; z < set.voxels()[2]; ++z) {
    for (int y = 0; y < set.voxels()[1]; ++y) {
      for (int x = 0; x < set.voxels()[0]; ++x) {
        use(Voxel{x, y, z});
      }
    }
  }
}

struct Tally {
  std::int64_t asked = 0, never = 0, again = 0, not_kept = 0, ruled_out = 0;
  std::int64_t from_unseen = 0, from_border = 0, from_earlier = 0, forgotten = 0, let_in = 0;
};

/// The states of a MemoryTwin, one after the other.
class States {
 public:
  States(const MemoryTwin& twin, const VoxelSet& set) : twin_(twin), set_(set) {}

  [[nodiscard]] bool has(std::size_t step, const Voxel& v) const {
    return twin_.steps()[step].bits[twin_.index(v.x, v.y, v.z)] != 0;
  }
  /// The step in which the voxel came in last, or went out; 0: in none.
  [[nodiscard]] std::size_t last_change(const Voxel& v, bool came_in) const {
    for (std::size_t n = twin_.steps().size() - 1; n > 0; --n) {
      if (has(n, v) == came_in && has(n - 1, v) != came_in) {
        return n;
      }
    }
    return 0;
  }
  /// From which voxels, of any step, what is in `v` from that step on can have come; and over the border.
  [[nodiscard]] std::vector<bool> sources(const Voxel& v, std::size_t step, bool& over_border) const {
    std::vector<bool> now(twin_.steps()[0].bits.size());
    std::vector<bool> ever = now;
    now[twin_.index(v.x, v.y, v.z)] = true;
    for (std::size_t n = step; n > 0; --n) {
      std::vector<bool> before(now.size());
      for_all(set_, [&](const Voxel& u) {
        if (!has(n - 1, u)) {
          return;
        }
        bool leads = now[twin_.index(u.x, u.y, u.z)];
        for (int i = 0; i < 27 && twin_.steps()[n].grown && !leads; ++i) {
          const Voxel to{u.x + i % 3 - 1, u.y + i / 3 % 3 - 1, u.z + i / 9 - 1};
          leads = inside(to) && now[twin_.index(to.x, to.y, to.z)];
        }
        before[twin_.index(u.x, u.y, u.z)] = leads;
        ever[twin_.index(u.x, u.y, u.z)] = ever[twin_.index(u.x, u.y, u.z)] || leads;
      });
      for_all(set_, [&](const Voxel& u) {
        over_border = over_border || (twin_.steps()[n].grown && now[twin_.index(u.x, u.y, u.z)] && at_border(u));
      });
      now = before;
    }
    return ever;
  }
  [[nodiscard]] bool inside(const Voxel& v) const {
    const auto& count = set_.voxels();
    return v.x >= 0 && v.y >= 0 && v.z >= 0 && v.x < count[0] && v.y < count[1] && v.z < count[2];
  }
  [[nodiscard]] bool at_border(const Voxel& v) const {
    const auto& count = set_.voxels();
    return v.x == 0 || v.y == 0 || v.z == 0 || v.x + 1 == count[0] || v.y + 1 == count[1] || v.z + 1 == count[2];
  }

 private:
  const MemoryTwin& twin_;
  const VoxelSet& set_;
};

/// The voxel of the set that is nearest to x, its distance, and that of the next one or of the border.
struct Nearest {
  std::optional<Voxel> voxel;
  double away_m = 1e9, next_m = 1e9, border_m = 1e9;
};

Nearest nearest_of(const VoxelSet& set, const Vector3d& x) {
  Nearest result;
  result.border_m = std::min((x - set.low_world()).minCoeff(), (set.high_world() - x).minCoeff());
  for_all(set, [&](const Voxel& v) {
    if (!set.contains(v.x, v.y, v.z)) {
      return;
    }
    const Vector3d centre = set.centre_world(v.x, v.y, v.z);
    const Vector3d half = Vector3d::Constant(0.5 * set.voxel_m());
    const double away_m = (x - x.cwiseMax(centre - half).cwiseMin(centre + half)).norm();
    if (away_m < result.away_m) {
      result.next_m = result.away_m;
      result.away_m = away_m;
      result.voxel = v;
    } else {
      result.next_m = std::min(result.next_m, away_m);
    }
  });
  return result;
}

void expect_origin(const Past& past, const Voxel& voxel, std::size_t since, const States& states, const VoxelSet& set,
                   Tally& tally) {
  bool over_border = false;
  const std::vector<bool> sources = states.sources(voxel, since, over_border);
  if (past.origin == PastOrigin::not_told) {
    EXPECT_TRUE(past.from_world.hasNaN());
    ++(std::find(sources.begin(), sources.end(), true) != sources.end() || over_border ? tally.forgotten
                                                                                       : tally.let_in);
    return;
  }
  const Vector3d at = (past.from_world - set.low_world()) / set.voxel_m();
  const Voxel from{static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y())),
                   static_cast<int>(std::floor(at.z()))};
  ASSERT_TRUE(states.inside(from));
  const std::size_t n = (static_cast<std::size_t>(from.z) * static_cast<std::size_t>(set.voxels()[1]) +
                         static_cast<std::size_t>(from.y)) *
                            static_cast<std::size_t>(set.voxels()[0]) +
                        static_cast<std::size_t>(from.x);
  EXPECT_TRUE(sources[n] || (from == voxel && past.origin == PastOrigin::not_kept))
      << "nothing can have come from " << past.from_world.transpose();
  if (past.origin == PastOrigin::never_ruled_out) {
    EXPECT_EQ(states.last_change(from, false), 0U);
    EXPECT_TRUE(states.has(0, from));
    ++tally.from_unseen;
  } else if (past.origin == PastOrigin::not_kept) {
    EXPECT_TRUE(over_border && states.at_border(from));
    ++tally.from_border;
  } else {
    ++tally.from_earlier;
  }
}

void expect_past(const MemoryStore& store, const MemoryTwin& twin, const Vector3d& x, double reach_m, double within_m,
                 Tally& tally) {
  const MemorySnapshot memory = store.snapshot();
  const VoxelSet& set = memory.voxels();
  const Nearest nearest = nearest_of(set, x);
  const Past past = store.past(x, within_m);
  constexpr double kBrink = 1e-9;
  const double least_m = std::min(nearest.away_m, std::max(nearest.border_m, 0.0));
  if (std::abs(least_m - reach_m) < kBrink || std::abs(nearest.away_m - nearest.border_m) < kBrink) {
    return;
  }
  ++tally.asked;
  if (least_m > reach_m) {
    EXPECT_EQ(past.state, PastState::ruled_out);
    ++tally.ruled_out;
    return;
  }
  if (nearest.border_m < nearest.away_m) {
    EXPECT_EQ(past.state, PastState::not_kept);
    ++tally.not_kept;
    return;
  }
  if (nearest.next_m - nearest.away_m < kBrink) {
    return;  // either may answer
  }
  const States states(twin, set);
  const std::size_t since = states.last_change(*nearest.voxel, true);
  const std::size_t removed = states.last_change(*nearest.voxel, false);
  if (removed == 0 && states.has(0, *nearest.voxel)) {
    EXPECT_EQ(past.state, PastState::never_ruled_out);
    ++tally.never;
    return;
  }
  ASSERT_EQ(past.state, PastState::possible_again);
  ++tally.again;
  // Steps of one time are told apart.
  const double apart_s = History::kStep_s * static_cast<double>(twin.steps().size());
  EXPECT_NEAR(past.possible_since_s, twin.steps()[since].time_s, apart_s);
  if (removed == 0) {
    EXPECT_TRUE(std::isnan(past.seen_free_s));
  } else {
    EXPECT_NEAR(past.seen_free_s, twin.steps()[removed].time_s, apart_s);
  }
  expect_origin(past, *nearest.voxel, since, states, set, tally);
}

void compare(Random& random, Tally& tally) {
  RandomPlay play(random);
  for (int n = 0; n < 8; ++n) {
    ASSERT_TRUE(play.next(random, {-5, -2})) << play.text();
    const MemorySnapshot memory = play.store.snapshot();
    const Vector3d low = memory.voxels().low_world();
    const Vector3d size = memory.voxels().high_world() - low;
    for (int q = 0; q < 20; ++q) {
      const Vector3d x =
          low + size.cwiseProduct(Vector3d(random.uniform(-0.1, 1.1), random.uniform(0, 1), random.uniform(0, 1)));
      const double within_m = random.chance(0.5) ? 0 : random.uniform(0, 0.1);
      expect_past(play.store, play.twin, x, memory.reach_m(memory.time_s()) + within_m, within_m, tally);
      if (testing::Test::HasFailure()) {
        FAIL() << play.text() << ", asked at " << x.transpose();
      }
    }
  }
}

TEST(History, IsThatOfEveryStateOfTheMemory) {
  const test::RandomRun run = test::random_run(60);
  Tally tally;
  for (std::int64_t n = 0; n < run.count && !testing::Test::HasFailure(); ++n) {
    const test::RandomRun again{run.seed + static_cast<std::uint64_t>(n), 1};
    SCOPED_TRACE(again.reproduce());
    Random random(again.seed);
    compare(random, tally);
  }
  std::cout << tally.asked << " places: " << tally.never << " never ruled out, " << tally.again << " possible again, "
            << tally.not_kept << " not kept, " << tally.ruled_out << " ruled out; something from " << tally.from_unseen
            << " unseen places, over the border " << tally.from_border << ", as far as is remembered "
            << tally.from_earlier << ", put back " << tally.let_in << ", forgotten " << tally.forgotten << "\n";
  EXPECT_TRUE(run.count < 60 || (tally.again > 100 && tally.from_unseen > 20 && tally.from_border > 20));
  EXPECT_LE(tally.forgotten, 5 + tally.again / 10);
}

struct Cell {
  explicit Cell(const MemorySettings& memory = small_memory())
      : views(small_rig(), small_settings(), 4), store(views, memory) {}
  void see(const Wall& wall, double time_s) {
    ASSERT_TRUE(views.update(0, wall.frame(time_s)).taken());
    store.take(0);
  }
  views::ViewStore views;
  MemoryStore store;
};

const Wall kFar(3.0F);
const Wall kHidden(0.5F);

TEST(History, SaysSinceWhenAndFromWhere) {
  Cell cell;
  EXPECT_EQ(cell.store.past({0, 0, 0}, 0.01).state, PastState::not_told) << "no image yet";
  cell.see(kFar, 5);
  EXPECT_EQ(cell.store.past({0, 0, 0}, 0.01).state, PastState::ruled_out);
  EXPECT_EQ(cell.store.past({0.195, 0, 0}, 0.01).state, PastState::not_kept);
  EXPECT_EQ(cell.store.past({0.5, 0, 0}, 0.01).state, PastState::not_kept);
  // Things at 1 m/s need 25 ms for a voxel: the third from the border is reached after 75 ms.
  cell.see(kHidden, 5.12);
  const Past past = cell.store.past({0.14, 0.01, 0.01}, 0);
  EXPECT_EQ(past.state, PastState::possible_again);
  EXPECT_NEAR(past.possible_since_s, 5.075, 0.002);
  EXPECT_NEAR(past.seen_free_s, 5, 0.002);
  EXPECT_EQ(past.origin, PastOrigin::not_kept);
  EXPECT_NEAR(past.from_world.x(), 0.1875, 1e-9);
  EXPECT_NEAR(past.from_m, 0.0475, 0.03);
}

TEST(History, KnowsWhatWasDeclaredFromWhatWasSeen) {
  MemorySettings memory = small_memory();
  memory.start = StartEmpty{};
  Cell cell(memory);
  cell.see(kHidden, 5);
  cell.see(kHidden, 5.06);
  const Past past = cell.store.past({0.19, 0.01, 0.01}, 0);
  EXPECT_EQ(past.state, PastState::possible_again);
  EXPECT_NEAR(past.possible_since_s, 5.025, 0.003);
  EXPECT_TRUE(std::isnan(past.seen_free_s));
}

TEST(History, NamesWhatNobodyHasSeenFree) {
  Cell cell;
  cell.see(Wall(3.0F).put(0, 0, 80, kHeight, 0.5F), 5);
  EXPECT_EQ(cell.store.past({-0.1, 0, 0}, 0).state, PastState::never_ruled_out);
  EXPECT_EQ(cell.store.past({0.1, 0, 0}, 0).state, PastState::ruled_out);
  cell.see(kHidden, 5.06);
  // Half a voxel and its diagonal are not seen free beside the hidden half.
  const Past past = cell.store.past({0.0625, 0.01, 0.01}, 0);
  EXPECT_EQ(past.state, PastState::possible_again);
  EXPECT_EQ(past.origin, PastOrigin::never_ruled_out);
  EXPECT_LE(past.from_world.x(), 0.05);
  EXPECT_LE(past.from_m, 0.06 * std::sqrt(3.0) + 0.025);
}

TEST(History, BeginsAnewWhereTimeDoes) {
  Cell cell;
  cell.see(kFar, 5);
  cell.see(kHidden, 1e6);  // a clock that jumped: everything is possible again
  EXPECT_EQ(cell.store.past({0, 0, 0}, 0).state, PastState::possible_again);
  cell.see(kHidden, 6);
  EXPECT_EQ(cell.store.past({0, 0, 0}, 0).state, PastState::never_ruled_out);
  cell.see(kFar, 6.01);
  cell.see(kHidden, 6.2);
  EXPECT_NEAR(cell.store.past({0.19, 0.01, 0.01}, 0).possible_since_s, 6.035, 0.003);
  // So late that steps cannot be counted any more.
  VoxelSet set(Vector3d::Zero(), Vector3d::Constant(0.4), 0.025);
  History history(set);
  history.note(set, 0, false);
  set.reset(3, 3, 3);
  history.note(set, 1, false);
  set.set(3, 3, 3);
  history.note(set, 1e7, false);
  EXPECT_EQ(history.past(set.centre_world(3, 3, 3), 0).state, PastState::possible_again);
  EXPECT_NEAR(history.past(set.centre_world(3, 3, 3), 0).possible_since_s, 1e7, 0.002);
  EXPECT_EQ(history.past(set.centre_world(4, 3, 3), 0).state, PastState::never_ruled_out);
}

}  // namespace
}  // namespace depthgrid::memory
