// The hybrid direction: the nearest obstacle leads, the others only turn it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>
#include <vector>

#include "depthgrid/grid/grid_evaluator.hpp"
#include "depthgrid/simulation/scene.hpp"
#include "search/search_setup.hpp"
#include "support/quantile.hpp"

namespace depthgrid::search {
namespace {

using Eigen::Vector3d;
using reference::Random;
using reference::RandomProblem;
using reference::Reference;
using test::quantile;

double degrees(double radians) { return radians * 180 / std::numbers::pi; }
double angle_between(const Vector3d& a, const Vector3d& b) { return std::acos(std::clamp(a.dot(b), -1.0, 1.0)); }

/// The mean of the unit vectors from a capsule's axis to the obstacle space within rho of its surface, weighted by v(D)
/// of the distance to the surface; by random points.
Vector3d mean_direction(const Reference& oracle, const views::Settings& settings, const Capsule& capsule,
                        Random& random, int samples) {
  const Vector3d middle = 0.5 * (capsule.a + capsule.b);
  const double half_m = 0.5 * (capsule.b - capsule.a).norm() + capsule.radius_m + settings.rho_m;
  Vector3d sum = Vector3d::Zero();
  double total = 0;
  for (int i = 0; i < samples; ++i) {
    const Vector3d x = middle + random.in_cube(half_m);
    const Vector3d from_axis = x - nearest_on_axis(capsule, x);
    const double to_axis_m = from_axis.norm();
    const double distance_m = to_axis_m - capsule.radius_m;
    if (distance_m < settings.rho_m && to_axis_m > 0 && oracle.in_space(x) && oracle.is_obstacle(x)) {
      const double weight = 1 / (1 + std::exp((2 * distance_m / settings.rho_m - 1) * settings.repulsion_alpha));
      sum += weight / to_axis_m * from_axis;
      total += weight;
    }
  }
  return total > 0 ? (sum / total).eval() : Vector3d::Zero();
}

Vector3d led(const Vector3d& n, const Vector3d& t, double blend) {
  return (n + blend * (t - t.dot(n) * n)).normalized();
}

TEST(HybridDirection, IsOfUnitLengthAndLedByTheNearest) {
  int told = 0;
  int turned = 0;
  for_random_problems(100, {}, [&](const RandomProblem& problem, Random& random) {
    SearchSetup setup = make_setup(problem, random.chance(0.5) ? SpaceKind::box : SpaceKind::frustum, true);
    setup.settings.direction_blend = random.chance(0.3) ? 1.0 : random.uniform(0, 1);
    Asker asker(setup);
    for (const Vector3d& p_world : problem.points_world) {
      const Capsule primitive = random.chance(0.5)
                                    ? Capsule::sphere(p_world, random.uniform(0, 0.05))
                                    : Capsule{p_world, p_world + random.in_cube(0.1), random.uniform(0, 0.05)};
      const Answer answer = asker.hybrid(primitive);
      const Proximity alone = asker.distance(primitive).nearest;
      EXPECT_EQ(answer.nearest.distance_m, alone.distance_m);
      EXPECT_EQ(answer.nearest.state, alone.state);
      const Vector3d& v = answer.hybrid_direction_world;
      if (!(alone.distance_m > 0 && alone.distance_m < setup.settings.rho_m)) {
        EXPECT_TRUE(v.isZero()) << "nothing within rho, or touching: " << v.transpose();
        continue;
      }
      // The part of t across n is at most 1 long.
      const double least = 1 / std::hypot(1, setup.settings.direction_blend);
      EXPECT_NEAR(v.norm(), 1, 1e-12);
      EXPECT_GE(v.dot(alone.direction_world), least - 1e-9) << "blend " << setup.settings.direction_blend;
      ++told;
      turned += v.dot(alone.direction_world) < 1 - 1e-6 ? 1 : 0;
    }
  });
  EXPECT_GT(told, 0);
  EXPECT_GT(turned, 0) << "other obstacles never turned it";
}

TEST(HybridDirection, IsTheNearestDirectionWithoutBlend) {
  for_random_problems(30, {}, [&](const RandomProblem& problem, Random&) {
    SearchSetup setup = make_setup(problem, SpaceKind::box, true);
    setup.settings.direction_blend = 0;
    Asker asker(setup);
    for (const Vector3d& p_world : problem.points_world) {
      const Answer answer = asker.hybrid(Capsule::point(p_world));
      if (answer.nearest.distance_m > 0 && answer.nearest.distance_m < setup.settings.rho_m) {
        EXPECT_LT((answer.hybrid_direction_world - answer.nearest.direction_world).norm(), 1e-12);
      }
    }
  });
}

/// The search sums over cells of rho / 16 and more, judged by their middles; against the mean over random points.
TEST(HybridDirection, IsNearlyThatOfTheExactObstacleSpace) {
  std::vector<double> off_degrees;
  for_random_problems(60, {}, [&](const RandomProblem& problem, Random& random) {
    SearchSetup setup = make_setup(problem, SpaceKind::box, true);
    setup.settings.policies.outside = views::Policy::ignored;
    setup.settings.direction_blend = 1.0;
    Asker asker(setup);
    const Reference oracle(oracle_problem(setup));
    for (const Vector3d& p_world : problem.points_world) {
      const Answer answer = asker.hybrid(Capsule::point(p_world));
      if (answer.nearest.distance_m > 0.02 && answer.nearest.distance_m < 0.7 * setup.settings.rho_m) {
        const Vector3d t = mean_direction(oracle, setup.settings, Capsule::point(p_world), random, 20000);
        const Vector3d exact = led(answer.nearest.direction_world, t, 1.0);
        off_degrees.push_back(degrees(angle_between(answer.hybrid_direction_world, exact)));
      }
    }
  });
  ASSERT_FALSE(off_degrees.empty());
  std::cout << "  off the exact direction in " << off_degrees.size() << " cases: median " << quantile(off_degrees, 0.5)
            << ", 95 % " << quantile(off_degrees, 0.95) << ", largest " << quantile(off_degrees, 1.0) << " degrees\n";
  EXPECT_LT(quantile(off_degrees, 0.5), 3);
  EXPECT_LT(quantile(off_degrees, 0.95), 10);
}

/// Ideal images of a scene from the places given, all of which look at the origin.
struct Staged {
  std::vector<simulation::View> views;
  SearchSetup setup;
  static constexpr double kFocalPx = 200;

  Staged(simulation::Scene scene, const std::vector<Vector3d>& places_world) {
    for (const Vector3d& normal : {Vector3d(1, 0, 0), Vector3d(-1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, -1, 0),
                                   Vector3d(0, 0, 1), Vector3d(0, 0, -1)}) {
      scene.add(simulation::Plane{normal, -4.0});
    }
    setup.rig.name = "staged";
    for (std::size_t k = 0; k < places_world.size(); ++k) {
      RigCamera camera;
      camera.id = "camera" + std::to_string(k);
      camera.intrinsics = {160, 120, kFocalPx, kFocalPx, 80, 60};
      camera.T_world_camera = look_at(places_world[k], Vector3d::Zero(), Vector3d(0.1, 0.2, 1).normalized());
      setup.rig.cameras.push_back(camera);
      views.push_back(scene.render(camera.intrinsics, camera.T_world_camera));
      setup.settings.margins.push_back(CameraMargins{.sensor = {0, 0, 0, 0}, .smallest_obstacle_m = 0});
    }
    for (const simulation::View& view : views) {
      const DepthImage& image = view.depth_m;
      Frame frame;
      frame.depth =
          depth_view(std::span(image.data(), image.index(0, image.height_px())), image.width_px(), image.height_px());
      setup.frames.push_back(frame);
    }
    setup.settings.space = views::BoxSpace{Vector3d::Constant(-1), Vector3d::Constant(1)};
    setup.settings.policies = {views::Policy::obstacle, views::Policy::obstacle, views::Policy::obstacle, 0};
    setup.settings.v_max_m_s = 0;
    setup.settings.rho_m = 0.4;
  }
  /// A point within r of what is d away, found where it is at most that far, lies at most this far off its direction;
  /// and the images show every edge up to a pixel farther.
  [[nodiscard]] double direction_error(double d_m) const {
    constexpr double kFarthestM = 3.0;
    return std::acos(1 - setup.settings.resolution_m / d_m) + std::atan(kFarthestM / kFocalPx / d_m);
  }
};

/// A large plate at 20 cm on one side, a finger at 5 cm on the other. Averaged, the plate wins: the robot would be
/// driven into the finger.
TEST(HybridDirection, NeverDrivesFromALargePlateIntoAFinger) {
  simulation::Scene scene;
  simulation::Box plate;
  plate.T_world_box.translation() = Vector3d(0.22, 0, 0);
  plate.half_size_m = Vector3d(0.02, 0.6, 0.6);
  scene.add(plate);
  scene.add(Capsule{{-0.06, 0, -0.02}, {-0.06, 0, 0.3}, 0.01});
  // Their shadows of the finger have nothing but the finger in common.
  Staged staged(scene, {{-1.5, -1.5, 0.8}, {-1.5, 1.5, 0.8}, {-1.8, 0.3, -1.0}});
  Random random(3);
  const Reference oracle(oracle_problem(staged.setup));
  const Vector3d mean = mean_direction(oracle, staged.setup.settings, Capsule::point(Vector3d::Zero()), random, 20000);
  EXPECT_GT(mean.x(), 0.5) << "the mean of all directions points to the plate";
  const Vector3d to_finger(-1, 0, 0);
  for (const double blend : {0.0, 0.25, 0.5, 1.0}) {
    staged.setup.settings.direction_blend = blend;
    const Answer answer = Asker(staged.setup).hybrid(Capsule::point(Vector3d::Zero()));
    EXPECT_LE(answer.nearest.distance_m, 0.05);
    const double most = staged.direction_error(0.05) + std::atan(blend);
    EXPECT_LE(angle_between(answer.hybrid_direction_world, to_finger), most) << "blend " << blend;
    EXPECT_GT(answer.hybrid_direction_world.dot(to_finger), 0) << "driven into the finger, blend " << blend;
  }
}

/// Cells as coarse as a third of their distance leave 8 and 6 degrees in the two scenes below; counting the cut cells
/// whole makes it 24 (12 with their middles outside of W), weighing by the distance to the axis 20.
constexpr double kCoarseDegrees = 10;

/// How far the search's direction of a capsule, turned by the others as far as it can be, is off that of the oracle's
/// obstacle space.
double off_degrees(Staged& staged, const Capsule& capsule) {
  staged.setup.settings.policies.outside = views::Policy::ignored;
  staged.setup.settings.direction_blend = 1.0;
  Random random(3);
  const Vector3d t =
      mean_direction(Reference(oracle_problem(staged.setup)), staged.setup.settings, capsule, random, 100'000);
  const Answer answer = Asker(staged.setup).hybrid(capsule);
  EXPECT_GT(answer.nearest.distance_m, 0.02);
  return degrees(angle_between(answer.hybrid_direction_world, led(answer.nearest.direction_world, t, 1.0)));
}

/// A finger near by, and a wall of which W holds a sliver of 5 mm: cells as thick as a hand lie across the border, and
/// count by what of them is in W.
TEST(HybridDirection, CountsOfTheCellsAtTheBorderWhatIsInW) {
  simulation::Scene scene;
  simulation::Box wall;
  wall.T_world_box.translation() = Vector3d(0, 0.4, 0);
  wall.half_size_m = Vector3d(0.6, 0.1, 0.6);
  scene.add(wall);
  scene.add(Capsule{{-0.06, 0, -0.02}, {-0.06, 0, 0.3}, 0.01});
  Staged staged(scene, {{-1.5, -1.5, 0.8}, {1.5, -1.5, 0.8}, {0.3, -1.8, -1.0}});
  staged.setup.settings.space = views::BoxSpace{Vector3d::Constant(-1), Vector3d(1, 0.305, 1)};
  EXPECT_LT(off_degrees(staged, Capsule::point(Vector3d::Zero())), kCoarseDegrees);
}

/// A post near a thick ball and a wall farther away: both count by their distance to its surface.
TEST(HybridDirection, WeighsByTheDistanceToTheSurface) {
  simulation::Scene scene;
  scene.add(simulation::Plane{Vector3d(0, -1, 0), -0.45});
  scene.add(Capsule{{-0.3, 0, -0.3}, {-0.3, 0, 0.3}, 0.05});
  Staged staged(scene, {{1.5, -0.5, 0.1}, {-1.5, -0.8, -0.1}, {0.5, -1.5, 0.1}});
  EXPECT_LT(off_degrees(staged, Capsule::sphere(Vector3d::Zero(), 0.2)), kCoarseDegrees);
}

TEST(HybridDirection, OfAPlaneIsItsNormal) {
  simulation::Scene scene;
  scene.add(simulation::Plane{Vector3d(-1, 0, 0), -0.15});  // solid beyond x = 0.15
  Staged staged(scene, {{-2, 0.4, 0.3}, {-2, -0.5, 0.2}});
  for (const double blend : {0.0, 0.5, 1.0}) {
    staged.setup.settings.direction_blend = blend;
    const Answer answer = Asker(staged.setup).hybrid(Capsule::point(Vector3d::Zero()));
    ASSERT_NEAR(answer.nearest.distance_m, 0.15, staged.setup.settings.resolution_m + 3.0 / Staged::kFocalPx);
    // The others are symmetrical about the normal: they may only turn the direction towards it.
    EXPECT_LE(angle_between(answer.hybrid_direction_world, Vector3d::UnitX()), staged.direction_error(0.15)) << blend;
  }
}

TEST(HybridDirection, BetweenTwoPlatesIsAcrossThem) {
  simulation::Scene scene;
  for (const double x : {-0.22, 0.22}) {
    simulation::Box plate;
    plate.T_world_box.translation() = Vector3d(x, 0, 0);
    plate.half_size_m = Vector3d(0.02, 0.5, 0.5);
    scene.add(plate);
  }
  Staged staged(scene, {{0.05, -2.2, 0.2}, {-0.05, 2.2, 0.3}});
  for (const double blend : {0.0, 0.5, 1.0}) {
    staged.setup.settings.direction_blend = blend;
    const Answer answer = Asker(staged.setup).hybrid(Capsule::point(Vector3d::Zero()));
    ASSERT_GT(answer.nearest.distance_m, 0.1);
    ASSERT_LE(answer.nearest.distance_m, 0.2);
    const double off = std::acos(std::min(1.0, std::abs(answer.hybrid_direction_world.x())));
    // What one plate turns to the one side the other turns to the other.
    EXPECT_LE(off, staged.direction_error(0.2)) << "blend " << blend;
  }
}

/// The grid averages over pixels of the principal camera, the search over space; both are led by the nearest.
TEST(HybridDirection, IsComparableWithTheGrids) {
  std::vector<double> apart_degrees;
  reference::RandomOptions options;
  options.margins = false;
  options.lateral = false;
  options.outside = false;
  for_random_problems(100, options, [&](const RandomProblem& problem, Random&) {
    SearchSetup setup = make_setup(problem, SpaceKind::frustum);
    setup.settings.policies.outside = views::Policy::ignored;
    setup.settings.resolution_m = 0.005;
    grid::EvaluationSettings settings;
    settings.collect = grid::Collect::hybrid;
    settings.rho_m = problem.rho_m;
    settings.sensor = problem.sensor;
    settings.pose = problem.pose;
    grid::GridEvaluator evaluator(problem.rig, problem.principal,
                                  {problem.d_min_m, problem.step_m, 0.0, problem.cell_count}, settings);
    (void)update_all(evaluator, problem.frames);
    Asker asker(setup);
    for (const Vector3d& p_world : problem.points_world) {
      const Answer ours = asker.hybrid(Capsule::point(p_world));
      const Answer theirs = evaluator.distance(Capsule::point(p_world));
      // Only where both have the same nearest obstacle, else they are led by different ones.
      if (!(ours.nearest.distance_m > 0.02 && theirs.nearest.distance_m > 0.02 &&
            ours.nearest.distance_m < 0.9 * problem.rho_m && theirs.nearest.distance_m < 0.9 * problem.rho_m &&
            (ours.nearest.nearest_world - theirs.nearest.nearest_world).norm() < 0.05)) {
        continue;
      }
      const Vector3d& v = theirs.hybrid_direction_world;
      EXPECT_GE(v.dot(theirs.nearest.direction_world), 1 / std::hypot(1, settings.direction_blend) - 1e-9);
      apart_degrees.push_back(degrees(angle_between(ours.hybrid_direction_world, v)));
    }
  });
  ASSERT_GT(apart_degrees.size(), 0U);
  std::cout << "  apart from the grid's direction in " << apart_degrees.size() << " cases: median "
            << quantile(apart_degrees, 0.5) << ", 95 % " << quantile(apart_degrees, 0.95) << ", largest "
            << quantile(apart_degrees, 1.0) << " degrees\n";
}

TEST(HybridDirection, WithABudgetThatRunsOutStandsBesideALowerBound) {
  for_random_problems(10, {}, [&](const RandomProblem& problem, Random&) {
    Asker asker(make_setup(problem, SpaceKind::box, true));
    for (const Vector3d& p_world : problem.points_world) {
      const Capsule primitive = Capsule::point(p_world);
      const double whole_m = asker.distance(primitive).nearest.distance_m;
      for (std::int64_t nodes = 1; nodes < 100'000; nodes *= 3) {
        Answer part;
        asker.search().hybrid(asker.snapshot(), {&primitive, 1}, {&part, 1}, {.nodes = nodes});
        ASSERT_FALSE(std::isnan(part.nearest.distance_m)) << nodes << " nodes";
        EXPECT_LE(part.nearest.distance_m, whole_m) << nodes << " nodes";
      }
    }
  });
}

}  // namespace
}  // namespace depthgrid::search
