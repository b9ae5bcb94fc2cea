// With a memory the search answers for what is neither free now nor ruled out by it: never less than without, never
// more than the distance to any point of that set, and its nearest point lies in it to the resolution.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iostream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "depthgrid/memory/voxel_set.hpp"
#include "depthgrid/search/asking_thread.hpp"
#include "depthgrid/search/search.hpp"
#include "depthgrid/search/search_evaluator.hpp"
#include "memory/memory_twin.hpp"
#include "memory/random_cell.hpp"
#include "memory/small_cell.hpp"
#include "support/random_run.hpp"

namespace depthgrid::memory {
namespace {

using Eigen::Vector3d;
using reference::Random;

constexpr double kBrink = 1e-7;

/// From a point to the nearest set voxel, or to what lies outside of the region.
double distance_to_set_m(const VoxelSet& set, const Vector3d& x) {
  double least = std::max(std::min((x - set.low_world()).minCoeff(), (set.high_world() - x).minCoeff()), 0.0);
  for (int k = 0; k < set.voxels()[2]; ++k) {
    for (int j = 0; j < set.voxels()[1]; ++j) {
      for (int i = 0; i < set.voxels()[0]; ++i) {
        if (set.contains(i, j, k)) {
          const Vector3d half = Vector3d::Constant(0.5 * set.voxel_m());
          const Vector3d centre = set.centre_world(i, j, k);
          least = std::min(least, (x - x.cwiseMax(centre - half).cwiseMin(centre + half)).norm());
        }
      }
    }
  }
  return least;
}

struct Seen {
  const views::Snapshot& snapshot;
  const MemorySnapshot& memory;

  /// By how much a point is in what is not free to every camera and in what the memory holds possible: not at all when
  /// negative.
  [[nodiscard]] double depth_in_obstacle_m(const Vector3d& x_world) const {
    double depth_m = memory.reach_m(snapshot.reference_time_s()) - distance_to_set_m(memory.voxels(), x_world);
    for (std::size_t k = 0; k < snapshot.camera_count(); ++k) {
      const Pose& T = snapshot.T_world_camera(k);
      const Vector3d p = T.linear().transpose() * (x_world - T.translation());
      const PoseMargin& e = snapshot.pose_margin(k);
      const double e_m = e.translation_m + e.time_m + e.rotation_rad * p.norm();
      depth_m = std::min(depth_m, e_m - distance_to_not_free_m(snapshot.view(k), snapshot.camera(k), p));
    }
    return depth_m;
  }
};

Capsule random_capsule(const VoxelSet& set, Random& random) {
  const Vector3d middle = 0.5 * (set.low_world() + set.high_world());
  const double half_m = 0.7 * (set.high_world() - set.low_world()).maxCoeff();
  const Vector3d a = middle + random.in_cube(half_m);
  return random.chance(0.5) ? Capsule::point(a) : Capsule{a, a + random.in_cube(0.3), random.uniform(0, 0.05)};
}

struct Tally {
  std::int64_t asked = 0, farther = 0, inside = 0, nearest = 0;
};

void check(Random& random, Tally& tally) {
  RandomCell cell(random);
  if (random.chance(0.7)) {  // what was seen free remains so for some images
    cell.settings.v_max_m_s = random.uniform(0, 0.3);
    cell.memory.high_world = cell.memory.low_world + 16 * cell.memory.voxel_m * Vector3d::Ones();
  }
  views::ViewStore views(cell.rig, cell.settings);
  MemoryStore store(views, cell.memory);
  std::optional<MemorySnapshot> before;
  double time_s = 10;
  for (int n = 0; n < 8; ++n) {
    const auto camera = static_cast<std::size_t>(random.integer(0, static_cast<int>(cell.rig.cameras.size()) - 1));
    time_s += std::exp(random.uniform(-7, -3));
    const RandomImage image(cell, camera, time_s, random);
    before.emplace(store.snapshot());
    ASSERT_TRUE(views.update(camera, image.frame(), image.T_world_camera()).taken());
    store.take(camera);
  }
  const views::Snapshot snapshot = views.snapshot();
  const MemorySnapshot newest = store.snapshot();
  search::Search shared;
  for (const MemorySnapshot* memory : std::array<const MemorySnapshot*, 2>{&*before, &newest}) {
    const Seen seen{snapshot, *memory};
    std::vector<Capsule> capsules;
    for (int n = 0; n < 6; ++n) {
      capsules.push_back(random_capsule(memory->voxels(), random));
    }
    std::vector<Answer> without(capsules.size());
    std::vector<Answer> with(capsules.size());
    std::vector<Answer> again(capsules.size());
    search::Search alone;
    alone.distances(snapshot, *memory, capsules, again);
    shared.distances(snapshot, capsules, without);
    shared.distances(snapshot, *memory, capsules, with);
    for (std::size_t i = 0; i < capsules.size(); ++i) {
      const Proximity& answer = with[i].nearest;
      EXPECT_EQ(answer.state, again[i].nearest.state);
      EXPECT_TRUE(answer.distance_m == again[i].nearest.distance_m || std::isnan(answer.distance_m));
      EXPECT_FALSE(answer.distance_m < without[i].nearest.distance_m);
      tally.farther += answer.distance_m > without[i].nearest.distance_m + 0.01 ? 1 : 0;
      ++tally.asked;
      if (answer.state == ProximityState::beyond_rho || answer.state == ProximityState::outside) {
        continue;
      }
      ++tally.nearest;
      EXPECT_GE(seen.depth_in_obstacle_m(answer.nearest_world), -cell.settings.resolution_m - kBrink);
    }
    for (int n = 0; n < 150; ++n) {
      const Capsule& capsule = capsules[static_cast<std::size_t>(random.integer(0, 5))];
      const Vector3d x = capsule.a + std::exp(random.uniform(-4, -1)) * random.direction();
      if (x.cwiseAbs().maxCoeff() > 1.5 || !(seen.depth_in_obstacle_m(x) > kBrink)) {
        continue;
      }
      ++tally.inside;
      for (std::size_t i = 0; i < capsules.size(); ++i) {
        const double distance_m = distance_to_axis(capsules[i], x) - capsules[i].radius_m;
        EXPECT_FALSE(with[i].nearest.distance_m > std::max(distance_m, 0.0))
            << "something may be at " << x.transpose() << ", " << distance_m << " m away";
      }
    }
  }
}

TEST(SearchWithMemory, AnswersForWhatNeitherRulesOut) {
  const test::RandomRun run = test::random_run(60);
  Tally tally;
  for (std::int64_t n = 0; n < run.count && !testing::Test::HasFailure(); ++n) {
    const test::RandomRun again{run.seed + static_cast<std::uint64_t>(n), 1};
    SCOPED_TRACE(again.reproduce());
    Random random(again.seed);
    check(random, tally);
  }
  std::cout << tally.asked << " answers, " << tally.farther << " farther than without memory, " << tally.nearest
            << " nearest points, " << tally.inside << " places where something may be\n";
  EXPECT_TRUE((tally.farther > 20 && tally.nearest > 100 && tally.inside > 500) || run.count < 60);
}

TEST(SearchWithMemory, IsASettingOfTheEvaluator) {
  search::EvaluatorOptions options;
  options.memory = small_memory();
  search::SearchEvaluator with(small_rig(), small_settings(), options);
  search::SearchEvaluator without(small_rig(), small_settings());
  ASSERT_NE(with.memory(), nullptr);
  EXPECT_EQ(without.memory(), nullptr);
  const Capsule middle = Capsule::point(Vector3d::Zero());
  EXPECT_EQ(with.distance(middle).nearest.distance_m, 0);
  for (search::SearchEvaluator* evaluator : {&with, &without}) {
    ASSERT_TRUE(evaluator->update(0, Wall(3.0F).frame(1)).taken());
    ASSERT_TRUE(evaluator->update(0, Wall(0.5F).frame(1.05)).taken());
  }
  EXPECT_EQ(without.distance(middle).nearest.distance_m, 0);
  // From the border, two voxels grown: 0.2 m less 0.05 m.
  EXPECT_NEAR(with.distance(middle).nearest.distance_m, 0.15, 0.006);
  EXPECT_NEAR(with.distance(middle, 1.06).distance_now_m, 0.14, 0.006);
  std::array<Answer, 2> answers;
  const std::array<Capsule, 2> capsules{middle, Capsule::sphere({0.05, 0, 0}, 0.02)};
  options.directions = 1;
  search::SearchEvaluator directed(small_rig(), small_settings(), options);
  ASSERT_TRUE(directed.update(0, Wall(3.0F).frame(1)).taken());
  ASSERT_TRUE(directed.update(0, Wall(0.5F).frame(1.05)).taken());
  directed.evaluate(capsules, 1.05, answers);
  EXPECT_NEAR(answers[0].nearest.distance_m, 0.15, 0.006);
  EXPECT_NEAR(answers[1].nearest.distance_m, 0.08, 0.006);
}

/// A surface that comes through seen space, in one step: at 1 m/s and, declared as that fast, at 20 m/s.
TEST(SearchEvaluator, SaysWhatItsMemoryHeldImpossible) {
  const Wall surface = Wall(3.0F).put(70, 50, 90, 70, 1.0F);
  const Capsule middle = Capsule::point(Vector3d::Zero());
  search::EvaluatorOptions options;
  options.memory = small_memory();
  search::SearchEvaluator wrong(small_rig(), small_settings(), options);
  search::SearchEvaluator right(small_rig(), small_settings(1, 20), options);
  for (search::SearchEvaluator* evaluator : {&wrong, &right}) {
    ASSERT_TRUE(evaluator->update(0, Wall(3.0F).frame(1)).taken());
    (void)evaluator->distance(middle);
    EXPECT_EQ(evaluator->impossible().images, 0);
    ASSERT_TRUE(evaluator->update(0, surface.frame(1.02)).taken());
    EXPECT_EQ(evaluator->impossible().images, 0) << "as of the newest answers";
    EXPECT_LE(evaluator->distance(middle).nearest.distance_m, 0.02) << "it counts all the same";
  }
  EXPECT_EQ(wrong.impossible().images, 1);
  EXPECT_EQ(wrong.impossible().time_s, 1.02);
  EXPECT_EQ(right.impossible().images, 0);
  std::array<char, 240> text{};
  const std::string sentence(describe(wrong.impossible(), text));
  EXPECT_TRUE(sentence.starts_with("1 image shows a surface where nothing could be, last at ")) << sentence;
  EXPECT_TRUE(
      sentence.ends_with("m (camera 0): v_max is too low, a calibration or a clock is wrong, or something fell"))
      << sentence;
  EXPECT_EQ(describe(right.impossible(), text), "");
  search::AskingThread asking(wrong, {.period_s = 1e-4, .max_age_s = 10});
  EXPECT_EQ(asking.impossible().images, 0) << "there is no answer yet";
  Answer answer;
  for (int i = 0; i < 100000 && answer.nearest.state == ProximityState::not_evaluated; ++i) {
    asking.evaluate({&middle, 1}, 1.02, {&answer, 1});
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  EXPECT_EQ(asking.impossible().images, 1);
  // A place in the shadow of the surface, which is remembered to have been free.
  Proximity hidden = answer.nearest;
  hidden.state = ProximityState::occluded;
  EXPECT_NE(asking.past(hidden).state, PastState::not_told);
  EXPECT_EQ(asking.past(hidden).state, wrong.past(hidden).state);
}

}  // namespace
}  // namespace depthgrid::memory
