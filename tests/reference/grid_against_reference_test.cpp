// The corrected evaluation on the depth grid against the oracle: it must never over-estimate. Its obstacle set is made
// of whole cells and contains the exact one, so there is no cell term on that side, only rounding.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include "depthgrid/grid/grid_evaluator.hpp"
#include "reference/random_problem.hpp"
#include "reference/reference.hpp"
#include "support/quantile.hpp"
#include "support/random_run.hpp"

namespace depthgrid::reference {
namespace {

/// Single-precision depths and projections.
constexpr double kRoundingM = 1e-5;

grid::GridEvaluator make_evaluator(const RandomProblem& random, grid::Variant variant = grid::Variant::corrected) {
  grid::EvaluationSettings settings;
  settings.variant = variant;
  settings.outside = random.outside_is_obstacle ? grid::OutsideSpace::obstacle : grid::OutsideSpace::ignored;
  settings.rho_m = random.rho_m;
  settings.sensor = random.sensor;
  settings.pose = random.pose;
  const grid::DepthQuantisation quantisation{random.d_min_m, random.step_m, 0.0, random.cell_count};
  grid::GridEvaluator evaluator(random.rig, random.principal, quantisation, settings);
  (void)update_all(evaluator, random.frames);
  return evaluator;
}

/// How far a point lies outside the grid, which is the principal camera's view between d_min and d_max; negative
/// within.
double outside_m(const RandomProblem& random, const Eigen::Vector3d& p_world) {
  const RigCamera& camera = random.rig.cameras[random.principal];
  const PinholeCamera& c = camera.intrinsics;
  const Eigen::Vector3d p = camera.T_world_camera.inverse() * p_world;
  const double d_max_m = random.d_min_m + random.step_m * random.cell_count;
  const auto beside = [&p](double slope, double coordinate) {
    return (coordinate - slope * p.z()) / std::sqrt(1 + slope * slope);
  };
  return std::max({random.d_min_m - p.z(), p.z() - d_max_m, -beside(-c.cx_px / c.fx_px, p.x()),
                   beside((c.width_px - c.cx_px) / c.fx_px, p.x()), -beside(-c.cy_px / c.fy_px, p.y()),
                   beside((c.height_px - c.cy_px) / c.fy_px, p.y())});
}

TEST(GridAgainstReference, CorrectedNeverOverEstimates) {
  const test::RandomRun run = test::random_run(150);
  std::vector<double> under_m;
  int beyond = 0;
  for (std::int64_t i = 0; i < run.count; ++i) {
    RandomOptions options;
    options.seed = run.seed + static_cast<std::uint64_t>(i);
    options.width_px = 16 + 8 * static_cast<int>(options.seed % 6);
    const RandomProblem random = make_random_problem(options);
    const Reference reference(random.problem());
    const grid::GridEvaluator evaluator = make_evaluator(random);
    for (const Eigen::Vector3d& p_world : random.points_world) {
      const Interval interval = reference.distance(p_world);
      const double answer_m = evaluator.distance(Capsule::point(p_world)).nearest.distance_m;
      ASSERT_LE(answer_m, interval.hi_m.value_or(random.rho_m) + kRoundingM)
          << "problem " << to_line(options) << ", point " << p_world.transpose() << ", interval [" << interval.lo_m
          << ", " << interval.hi_m.value_or(random.rho_m) << "]; again with " << run.reproduce();
      if (interval.hi_m && *interval.hi_m > 0) {
        under_m.push_back(std::max(0.0, interval.lo_m - answer_m));
      } else if (!interval.hi_m) {
        ++beyond;
      }
    }
  }
  ASSERT_FALSE(under_m.empty());
  std::cout << "  under-estimate of " << under_m.size() << " answers: median " << test::quantile(under_m, 0.5)
            << " m, 95 % " << test::quantile(under_m, 0.95) << " m, largest " << test::quantile(under_m, 1.0) << " m; "
            << beyond << " points with nothing within rho\n";
}

// As printed, a nearest point is where (5)-(7) point, which is not in the cell that is meant.
TEST(GridAgainstReference, TheNearestPointLiesInTheGrid) {
  const test::RandomRun run = test::random_run(150);
  for (const grid::Variant variant : {grid::Variant::corrected, grid::Variant::letter}) {
    double largest_m = -1;
    std::int64_t points = 0;
    for (std::int64_t i = 0; i < run.count; ++i) {
      RandomOptions options;
      options.seed = run.seed + static_cast<std::uint64_t>(i);
      options.width_px = 16 + 8 * static_cast<int>(options.seed % 6);
      const RandomProblem random = make_random_problem(options);
      const grid::GridEvaluator evaluator = make_evaluator(random, variant);
      for (const Eigen::Vector3d& p_world : random.points_world) {
        const Proximity nearest = evaluator.distance(Capsule::point(p_world)).nearest;
        if (nearest.state != ProximityState::outside && nearest.nearest_world.allFinite()) {
          ++points;
          largest_m = std::max(largest_m, outside_m(random, nearest.nearest_world));
        }
      }
    }
    std::cout << "  " << (variant == grid::Variant::letter ? "letter" : "corrected") << ": " << points
              << " nearest points, at most " << largest_m << " m outside of the grid\n";
    ASSERT_GT(points, run.count);
    if (variant == grid::Variant::corrected) {
      EXPECT_LE(largest_m, kRoundingM) << "again with " << run.reproduce();
    }
  }
}

}  // namespace
}  // namespace depthgrid::reference
