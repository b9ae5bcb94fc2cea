// Where evaluators go wrong: far from the origin, and with settings at the ends of their ranges.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "depthgrid/core/pixel_frustum.hpp"
#include "search/one_camera.hpp"
#include "search/search_setup.hpp"

namespace depthgrid::search {
namespace {

using Eigen::Vector3d;
using reference::Random;
using reference::RandomProblem;
using reference::Reference;

TEST(Extremes, FarFromTheOriginNothingChanges) {
  for_random_problems(15, {}, [&](const RandomProblem& problem, Random&) {
    const SearchSetup near = make_setup(problem, SpaceKind::frustum, true);
    const Reference exact(oracle_problem(near));
    const Reference grown(oracle_problem(near, near.settings.resolution_m));
    for (const double far_m : {1e4, 9e4}) {
      SearchSetup far = near;
      const Vector3d shift = far_m * Vector3d(1, -0.7, 0.3);
      for (RigCamera& camera : far.rig.cameras) {
        camera.T_world_camera.translation() += shift;
      }
      Asker asker(far);
      for (const Vector3d& p : problem.points_world) {
        const double answer_m = asker.distance(Capsule::point(p + shift)).nearest.distance_m;
        EXPECT_LE(answer_m, exact.distance(p).hi_m.value_or(near.settings.rho_m)) << far_m << " m, " << p.transpose();
        EXPECT_GE(answer_m, grown.distance(p).lo_m - kRounding - kDoubleRounding) << far_m << " m, " << p.transpose();
      }
    }
  });
}

/// A capsule may be so large that its query radius is no float.
TEST(Extremes, ABudgetThatRunsOutIsSaidForTheLargestCapsules) {
  OneCamera one(2.0F);
  one.setup.settings.policies.outside = views::Policy::ignored;
  for (const double radius_m : {1.0, 1e30, 1e39, 1e300}) {
    Asker asker(one.setup);
    const Capsule capsule{{0, 0, 1}, {0, 0, 1}, radius_m};
    for (const std::int64_t nodes : {1, 2, 8}) {
      EXPECT_EQ(asker.distance(capsule, {.nodes = nodes}).nearest.distance_m, 0.0) << radius_m << " m, " << nodes;
    }
    EXPECT_EQ(asker.distance(capsule).nearest.distance_m, 0.0) << radius_m << " m";
  }
}

/// Far from the middle of W single precision resolves micrometres only.
TEST(Extremes, TheSpaceMayBeManyMetresWide) {
  for (const Vector3d& far_end : {Vector3d(150, 120, 130), Vector3d(20, 3, 3)}) {
    OneCamera one(2.0F);
    one.setup.settings.space = views::BoxSpace{{-3, -3, -3}, far_end};
    one.setup.settings.policies.outside = views::Policy::ignored;
    for (const double translation_m : {0.0, 0.004}) {
      one.setup.settings.margins[0].translation_m = translation_m;
      for (const Vector3d& p : {Vector3d(0, 0, 1.8), Vector3d(0.1, -0.05, 1.75), Vector3d(0.4, 0.2, 1.0),
                                Vector3d(-0.3, 0.1, 0.6), Vector3d(0.02, 0.01, 1.993)}) {
        expect_within_oracle(one.setup, p);
      }
    }
  }
}

/// Nothing counts but what is measured, so that the nearest obstacle may be far away.
TEST(Extremes, RhoMayReachBeyondEverything) {
  for (const double rho_m : {4.0, 30.0}) {
    OneCamera one(2.9F);
    one.setup.settings.policies.unobserved = views::Policy::ignored;
    one.setup.settings.policies.outside = views::Policy::ignored;
    one.setup.settings.rho_m = rho_m;
    Asker asker(one.setup);
    // The slab between the wall and W's border, and the blind zone before 0.3 m is no part of what the camera covers.
    const double shortfall_m = one.setup.settings.resolution_m + kRounding;
    const double wall_m = asker.distance(Capsule::point({0, 0, 1})).nearest.distance_m;
    EXPECT_LE(wall_m, static_cast<double>(2.9F) - 1);
    EXPECT_GE(wall_m, static_cast<double>(2.9F) - 1 - shortfall_m);
    const double behind_m = asker.distance(Capsule::point({0, 0, -2})).nearest.distance_m;
    EXPECT_LE(behind_m, std::min(rho_m, static_cast<double>(2.9F) + 2));
    EXPECT_GE(behind_m, std::min(rho_m, static_cast<double>(2.9F) + 2 - shortfall_m));
  }
}

TEST(Extremes, RhoMayBeAsSmallAsTheResolution) {
  OneCamera one;
  one.setup.settings.rho_m = one.setup.settings.resolution_m = 0.0005;
  Asker asker(one.setup);
  EXPECT_EQ(asker.distance(Capsule::point({0, 0, 1})).nearest.distance_m, 0.0005);
  EXPECT_EQ(asker.distance(Capsule::point({0, 0, 1})).nearest.state, ProximityState::beyond_rho);
  EXPECT_LE(asker.distance(Capsule::point({0, 0, 1.9998})).nearest.distance_m, 0.0002);
}

TEST(Extremes, TheResolutionMayBeFineOrCoarse) {
  reference::RandomOptions options;
  options.margins = false;
  for_random_problems(6, options, [&](const RandomProblem& problem, Random&) {
    SearchSetup setup = make_setup(problem, SpaceKind::box);
    for (const double resolution_m : {0.0005, 0.05, setup.settings.rho_m}) {
      setup.settings.resolution_m = resolution_m;
      SCOPED_TRACE(resolution_m);
      for (const Vector3d& p : problem.points_world) {
        expect_within_oracle(setup, p);
      }
    }
  });
}

TEST(Extremes, AnImageMayHaveOnePixel) {
  for (const auto& [width_px, height_px] : {std::pair{1, 1}, std::pair{1, 7}, std::pair{5, 1}, std::pair{2, 2}}) {
    SCOPED_TRACE(std::to_string(width_px) + " x " + std::to_string(height_px));
    OneCamera one(2.0F, width_px, height_px);
    PinholeCamera& pinhole = one.setup.rig.cameras[0].intrinsics;
    pinhole.fx_px = width_px;
    pinhole.fy_px = height_px;
    one.setup.settings.rho_m = 1.0;
    for (const Vector3d& p : {Vector3d(0, 0, 1.5), Vector3d(0.1, -0.1, 1), Vector3d(0, 0, 1.99),
                              Vector3d(0.3, 0.2, 0.9), Vector3d(2, 0, 1)}) {
      expect_within_oracle(one.setup, p);
    }
    EXPECT_GT(Asker(one.setup).distance(Capsule::point({0, 0, 1.5})).nearest.distance_m, 0.3);
    // With a filter radius of one pixel every pixel is at the border, so nothing is free.
    one.setup.settings.margins[0].sensor.lateral_px = 1;
    EXPECT_EQ(Asker(one.setup).distance(Capsule::point({0, 0, 1.5})).nearest.distance_m, 0);
  }
}

/// The coarsest level of a pyramid has to do for a cube that fills the view, whatever the image's size.
TEST(Extremes, AnImageMayHaveAnySize) {
  for (const int width_px : {3, 8, 9, 12, 13, 16, 17, 24, 25, 32, 48, 49, 64, 96, 200, 400, 800, 848}) {
    SCOPED_TRACE(width_px);
    OneCamera one(2.0F, width_px, std::max(1, width_px * 9 / 16));
    PinholeCamera& pinhole = one.setup.rig.cameras[0].intrinsics;
    pinhole.fx_px = pinhole.fy_px = width_px;
    // Something near in the middle of the image only.
    one.image_m[static_cast<std::size_t>(pinhole.height_px / 2 * width_px + width_px / 2)] = 0.9F;
    one.setup.settings.rho_m = 2.0;
    one.setup.settings.policies.unobserved = views::Policy::ignored;
    one.setup.settings.policies.outside = views::Policy::ignored;
    for (const bool frustum : {false, true}) {
      if (frustum) {
        one.setup.settings.space = views::FrustumSpace{0, 0.3, 2.5};
      } else {
        one.setup.settings.space = views::BoxSpace{{-3, -3, -3}, {3, 3, 3}};
      }
      for (const Vector3d& p : {Vector3d(0.01, 0.01, 0.5), Vector3d(0, 0, 0.8), Vector3d(0.1, 0.05, 1.1)}) {
        expect_within_oracle(one.setup, p);
      }
    }
  }
}

/// Only what is measured counts.
OneCamera measured_only(float wall_m, int width_px, int height_px, double focal_px) {
  OneCamera one(wall_m, width_px, height_px);
  one.setup.rig.cameras[0].intrinsics.fx_px = focal_px;
  one.setup.rig.cameras[0].intrinsics.fy_px = focal_px;
  one.setup.settings.policies.unobserved = views::Policy::ignored;
  one.setup.settings.policies.outside = views::Policy::ignored;
  one.setup.settings.rho_m = 1.0;
  one.refer();
  return one;
}

/// A wall straight ahead, along the cubes' faces: nothing but the error's growth with the range decides which cubes end
/// before it.
TEST(Extremes, ErrorsOfOrientationGrowWithinEveryCube) {
  Random random(5);
  for (int n = 0; n < 100; ++n) {
    OneCamera one = measured_only(2.0F, 96, 72, 30);
    one.refer();
    one.setup.settings.resolution_m = 0.03;
    const double rate = random.uniform(0.05, 0.3);
    one.setup.settings.margins[0].rotation_rad = rate;
    const Vector3d p(random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05), random.uniform(1.0, 1.4));
    // Straight ahead, the first point whose error reaches the wall.
    double free_m = p.z();
    double obstacle_m = 2;
    while (obstacle_m - free_m > 1e-12) {
      const double z_m = 0.5 * (free_m + obstacle_m);
      (z_m + rate * Vector3d(p.x(), p.y(), z_m).norm() < 2 ? free_m : obstacle_m) = z_m;
    }
    const double answer_m = Asker(one.setup).distance(Capsule::point(p)).nearest.distance_m;
    EXPECT_LE(answer_m, obstacle_m - p.z()) << p.transpose() << " with " << rate << " rad";
    EXPECT_GT(answer_m, 0) << p.transpose() << " with " << rate << " rad";
  }
}

/// W is a thin bar along the optical axis, and only its far end lies in the obstacle set: the error there just reaches
/// the wall. Boxes are wider than the bar and stay open, so that the ball around the last leaf alone decides.
TEST(Extremes, ErrorsOfOrientationGrowUpToTheFarSideOfABall) {
  constexpr double kRate = 0.5;
  constexpr double kBeyond_m = 0.001;  // the error's reach beyond the wall, at the bar's end
  constexpr double kHalf_m = 1e-4;
  const Vector3d p(0, 0, 1.2);
  for (int n = 0; n < 20; ++n) {
    const double end_m = 1.3 + 0.001 * n;
    OneCamera one = measured_only(static_cast<float>(end_m * (1 + kRate) - kBeyond_m), 96, 72, 30);
    one.refer();
    one.setup.settings.space = views::BoxSpace{{-kHalf_m, -kHalf_m, 1.1}, {kHalf_m, kHalf_m, end_m}};
    one.setup.settings.resolution_m = 0.03;
    one.setup.settings.margins[0].rotation_rad = kRate;
    const Proximity nearest = Asker(one.setup).distance(Capsule::point(p)).nearest;
    EXPECT_NE(nearest.state, ProximityState::beyond_rho) << "the bar ends at " << end_m;
    EXPECT_LE(nearest.distance_m, end_m - p.z()) << "the bar ends at " << end_m;
    EXPECT_GT(nearest.distance_m, 0) << "the bar ends at " << end_m;
  }
}

/// Things of one pixel, many of which lie within the resolution.
TEST(Extremes, AnyErrorOfOrientationFreesNothingButHidesNothing) {
  // Two cameras at the same place: one knows its orientation, the other does not.
  OneCamera two;
  SearchSetup& setup = two.setup;
  setup.rig.cameras.push_back(setup.rig.cameras[0]);
  setup.rig.cameras[1].id = "lost";
  setup.frames.push_back(setup.frames[0]);
  setup.settings.margins.push_back(setup.settings.margins[0]);
  for (const double rotation_rad : {0.01, 3.0, 1e6, 1e12, 1e14, 1e16, 1e100}) {
    setup.settings.margins[1].rotation_rad = rotation_rad;
    const double answer_m = Asker(setup).distance(Capsule::point({0, 0, 1.8})).nearest.distance_m;
    EXPECT_LE(answer_m, 0.2) << rotation_rad;
    EXPECT_GE(answer_m, 0.2 - 2 * setup.settings.resolution_m) << rotation_rad;
  }
}

TEST(Extremes, PixelsMayBeSmallerThanTheResolution) {
  Random random(6);
  constexpr int kWide = 320;
  constexpr int kHigh = 240;
  int told = 0;
  for (int n = 0; n < 60; ++n) {
    OneCamera one = measured_only(2.0F, kWide, kHigh, 500);
    const PinholeCamera& pinhole = one.setup.rig.cameras[0].intrinsics;
    one.setup.settings.resolution_m = random.uniform(0.005, 0.03);
    std::vector<PixelFrustum> things;
    for (int i = 0; i < 5; ++i) {
      const int u = random.integer(0, kWide - 1);
      const int v = random.integer(0, kHigh - 1);
      float& depth_m = one.image_m[static_cast<std::size_t>(v * kWide + u)];
      depth_m = static_cast<float>(random.uniform(0.6, 1.5));
      things.push_back(pixel_frustum(pinhole, u, v, static_cast<double>(depth_m), 2));
    }
    one.refer();
    Asker asker(one.setup);
    for (int i = 0; i < 5; ++i) {
      const Vector3d p = deproject(
          pinhole, {random.uniform(40, kWide - 40), random.uniform(40, kHigh - 40), random.uniform(0.7, 1.7)});
      double distance_m = 2 - p.z();
      for (const PixelFrustum& thing : things) {
        distance_m = std::min(distance_m, std::sqrt(squared_distance(thing, p)));
      }
      const double answer_m = asker.distance(Capsule::point(p)).nearest.distance_m;
      EXPECT_LE(answer_m, distance_m) << p.transpose();
      EXPECT_GE(answer_m, distance_m - one.setup.settings.resolution_m - kRounding - kDoubleRounding) << p.transpose();
      told += answer_m > 0 && distance_m < 2 - p.z() ? 1 : 0;
    }
  }
  EXPECT_GT(told, 100);
}

/// Two cameras that look at a box of one metre from ten metres to thirty kilometres away, each with an image of its own
/// random depths around it, or one of a wall along the cubes' faces, where no box is larger than its cube. Single
/// precision loses up to two millimetres there: answers are sound all the same, and tight up to 100 m.
TEST(Extremes, CamerasMayStandFarAway) {
  const auto run = depthgrid::test::random_run(100);
  constexpr double kHalf_m = 0.5;
  int told = 0;
  for (std::int64_t i = 0; i < run.count && !HasFailure(); ++i) {
    SCOPED_TRACE("case " + std::to_string(i) + "; " + run.reproduce());
    Random random(run.seed + static_cast<std::uint64_t>(i));
    OneCamera one;
    SearchSetup& setup = one.setup;
    setup.rig.cameras.push_back(setup.rig.cameras[0]);
    setup.frames.resize(2);
    setup.settings.space = views::BoxSpace{Vector3d::Constant(-kHalf_m), Vector3d::Constant(kHalf_m)};
    setup.settings.margins.resize(2, setup.settings.margins[0]);
    setup.settings.resolution_m = random.uniform(0.005, 0.02);
    setup.settings.rho_m = 0.4;
    std::array<std::vector<float>, 2> images_m;
    const bool wall = random.chance(0.5);
    double farthest_m = 0;
    for (std::size_t k = 0; k < 2; ++k) {
      const double away_m = std::pow(10, random.uniform(1, 4.5));
      farthest_m = std::max(farthest_m, away_m);
      RigCamera& camera = setup.rig.cameras[k];
      camera.id = std::to_string(k);
      camera.T_world_camera = wall ? look_at(away_m * Vector3d::UnitX(), Vector3d::Zero())
                                   : look_at(away_m * random.direction(), random.in_cube(0.1));
      const double focal_px = 24 * away_m / (kHalf_m * std::sqrt(3.0));
      camera.intrinsics = {48, 48, focal_px, focal_px, 24, 24};
      const double wall_m = away_m + random.uniform(0, 0.4);
      for (int pixel = 0; pixel < 48 * 48; ++pixel) {
        images_m[k].push_back(static_cast<float>(wall ? wall_m : away_m + random.uniform(0.1, 0.6)));
      }
      for (int thing = wall ? 0 : random.integer(0, 6); thing > 0; --thing) {
        images_m[k][static_cast<std::size_t>(random.integer(0, 48 * 48 - 1))] =
            static_cast<float>(away_m + random.uniform(-0.5, 0.2));
      }
      setup.frames[k].depth = depth_view(images_m[k], 48, 48);
      setup.settings.margins[k].translation_m = random.chance(0.5) ? 0.0 : random.uniform(0, 0.01);
      setup.settings.margins[k].rotation_rad = random.chance(0.5) ? 0.0 : random.uniform(0, 0.02 / away_m);
    }
    Asker asker(setup);
    const Reference exact(oracle_problem(setup));
    const Reference grown(oracle_problem(setup, setup.settings.resolution_m));
    for (int n = 0; n < 4; ++n) {
      const Vector3d p = random.in_cube(0.4);
      const double answer_m = asker.distance(Capsule::point(p)).nearest.distance_m;
      EXPECT_LE(answer_m, exact.distance(p).hi_m.value_or(setup.settings.rho_m)) << p.transpose();
      if (farthest_m < 100) {
        EXPECT_GE(answer_m, grown.distance(p).lo_m - kRounding - kDoubleRounding) << p.transpose();
      }
      told += answer_m > 0.02 ? 1 : 0;
    }
  }
  EXPECT_GT(told, 0);
}

TEST(Extremes, AnImageWithoutMeasurementsFreesNothing) {
  OneCamera one(0.0F);
  const Answer answer = Asker(one.setup).distance(Capsule::point({0, 0, 1}));
  EXPECT_EQ(answer.nearest.distance_m, 0);
  EXPECT_EQ(answer.nearest.state, ProximityState::unmeasured);
}

// Where no camera looks does not count, and what counts begins at the camera's own plane. From 1e-6 m on alone it would
// begin 3 mm beside this camera, whose last pixel looks along that plane.
TEST(Extremes, WhatACameraCoversBeginsAtItsPlane) {
  constexpr double kSlope = 3000;  // of the border before the last pixel; 3500 of the image's
  OneCamera one(1.0F, 8, 1);
  RigCamera& camera = one.setup.rig.cameras[0];
  camera.intrinsics = {8, 1, 1 / 500.0, 1.0, 1.0, 0.5};
  camera.rule.near_m = 0;
  ASSERT_EQ((7 - camera.intrinsics.cx_px) / camera.intrinsics.fx_px, kSlope);
  one.image_m[7] = 0;  // no measurement: nothing is free there
  one.setup.settings.policies = {views::Policy::ignored, views::Policy::ignored, views::Policy::obstacle, 0};
  one.setup.settings.resolution_m = 5e-4;
  for (const double x_m : {0.0, -0.002, 0.0005}) {
    const Vector3d p(x_m, 0, 0);
    // The last pixel's frustum ends in the camera's place.
    const Vector3d border = Vector3d(kSlope, 0, 1).normalized();
    const double exact_m = (p - std::max(p.dot(border), 0.0) * border).norm();
    const double answer_m = Asker(one.setup).distance(Capsule::point(p)).nearest.distance_m;
    EXPECT_LE(answer_m, exact_m + kRounding) << x_m;
    EXPECT_GE(answer_m, exact_m - one.setup.settings.resolution_m - kRounding) << x_m;
    expect_within_oracle(one.setup, p);
  }
}

}  // namespace
}  // namespace depthgrid::search
