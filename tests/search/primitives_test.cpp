// Spheres and capsules: what they must have to do with points, and that they touch when moved by their own answer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "search/one_camera.hpp"
#include "search/search_setup.hpp"

namespace depthgrid::search {
namespace {

using Eigen::Vector3d;
using reference::Interval;
using reference::Random;
using reference::RandomProblem;
using reference::Reference;

SpaceKind random_space(Random& random) { return random.chance(0.5) ? SpaceKind::box : SpaceKind::frustum; }

/// A point, a sphere or a capsule at p.
Capsule random_primitive(Random& random, const Vector3d& p_world) {
  switch (random.integer(0, 2)) {
    case 0:
      return Capsule::point(p_world);
    case 1:
      return Capsule::sphere(p_world, random.uniform(0.005, 0.1));
    default:
      return Capsule{p_world, p_world + random.in_cube(0.2), random.uniform(0, 0.08)};
  }
}

Capsule moved(const Capsule& primitive, const Vector3d& by_m) {
  return {primitive.a + by_m, primitive.b + by_m, primitive.radius_m};
}

std::string to_text(const Capsule& primitive) {
  std::ostringstream text;
  text.precision(17);
  text << "{{" << primitive.a.x() << ", " << primitive.a.y() << ", " << primitive.a.z() << "}, {" << primitive.b.x()
       << ", " << primitive.b.y() << ", " << primitive.b.z() << "}, " << primitive.radius_m << '}';
  return text.str();
}

/// What the answer of a sphere must not exceed, from the distance of its centre.
double upper_m(const Interval& centre, const SearchSetup& setup, double radius_m) {
  return centre.hi_m ? std::max(0.0, *centre.hi_m - radius_m) : setup.settings.rho_m;
}

SearchSetup with_pose_error(SearchSetup setup, double more_m) {
  for (CameraMargins& margins : setup.settings.margins) {
    margins.translation_m += more_m;
  }
  return setup;
}

/// The nearest point w of an answer lies within e_k + r of every camera's not known free set. The primitive moved by
/// the answer touches w to within the 1e-5 m of the answer and the 1e-5 m of the nearest point, so the distance to the
/// set whose e_k are larger by r is then at most the sum, and no answer exceeds a distance.
constexpr double kTouchM = 2e-5;

TEST(MovedByItsAnswer, TouchesTheSetGrownByTheResolution) {
  int told = 0;
  for_random_problems(100, {}, [&](const RandomProblem& problem, Random& random) {
    const SearchSetup setup = make_setup(problem, random_space(random), true);
    Asker asker(setup);
    Asker grown(with_pose_error(setup, setup.settings.resolution_m));
    for (const Vector3d& p_world : problem.points_world) {
      const Capsule primitive = random_primitive(random, p_world);
      const Proximity nearest = asker.distance(primitive).nearest;
      if (!(nearest.distance_m > 0 && nearest.distance_m < setup.settings.rho_m)) {
        continue;
      }
      ASSERT_NEAR(nearest.direction_world.norm(), 1, 1e-9) << to_text(primitive);
      const Capsule there = moved(primitive, nearest.distance_m * nearest.direction_world);
      EXPECT_LE(grown.distance(there).nearest.distance_m, kTouchM)
          << to_text(primitive) << " answers " << nearest.distance_m;
      ++told;
    }
  });
  EXPECT_GT(told, 0);
}

/// With one camera a point within r of the not known free set is within r / (1 - growth of e_k per metre) of O itself.
TEST(MovedByItsAnswer, TouchesWithinTheResolutionWithOneCamera) {
  int told = 0;
  reference::RandomOptions options;
  options.cameras = 1;
  for_random_problems(100, options, [&](const RandomProblem& problem, Random& random) {
    const SearchSetup setup = make_setup(problem, random_space(random), true);
    const double shortfall_m = setup.settings.resolution_m / (1 - setup.settings.margins[0].rotation_rad);
    Asker asker(setup);
    for (const Vector3d& p_world : problem.points_world) {
      const Capsule primitive = random_primitive(random, p_world);
      const Proximity nearest = asker.distance(primitive).nearest;
      if (!(nearest.distance_m > 0 && nearest.distance_m < setup.settings.rho_m)) {
        continue;
      }
      const Capsule there = moved(primitive, nearest.distance_m * nearest.direction_world);
      const double rest_m = asker.distance(there).nearest.distance_m;
      EXPECT_LE(rest_m, shortfall_m + kTouchM) << to_text(primitive) << " answers " << nearest.distance_m;
      EXPECT_LE(rest_m, std::max(nearest.distance_m, shortfall_m + kTouchM)) << to_text(primitive);
      ++told;
    }
  });
  EXPECT_GT(told, 0);
}

/// On the way there no point of the primitive lies in the obstacle.
TEST(MovedByItsAnswer, MeetsNothingOnTheWay) {
  int told = 0;
  for_random_problems(100, {}, [&](const RandomProblem& problem, Random& random) {
    const SearchSetup setup = make_setup(problem, random_space(random), true);
    Asker asker(setup);
    const Reference oracle(oracle_problem(setup));
    for (const Vector3d& p_world : problem.points_world) {
      const Capsule primitive = random_primitive(random, p_world);
      const Proximity nearest = asker.distance(primitive).nearest;
      if (!(nearest.distance_m > 0)) {
        continue;
      }
      for (int i = 0; i < 200; ++i) {
        const Vector3d on_axis = primitive.a + random.uniform(0, 1) * (primitive.b - primitive.a);
        // Straight ahead, where contact will be, and anywhere around.
        const Vector3d direction = random.chance(0.5) && nearest.distance_m < setup.settings.rho_m
                                       ? nearest.direction_world
                                       : random.direction();
        const Vector3d inside = on_axis + random.uniform(0, primitive.radius_m + nearest.distance_m) * direction;
        EXPECT_FALSE(oracle.is_obstacle(inside)) << to_text(primitive) << " answers " << nearest.distance_m << ", but "
                                                 << inside.transpose() << " is an obstacle";
        ++told;
      }
    }
  });
  EXPECT_GT(told, 0);
}

TEST(Spheres, AreAsFarAsTheirCentreLessTheRadius) {
  int told = 0;
  for_random_problems(100, {}, [&](const RandomProblem& problem, Random& random) {
    const SearchSetup setup = make_setup(problem, random_space(random), true);
    Asker asker(setup);
    for (const Vector3d& p_world : problem.points_world) {
      const double radius_m = random.chance(0.2) ? random.uniform(0.2, 0.5) : random.uniform(0.001, 0.1);
      // rho counts from the surface.
      const double rho_m = setup.settings.rho_m + radius_m;
      const Reference oracle(oracle_problem(setup, 0, rho_m));
      const Reference grown(oracle_problem(setup, setup.settings.resolution_m, rho_m));
      const double answer_m = asker.distance(Capsule::sphere(p_world, radius_m)).nearest.distance_m;
      const std::string text = to_text(Capsule::sphere(p_world, radius_m));
      EXPECT_LE(answer_m, upper_m(oracle.distance(p_world), setup, radius_m)) << text;
      EXPECT_GE(answer_m, grown.distance(p_world).lo_m - radius_m - kRounding - kDoubleRounding) << text;
      told += answer_m > 0 && answer_m < setup.settings.rho_m ? 1 : 0;
    }
  });
  EXPECT_GT(told, 0);
}

/// The points of the axis are sampled; between two samples D changes by at most half their distance.
TEST(Capsules, AreAsFarAsTheNearestPointOfTheirAxisLessTheRadius) {
  int told = 0;
  for_random_problems(40, {}, [&](const RandomProblem& problem, Random& random) {
    const SearchSetup setup = make_setup(problem, random_space(random), true);
    Asker asker(setup);
    for (const Vector3d& p_world : problem.points_world) {
      const Capsule link = Capsule{p_world, p_world + random.in_cube(0.2), random.uniform(0, 0.08)};
      const double length_m = (link.b - link.a).norm();
      const double rho_m = setup.settings.rho_m + link.radius_m;
      const Reference oracle(oracle_problem(setup, 0, rho_m));
      const Reference grown(oracle_problem(setup, setup.settings.resolution_m, rho_m));
      constexpr int kSamples = 9;
      double nearest_m = setup.settings.rho_m;
      double lower_m = rho_m;
      for (int i = 0; i < kSamples; ++i) {
        const Vector3d on_axis = link.a + i / (kSamples - 1.0) * (link.b - link.a);
        nearest_m = std::min(nearest_m, upper_m(oracle.distance(on_axis), setup, link.radius_m));
        lower_m = std::min(lower_m, grown.distance(on_axis).lo_m);
      }
      lower_m -= 0.5 * length_m / (kSamples - 1.0);
      const double answer_m = asker.distance(link).nearest.distance_m;
      EXPECT_LE(answer_m, nearest_m) << to_text(link);
      EXPECT_GE(answer_m, lower_m - link.radius_m - kRounding - kDoubleRounding) << to_text(link);
      told += answer_m > 0 && answer_m < setup.settings.rho_m ? 1 : 0;
    }
  });
  EXPECT_GT(told, 0);
}

TEST(Capsules, HaveTheirContactOnTheAxisAndTheSurface) {
  int told = 0;
  for_random_problems(100, {}, [&](const RandomProblem& problem, Random& random) {
    const SearchSetup setup = make_setup(problem, random_space(random), true);
    Asker asker(setup);
    for (const Vector3d& p_world : problem.points_world) {
      const Capsule link = random_primitive(random, p_world);
      const Answer answer = asker.distance(link);
      if (!(answer.nearest.distance_m > 0 && answer.nearest.distance_m < setup.settings.rho_m)) {
        continue;
      }
      const Vector3d to_nearest = answer.nearest.nearest_world - answer.on_axis_world;
      // Rounding is not left to luck: every answer is shorter by it.
      EXPECT_NEAR(to_nearest.norm() - link.radius_m - kRounding, answer.nearest.distance_m, kDoubleRounding)
          << to_text(link);
      EXPECT_NEAR((to_nearest.normalized() - answer.nearest.direction_world).norm(), 0, 1e-9) << to_text(link);
      const Vector3d axis = link.b - link.a;
      const double along = (answer.on_axis_world - link.a).dot(axis);
      const double length2 = axis.squaredNorm();
      EXPECT_GE(along, -1e-12) << to_text(link);
      EXPECT_LE(along, length2 + 1e-12) << to_text(link);
      if (length2 == 0) {
        EXPECT_EQ(answer.on_axis_world, link.a);
      } else {
        const double t = std::clamp((answer.nearest.nearest_world - link.a).dot(axis) / length2, 0.0, 1.0);
        EXPECT_NEAR((link.a + t * axis - answer.on_axis_world).norm(), 0, 1e-9) << to_text(link);
      }
      ++told;
    }
  });
  EXPECT_GT(told, 0);
}

/// Ends that differ by less than any resolution, down to the smallest number there is.
TEST(Capsules, OfHardlyAnyLengthAreSpheres) {
  for_random_problems(100, {}, [&](const RandomProblem& problem, Random& random) {
    const SearchSetup setup = make_setup(problem, random_space(random), true);
    Asker asker(setup);
    for (const Vector3d& p_world : problem.points_world) {
      const double radius_m = random.uniform(0, 0.1);
      const double rho_m = setup.settings.rho_m + radius_m;
      const Interval interval = Reference(oracle_problem(setup, 0, rho_m)).distance(p_world);
      const Interval grown = Reference(oracle_problem(setup, setup.settings.resolution_m, rho_m)).distance(p_world);
      for (const double length_m : {1e-3, 1e-9, 1e-15, 1e-160, std::numeric_limits<double>::denorm_min()}) {
        const Capsule link = Capsule{p_world, p_world + length_m * random.direction(), radius_m};
        const double answer_m = asker.distance(link).nearest.distance_m;
        EXPECT_LE(answer_m, upper_m(interval, setup, radius_m)) << to_text(link);
        EXPECT_GE(answer_m, grown.lo_m - radius_m - length_m - kRounding - kDoubleRounding) << to_text(link);
      }
      EXPECT_EQ(asker.distance(Capsule{p_world, p_world, radius_m}).nearest.distance_m,
                asker.distance(Capsule::sphere(p_world, radius_m)).nearest.distance_m);
      EXPECT_EQ(asker.distance(Capsule::sphere(p_world, 0)).nearest.distance_m,
                asker.distance(Capsule::point(p_world)).nearest.distance_m);
    }
  });
}

TEST(Primitives, ThatAreNoneAreNotEvaluatedAndDisturbNobody) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for_random_problems(20, {}, [&](const RandomProblem& problem, Random& random) {
    Asker asker(make_setup(problem, random_space(random)));
    const Vector3d p = problem.points_world.front();
    std::vector<Capsule> primitives{Capsule::point(p), Capsule::sphere(p, -1e-9), Capsule::sphere(p, kNaN),
                                    Capsule::sphere(p, kInfinity)};
    for (int axis = 0; axis < 3; ++axis) {
      for (const double bad : {kNaN, kInfinity, -kInfinity}) {
        Vector3d broken = p;
        broken[axis] = bad;
        primitives.push_back(Capsule::point(broken));
        primitives.push_back(Capsule{p, broken, 0.05});
        primitives.push_back(Capsule{broken, p, 0.05});
      }
    }
    primitives.push_back(Capsule::sphere(p, 0.03));
    const std::vector<Answer> answers = asker.distances(primitives);
    for (std::size_t i = 1; i + 1 < answers.size(); ++i) {
      EXPECT_EQ(answers[i].nearest.state, ProximityState::not_evaluated) << to_text(primitives[i]);
      EXPECT_TRUE(std::isnan(answers[i].nearest.distance_m)) << to_text(primitives[i]);
      EXPECT_TRUE(answers[i].nearest.nearest_world.array().isNaN().all()) << to_text(primitives[i]);
    }
    const std::vector<Capsule> valid{primitives.front(), primitives.back()};
    const std::vector<Answer> expected = asker.distances(valid);
    EXPECT_EQ(answers.front().nearest.distance_m, expected[0].nearest.distance_m);
    EXPECT_EQ(answers.back().nearest.distance_m, expected[1].nearest.distance_m);
  });
}

/// Primitives of one call share what is prepared for it, so that answers depend on the company by up to the resolution.
TEST(Primitives, InOneCallKeepTheirBoundsAndRepeatToTheBit) {
  for_random_problems(100, {}, [&](const RandomProblem& problem, Random& random) {
    const SearchSetup setup = make_setup(problem, random_space(random), true);
    Asker whole(setup);
    Asker more(setup);  // with room for more answers than are asked for
    std::vector<Capsule> primitives;
    for (int i = 0; i < 11; ++i) {
      // Far apart in some calls, close together in others.
      const double apart_m = random.chance(0.5) ? 0.3 : 0.02;
      const Vector3d p_world = problem.points_world[0] + random.in_cube(apart_m);
      primitives.push_back(random.chance(0.5) ? Capsule::point(p_world)
                                              : Capsule::sphere(p_world, random.uniform(0, 0.1)));
    }
    std::vector<Answer> answers(13);
    answers[11].nearest.distance_m = answers[12].nearest.distance_m = 7;
    more.search().distances(more.snapshot(), primitives, answers);
    for (const std::size_t i : {11U, 12U}) {
      EXPECT_EQ(answers[i].nearest.state, ProximityState::not_evaluated) << "nobody asked";
      EXPECT_TRUE(std::isnan(answers[i].nearest.distance_m)) << "nobody asked";
    }
    const std::vector<Answer> at_once = whole.distances(primitives);
    const std::vector<Answer> again = whole.distances(primitives);
    const double rho_m = setup.settings.rho_m + 0.1;
    const Reference oracle(oracle_problem(setup, 0, rho_m));
    const Reference grown(oracle_problem(setup, setup.settings.resolution_m, rho_m));
    for (std::size_t i = 0; i < primitives.size(); ++i) {
      const double radius_m = primitives[i].radius_m;
      const double most_m = std::min(upper_m(oracle.distance(primitives[i].a), setup, radius_m), setup.settings.rho_m);
      const double least_m = std::min(grown.distance(primitives[i].a).lo_m - radius_m, setup.settings.rho_m);
      for (const double answer_m : {answers[i].nearest.distance_m, at_once[i].nearest.distance_m}) {
        EXPECT_LE(answer_m, most_m) << to_text(primitives[i]);
        EXPECT_GE(answer_m, least_m - kRounding - kDoubleRounding) << to_text(primitives[i]);
      }
      EXPECT_EQ(at_once[i].nearest.distance_m, again[i].nearest.distance_m) << to_text(primitives[i]);
      EXPECT_EQ(at_once[i].nearest.state, again[i].nearest.state) << to_text(primitives[i]);
    }
  });
}

TEST(Primitives, MayBeAsManyAsOneLikes) {
  OneCamera one(2.0F);
  one.setup.settings.rho_m = 1.5;  // the wall is within it
  Random random(7);
  std::vector<Capsule> primitives;
  for (int i = 0; i < 300; ++i) {
    const Vector3d a = Vector3d(0, 0, 1.4) + random.in_cube(0.3);
    primitives.push_back(Capsule{a, a + random.in_cube(0.1), random.uniform(0, 0.05)});
  }
  Asker asker(one.setup);
  const std::vector<Answer> answers = asker.distances(primitives);
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const Answer alone = asker.distance(primitives[i]);
    ASSERT_GT(alone.nearest.distance_m, 0) << to_text(primitives[i]);
    ASSERT_EQ(answers[i].nearest.distance_m, alone.nearest.distance_m) << i << ": " << to_text(primitives[i]);
    ASSERT_EQ(answers[i].on_axis_world, alone.on_axis_world) << i << ": " << to_text(primitives[i]);
  }
}

}  // namespace
}  // namespace depthgrid::search
