// A call that is stopped early holds a lower bound and says so.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <vector>

#include "depthgrid/search/best_first.hpp"
#include "search/one_camera.hpp"
#include "search/search_setup.hpp"
#include "support/ticking_clock.hpp"

namespace depthgrid::search {
namespace {

using Eigen::Vector3d;
using reference::Random;
using reference::RandomProblem;

TEST(Budget, OfMoreNodesGivesALargerBoundUpToTheWholeAnswer) {
  int stopped = 0;
  int raised = 0;
  for_random_problems(60, {}, [&](const RandomProblem& problem, Random& random) {
    const SearchSetup setup = make_setup(problem, random.chance(0.5) ? SpaceKind::box : SpaceKind::frustum, true);
    Asker asker(setup);
    for (const Vector3d& p_world : problem.points_world) {
      const Capsule primitive =
          random.chance(0.5) ? Capsule::point(p_world) : Capsule::sphere(p_world, random.uniform(0, 0.05));
      const Proximity whole = asker.distance(primitive).nearest;
      EXPECT_FALSE(whole.budget);
      double before_m = 0;
      bool finished = false;
      for (std::int64_t nodes = 1; nodes <= (std::int64_t{1} << 40); nodes = nodes < 40 ? nodes + 1 : nodes * 2) {
        const Proximity part = asker.distance(primitive, {.nodes = nodes}).nearest;
        ASSERT_FALSE(std::isnan(part.distance_m)) << nodes << " nodes";
        EXPECT_GE(part.distance_m, before_m) << nodes << " nodes";
        EXPECT_LE(part.distance_m, whole.distance_m) << nodes << " nodes";
        EXPECT_TRUE(part.budget || part.distance_m == whole.distance_m) << nodes << " nodes";
        EXPECT_TRUE(part.budget || part.state == whole.state) << nodes << " nodes";
        EXPECT_TRUE(part.budget || !finished || part.state == whole.state) << nodes << " nodes";
        EXPECT_FALSE(part.budget && finished) << "fewer nodes than " << nodes << " were enough";
        finished = !part.budget;
        stopped += part.budget ? 1 : 0;
        raised += part.distance_m > before_m && part.budget ? 1 : 0;
        before_m = part.distance_m;
      }
      EXPECT_TRUE(finished);
    }
  });
  EXPECT_GT(stopped, 0) << "no budget ran out";
  EXPECT_GT(raised, 0) << "no bound of a stopped search was above zero";
}

TEST(Budget, IsSharedByThePrimitivesOfACall) {
  std::int64_t opened = 0;
  for_random_problems(60, {}, [&](const RandomProblem& problem, Random& random) {
    const SearchSetup setup = make_setup(problem, SpaceKind::box, true);
    Asker asker(setup);
    std::vector<Capsule> primitives;
    for (int i = 0; i < 9; ++i) {
      primitives.push_back(Capsule::sphere(random.in_cube(0.6), random.uniform(0, 0.05)));
    }
    std::vector<Answer> whole(primitives.size());
    std::vector<Answer> part(primitives.size());
    Count all;
    asker.search().distances(asker.snapshot(), primitives, whole, {}, &all);
    opened += all.nodes;
    for (const std::int64_t nodes : {std::int64_t{1}, all.nodes / 8, all.nodes / 2}) {
      asker.search().distances(asker.snapshot(), primitives, part, {.nodes = std::max<std::int64_t>(nodes, 1)});
      bool stopped = false;
      for (std::size_t i = 0; i < part.size(); ++i) {
        ASSERT_FALSE(std::isnan(part[i].nearest.distance_m)) << "primitive " << i;
        EXPECT_LE(part[i].nearest.distance_m, whole[i].nearest.distance_m) << "primitive " << i;
        EXPECT_TRUE(part[i].nearest.budget || part[i].nearest.distance_m == whole[i].nearest.distance_m) << i;
        stopped = stopped || part[i].nearest.budget;
      }
      EXPECT_TRUE(stopped || all.nodes <= nodes) << nodes << " of " << all.nodes << " nodes";
    }
  });
  EXPECT_GT(opened, 0);
}

using Ask = void (Search::*)(const views::Snapshot&, std::span<const Capsule>, std::span<Answer>, const Budget&,
                             Count*) noexcept;

/// Before a wall, and so far apart that they hardly share a cube.
struct Scattered {
  OneCamera one{2.0F};
  std::vector<Capsule> primitives;

  Scattered() {
    one.setup.settings.rho_m = 0.5;
    one.setup.settings.policies.outside = views::Policy::ignored;
    for (int i = 0; i < 16; ++i) {
      primitives.push_back(Capsule::point({-0.45 + 0.3 * (i % 4), -0.3 + 0.2 * (i / 4), 1.6}));
    }
  }
};

// Asked by one that knows nothing yet: cubes that are known are paid for, but not counted.
TEST(Budget, IsNotGivenAnewToEveryPrimitive) {
  const Scattered scattered;
  const Asker asker(scattered.one.setup);
  const std::vector<Capsule>& primitives = scattered.primitives;
  std::vector<Answer> answers(primitives.size());
  const auto opened = [&](auto&& ask, const Budget& budget) {
    Search search;
    Count count;
    (search.*ask)(asker.snapshot(), primitives, answers, budget, &count);
    return count.nodes;
  };
  for (const Ask ask : {Ask(&Search::distances), Ask(&Search::hybrid)}) {
    const std::int64_t all = opened(ask, {});
    for (const std::int64_t nodes : {all / 8, all / 3}) {
      const std::int64_t spent = opened(ask, {.nodes = nodes});
      EXPECT_LE(spent, nodes) << "of " << all;
      EXPECT_GT(spent, nodes / 4) << "of " << all;
      EXPECT_TRUE(answers.back().nearest.budget);
    }
  }
}

// A millisecond passes whenever the clock is read: once at the beginning, then until the time is over and not again.
TEST(Budget, OfTimeIsNotGivenAnewToEveryPrimitive) {
  const Scattered scattered;
  const Asker asker(scattered.one.setup);
  std::vector<Answer> answers(scattered.primitives.size());
  for (const Ask ask : {Ask(&Search::distances), Ask(&Search::hybrid)}) {
    for (const int ticks : {1, 80, 320}) {
      Search search;
      const test::TickingClock clock(std::chrono::milliseconds(1));
      (search.*ask)(asker.snapshot(), scattered.primitives, answers, {.time_s = 1e-3 * ticks}, nullptr);
      EXPECT_EQ(clock.reads(), 1 + ticks);
      EXPECT_EQ(answers.front().nearest.budget, ticks == 1) << "for the first ones there is time";
      EXPECT_TRUE(answers.back().nearest.budget);
    }
  }
}

// From the nearest cube for which there was no room on nothing is known.
TEST(Budget, AFullFrontierGivesALowerBound) {
  int stopped = 0;
  int raised = 0;
  for_random_problems(40, {}, [&](const RandomProblem& problem, Random&) {
    const SearchSetup setup = make_setup(problem, SpaceKind::box, true);
    const Asker asker(setup);
    VerdictTree tree(1U << 14U);
    (void)tree.aim(asker.snapshot(), nullptr);
    for (const Vector3d& p_world : problem.points_world) {
      const Question question(tree.query(), Capsule::point(p_world), setup.settings.rho_m);
      const auto nearest = [&](std::size_t capacity) {
        Frontier frontier(capacity);
        RemainingBudget unlimited;
        unlimited.give(std::numeric_limits<std::int64_t>::max());
        Count count;
        return find_nearest(tree, frontier, question, unlimited, count);
      };
      const Nearest whole = nearest(1U << 15U);
      EXPECT_FALSE(whole.stopped);
      for (const std::size_t capacity : {1, 2, 4, 8, 16, 64, 256}) {
        const Nearest part = nearest(capacity);
        EXPECT_LE(part.distance_m, whole.distance_m) << "room for " << capacity;
        EXPECT_TRUE(part.stopped || part.distance_m == whole.distance_m) << "room for " << capacity;
        stopped += part.stopped ? 1 : 0;
        raised += part.stopped && part.distance_m > 0 ? 1 : 0;
      }
    }
  });
  EXPECT_GT(stopped, 0) << "there was always room";
  EXPECT_GT(raised, 0) << "no bound was above zero";
}

TEST(Budget, OfTimeGivesALowerBound) {
  int stopped = 0;
  for_random_problems(60, {}, [&](const RandomProblem& problem, Random&) {
    Asker asker(make_setup(problem, SpaceKind::box, true));
    for (const Vector3d& p_world : problem.points_world) {
      const Proximity whole = asker.distance(Capsule::point(p_world)).nearest;
      for (const double time_s : {1e-12, 1e-6, 1e-5, 1e-4}) {
        const Proximity part = asker.distance(Capsule::point(p_world), {.time_s = time_s}).nearest;
        ASSERT_FALSE(std::isnan(part.distance_m)) << time_s << " s";
        EXPECT_LE(part.distance_m, whole.distance_m) << time_s << " s";
        EXPECT_TRUE(part.budget || part.distance_m == whole.distance_m) << time_s << " s";
        stopped += part.budget ? 1 : 0;
      }
    }
  });
  EXPECT_GT(stopped, 0) << "a picosecond was always enough";
}

TEST(Budget, OfTimeThatIsOverOpensNothingHoweverManyPrimitivesThereAre) {
  for_random_problems(20, {}, [](const RandomProblem& problem, Random&) {
    Asker asker(make_setup(problem, SpaceKind::box, true));
    std::vector<Capsule> primitives;
    for (int copy = 0; copy < 20; ++copy) {
      for (const Vector3d& p_world : problem.points_world) {
        primitives.push_back(Capsule::point(p_world));
      }
    }
    std::vector<Answer> answers(primitives.size());
    Count count;
    asker.search().distances(asker.snapshot(), primitives, answers, Budget{.time_s = 1e-9}, &count);
    EXPECT_EQ(count.nodes, 0);
    asker.search().hybrid(asker.snapshot(), primitives, answers, Budget{.time_s = 1e-9}, &count);
    EXPECT_EQ(count.nodes, 0);
  });
}

}  // namespace
}  // namespace depthgrid::search
