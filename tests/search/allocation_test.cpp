// From the first frame on nothing allocates: images in, snapshots, questions of every kind.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "search/search_setup.hpp"
#include "support/allocation_guard.hpp"

namespace depthgrid::search {
namespace {

using reference::RandomProblem;
using test::AllocationGuard;

TEST(NoAllocation, FromImageToAnswer) {
  DEPTHGRID_REQUIRE_ALLOCATION_COUNT();
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    reference::RandomOptions options;
    options.seed = seed;
    options.cameras = 3;
    options.width_px = 48;
    options.robot = true;
    options.margins = seed % 2 == 0;
    const RandomProblem problem = reference::make_random_problem(options);
    SearchSetup setup = make_setup(problem, seed < 3 ? SpaceKind::box : SpaceKind::frustum, true);
    if (seed == 4) {
      setup.settings.policies = {views::Policy::ignored, views::Policy::ignored, views::Policy::ignored, 0.05};
    }
    views::ViewStore store(setup.rig, setup.settings);
    Search search;
    std::vector<Capsule> primitives;
    for (const Eigen::Vector3d& p_world : problem.points_world) {
      primitives.push_back(Capsule::point(p_world));
      primitives.push_back(Capsule::sphere(p_world, 0.05));
      primitives.push_back(Capsule{p_world, p_world + Eigen::Vector3d(0.1, 0.2, 0), 0.05});
    }
    primitives.push_back(Capsule::point(Eigen::Vector3d::Constant(100)));
    primitives.push_back(Capsule::point(Eigen::Vector3d::Constant(Proximity::kNaN)));
    std::vector<Answer> answers(primitives.size());
    const Frame unusable;
    Count count;
    const AllocationGuard guard;
    {
      const views::Snapshot empty = store.snapshot();
      search.distances(empty, primitives, answers);
    }
    for (std::size_t k = 0; k < setup.frames.size(); ++k) {
      (void)store.update(k, setup.frames[k]);
      (void)store.update(k, unusable);
      (void)store.update(k, setup.frames[k], problem.rig.cameras[k].T_world_camera);
      (void)store.update(99, setup.frames[k]);
    }
    views::Snapshot snapshot = store.snapshot();
    views::Snapshot other = store.snapshot();
    search.distances(snapshot, primitives, answers);
    search.distances(other, primitives, answers, {.nodes = 10}, &count);
    search.distances(other, primitives, answers, {.time_s = 1e-6}, &count);
    search.hybrid(snapshot, primitives, answers);
    search.hybrid(snapshot, primitives, answers, {.nodes = 50}, &count);
    snapshot = std::move(other);
    EXPECT_EQ(guard.allocations(), 0) << reference::to_line(options);
    EXPECT_GT(count.nodes, 0);
  }
}

}  // namespace
}  // namespace depthgrid::search
