// The fast scans against their slow twins on random problems.
#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

#include "depthgrid/grid/cell_carver.hpp"
#include "depthgrid/grid/grid_evaluator.hpp"
#include "grid/corrected_twin.hpp"
#include "grid/letter_twin.hpp"
#include "reference/random_problem.hpp"
#include "support/random_run.hpp"

namespace depthgrid::grid {
namespace {

using reference::RandomProblem;

std::vector<SecondaryCamera> secondaries_of(const RandomProblem& problem) {
  std::vector<SecondaryCamera> secondaries;
  const Pose& T_world_principal = problem.rig.cameras[problem.principal].T_world_camera;
  for (std::size_t k = 0; k < problem.rig.cameras.size(); ++k) {
    if (k != problem.principal) {
      const RigCamera& camera = problem.rig.cameras[k];
      secondaries.push_back({camera.intrinsics, camera.T_world_camera.inverse() * T_world_principal});
    }
  }
  return secondaries;
}

EvaluationSettings settings_of(const RandomProblem& problem, Variant variant, Collect collect) {
  EvaluationSettings settings;
  settings.variant = variant;
  settings.collect = collect;
  settings.rho_m = problem.rho_m;
  settings.sensor = problem.sensor;
  settings.pose = problem.pose;
  return settings;
}

/// Visits `count` random problems, or a share of DEPTHGRID_TEST_COUNT where each takes long; the seed printed with a
/// failure makes the same problem again.
template <class Check>
void for_random_problems(int count, Check&& check, int divisor = 1) {
  const std::uint64_t first = test::random_run(0).seed;
  count = std::max(1, static_cast<int>(test::random_run(static_cast<std::int64_t>(count) * divisor).count) / divisor);
  for (int i = 0; i < count; ++i) {
    reference::RandomOptions options;
    options.seed = first + static_cast<std::uint64_t>(i);
    const RandomProblem problem = reference::make_random_problem(options);
    SCOPED_TRACE("problem: " + reference::to_line(options));
    check(problem);
    if (::testing::Test::HasFailure()) {
      return;
    }
  }
}

TEST(LetterScan, EqualsTheLetterWordForWord) {
  std::int64_t within_rho = 0;
  for_random_problems(300, [&](const RandomProblem& problem) {
    const DepthGrid grid(problem.rig.cameras[problem.principal].intrinsics, quantisation_of(problem));
    const ClosedFormMap map(grid, secondaries_of(problem));
    const std::vector<Observation> observations = observe(problem, nullptr);
    for (const Window window : {Window::region_of_surveillance, Window::whole_image}) {
      EvaluationSettings settings = settings_of(problem, Variant::letter, Collect::hybrid);
      settings.window = window;
      GridEvaluator evaluator(problem.rig, problem.principal, grid.quantisation(), settings);
      ASSERT_TRUE(update_all(evaluator, problem.frames).taken());
      for (const Eigen::Vector3d& p_world : problem.points_world) {
        const Answer fast = evaluator.distance(Capsule::point(p_world));
        if (fast.nearest.state == ProximityState::outside) {
          continue;
        }
        const twin::Answer slow =
            twin::letter(grid, map, observations, problem.principal, settings, in_principal(problem, p_world));
        EXPECT_NEAR(fast.nearest.distance_m, slow.nearest_m, 1e-12) << p_world.transpose();
        EXPECT_EQ(fast.obstacle_points, slow.count) << p_world.transpose();
        const Eigen::Vector3d mean =
            problem.rig.cameras[problem.principal].T_world_camera.linear() * slow.mean_direction_camera;
        EXPECT_LT((fast.hybrid_direction_world - mean).norm(), 1e-9) << p_world.transpose();
        within_rho += slow.count > 0 ? 1 : 0;
      }
    }
  });
  EXPECT_GT(within_rho, 0);
}

TEST(CorrectedScan, EqualsTheNearestOfAllCells) {
  std::int64_t within_rho = 0;
  for_random_problems(
      30,
      [&](const RandomProblem& problem) {
        const DepthGrid grid(problem.rig.cameras[problem.principal].intrinsics, quantisation_of(problem));
        const std::vector<Observation> observations = observe(problem, &problem.sensor);
        const EvaluationSettings settings = settings_of(problem, Variant::corrected, Collect::minimum);
        GridEvaluator evaluator(problem.rig, problem.principal, grid.quantisation(), settings);
        ASSERT_TRUE(update_all(evaluator, problem.frames).taken());
        for (const Eigen::Vector3d& p_world : problem.points_world) {
          const Answer fast = evaluator.distance(Capsule::point(p_world));
          if (fast.nearest.state == ProximityState::outside) {
            continue;
          }
          const double slow = corrected_twin(problem, grid, observations, settings, in_principal(problem, p_world));
          // A blind zone that ends inside a cell is cut exactly by the scan and kept whole by the twin.
          if (problem.rig.cameras[problem.principal].rule.near_m > problem.d_min_m) {
            EXPECT_LE(slow, fast.nearest.distance_m + 1e-9) << p_world.transpose();
          } else {
            EXPECT_NEAR(fast.nearest.distance_m, slow, 1e-9) << p_world.transpose();
          }
          within_rho += slow < settings.rho_m ? 1 : 0;
        }
      },
      8);
  EXPECT_GT(within_rho, 0);
}

TEST(SmartScan, FindsTheMinimumOfTheWholeScan) {
  for_random_problems(200, [&](const RandomProblem& problem) {
    for (const Variant variant : {Variant::letter, Variant::corrected}) {
      GridEvaluator all(problem.rig, problem.principal, quantisation_of(problem),
                        settings_of(problem, variant, Collect::hybrid));
      GridEvaluator smart(problem.rig, problem.principal, quantisation_of(problem),
                          settings_of(problem, variant, Collect::minimum));
      ASSERT_TRUE(update_all(all, problem.frames).taken());
      ASSERT_TRUE(update_all(smart, problem.frames).taken());
      for (const Eigen::Vector3d& p_world : problem.points_world) {
        EvaluationCount all_count;
        EvaluationCount smart_count;
        const Answer a = all.distance(Capsule::point(p_world), &all_count);
        const Answer b = smart.distance(Capsule::point(p_world), &smart_count);
        ASSERT_EQ(has_distance(a.nearest), has_distance(b.nearest));
        if (has_distance(a.nearest)) {
          EXPECT_NEAR(a.nearest.distance_m, b.nearest.distance_m, 1e-9) << p_world.transpose();
        }
        EXPECT_LE(smart_count.pixels, all_count.pixels);
      }
    }
  });
}

TEST(CorrectedScan, TheWindowOfTheSphereLosesNothing) {
  for_random_problems(100, [&](const RandomProblem& problem) {
    EvaluationSettings settings = settings_of(problem, Variant::corrected, Collect::minimum);
    GridEvaluator window(problem.rig, problem.principal, quantisation_of(problem), settings);
    settings.window = Window::whole_image;
    GridEvaluator image(problem.rig, problem.principal, quantisation_of(problem), settings);
    ASSERT_TRUE(update_all(window, problem.frames).taken());
    ASSERT_TRUE(update_all(image, problem.frames).taken());
    for (const Eigen::Vector3d& p_world : problem.points_world) {
      const Answer a = window.distance(Capsule::point(p_world));
      const Answer b = image.distance(Capsule::point(p_world));
      if (has_distance(a.nearest)) {
        EXPECT_NEAR(a.nearest.distance_m, b.nearest.distance_m, 1e-12) << p_world.transpose();
      }
    }
  });
}

TEST(CorrectedScan, HybridDirectionIsLedByTheNearest) {
  for_random_problems(100, [&](const RandomProblem& problem) {
    EvaluationSettings settings = settings_of(problem, Variant::corrected, Collect::hybrid);
    settings.direction_blend = 1.0;
    GridEvaluator evaluator(problem.rig, problem.principal, quantisation_of(problem), settings);
    ASSERT_TRUE(update_all(evaluator, problem.frames).taken());
    for (const Eigen::Vector3d& p_world : problem.points_world) {
      const Answer answer = evaluator.distance(Capsule::point(p_world));
      if (answer.obstacle_points > 0 && answer.nearest.distance_m > 0) {
        EXPECT_NEAR(answer.hybrid_direction_world.norm(), 1.0, 1e-9);
        EXPECT_GE(answer.hybrid_direction_world.dot(answer.nearest.direction_world), std::sqrt(0.5) - 1e-9);
      }
    }
  });
}

}  // namespace
}  // namespace depthgrid::grid
