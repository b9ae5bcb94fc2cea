// The oracle against an exact enumeration on tiny images, and its own consistency on random problems.
#include "reference/reference.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <iostream>

#include "reference/random_problem.hpp"
#include "reference/second_opinion.hpp"
#include "support/random_run.hpp"

namespace depthgrid::reference {
namespace {

using Eigen::Vector3d;

/// Calls check(problem, description) for `count` seeds with the given options.
template <class Check>
void for_random_problems(RandomOptions options, std::int64_t count, Check&& check) {
  const test::RandomRun run = test::random_run(count);
  for (std::int64_t i = 0; i < run.count; ++i) {
    options.seed = run.seed + static_cast<std::uint64_t>(i);
    const RandomProblem random = make_random_problem(options);
    SCOPED_TRACE(to_line(options));
    check(random);
    if (::testing::Test::HasFailure()) {
      return;
    }
  }
}

/// hi of an interval, or the cap: nothing was found within rho.
double upper_m(const Interval& interval, double rho_m) { return interval.hi_m.value_or(rho_m); }

/// ball_meets_not_free() without passing over anything, for balls inside the view.
bool meets_some_pixel(const CameraSpace& camera, const Vector3d& p, double radius_m) {
  for (int v = 0; v < camera.intrinsics().height_px; ++v) {
    for (int u = 0; u < camera.intrinsics().width_px; ++u) {
      for (const auto& [d1_m, d2_m] : camera.not_free_depths(u, v)) {
        if (d1_m < d2_m && camera.piece(u, v, d1_m, d2_m).meets_ball(p, radius_m)) {
          return true;
        }
      }
    }
  }
  return false;
}

TEST(Reference, BallsThatPassOverBlocksMeetWhatSomePixelHasNotFree) {
  RandomOptions options;
  options.cameras = 3;
  std::array<int, 2> answers{};
  for (const int width_px : {16, 50, 96}) {
    options.width_px = width_px;
    for_random_problems(options, 20, [&](const RandomProblem& random) {
      const Reference reference(random.problem());
      for (std::size_t k = 0; k < reference.camera_count(); ++k) {
        const CameraSpace& camera = reference.camera(k);
        for (const Vector3d& p_world : random.points_world) {
          const Vector3d p = camera.to_camera(p_world);
          for (const double radius_m : {0.0, 0.003, 0.02, 0.1, 0.4}) {
            const auto inside_m = camera.inside_m(p);
            const bool in_view = p.z() > radius_m && *std::min_element(inside_m.begin(), inside_m.end()) > radius_m;
            const bool meets = !in_view || meets_some_pixel(camera, p, radius_m);
            EXPECT_EQ(camera.ball_meets_not_free(p_world, radius_m), meets) << p.transpose() << ", " << radius_m;
            answers.at(in_view && meets ? 1 : 0) += in_view ? 1 : 0;
          }
        }
      }
    });
  }
  EXPECT_TRUE(answers[0] > 50 && answers[1] > 50) << answers[0] << " no, " << answers[1] << " yes";
}

TEST(Reference, EnclosesTheExactDistanceOnTinyImages) {
  RandomOptions options;
  options.width_px = 16;
  options.margins = false;
  int found = 0;
  int beyond = 0;
  double widest_m = 0;
  for (const int cameras : {1, 2}) {
    options.cameras = cameras;
    for_random_problems(options, 25, [&](const RandomProblem& random) {
      Problem problem = random.problem();
      problem.outside = Policy::ignored;
      const Reference reference(problem);
      for (const Vector3d& p_world : random.points_world) {
        const Interval interval = reference.distance(p_world);
        const double exact_m = exact_distance_m(problem, p_world);
        EXPECT_FALSE(interval.limit_reached);
        EXPECT_LE(interval.lo_m, std::min(exact_m, problem.rho_m) + 1e-8) << p_world.transpose();
        if (interval.hi_m) {
          EXPECT_GE(*interval.hi_m, exact_m - 1e-8) << p_world.transpose();
          widest_m = std::max(widest_m, *interval.hi_m - interval.lo_m);
          ++found;
        } else {
          EXPECT_GE(exact_m, problem.rho_m - 2e-3) << p_world.transpose();
          ++beyond;
        }
      }
    });
  }
  RecordProperty("found", found);
  RecordProperty("beyond_rho", beyond);
  EXPECT_GT(found, beyond);
  EXPECT_LT(widest_m, 5e-3);
}

TEST(Reference, MembershipAgreesWithPolyhedra) {
  RandomOptions options;
  options.width_px = 16;
  options.margins = true;
  int checked = 0;
  for_random_problems(options, 40, [&](const RandomProblem& random) {
    const Problem problem = random.problem();
    const Reference reference(problem);
    Random points(random.options.seed);
    for (std::size_t k = 0; k < problem.cameras.size(); ++k) {
      const std::vector<Polyhedron> pieces = pieces_not_free(problem.cameras[k]);
      for (int i = 0; i < 30; ++i) {
        const Vector3d p_world = points.in_cube(0.8);
        double nearest_m = 1.0;
        for (const Polyhedron& piece : pieces) {
          nearest_m = std::min(nearest_m, distance_m(piece, p_world, nearest_m));
        }
        const PoseMargin& pose = problem.cameras[k].pose;
        const double pose_error_m =
            pose.translation_m + pose.time_m +
            pose.rotation_rad * (p_world - problem.cameras[k].T_world_camera.translation()).norm();
        if (nearest_m == 0 || std::abs(nearest_m - pose_error_m) > 1e-8) {
          EXPECT_EQ(reference.camera(k).blocks(p_world), nearest_m <= pose_error_m)
              << "camera " << k << ", point " << p_world.transpose() << ", " << nearest_m << " of " << pose_error_m;
          ++checked;
        }
      }
    }
  });
  EXPECT_GT(checked, 0);
}

TEST(Reference, WitnessLiesInTheObstacleSetAndBoundsAreInOrder) {
  RandomOptions options;
  options.width_px = 32;
  std::vector<double> widths_m;
  std::int64_t boxes = 0;
  int limited = 0;
  for_random_problems(options, 40, [&](const RandomProblem& random) {
    const Problem problem = random.problem();
    const Reference reference(problem);
    std::vector<std::vector<Polyhedron>> pieces;
    for (const CameraInput& camera : problem.cameras) {
      pieces.push_back(pieces_not_free(camera));
    }
    for (const Vector3d& p_world : random.points_world) {
      const Interval interval = reference.distance(p_world);
      boxes += interval.boxes;
      limited += interval.limit_reached ? 1 : 0;
      EXPECT_GE(interval.lo_m, 0);
      EXPECT_LE(interval.lo_m, problem.rho_m);
      ASSERT_EQ(interval.hi_m.has_value(), interval.witness_world.has_value());
      if (!interval.hi_m) {
        continue;
      }
      EXPECT_LE(interval.lo_m, *interval.hi_m);
      EXPECT_LE(*interval.hi_m, problem.rho_m);
      const Vector3d& witness = *interval.witness_world;
      EXPECT_NEAR((witness - p_world).norm(), *interval.hi_m, 1e-12);
      widths_m.push_back(*interval.hi_m - interval.lo_m);
      const auto& space = std::get<FrustumSpace>(problem.space);
      const Polyhedron view = view_polyhedron(problem.cameras[space.principal], space.d_min_m, space.d_max_m);
      if (!contains(view, witness, 0)) {
        EXPECT_TRUE(problem.outside == Policy::obstacle || contains(view, witness, 1e-9));
        continue;
      }
      for (std::size_t k = 0; k < problem.cameras.size(); ++k) {
        const CameraInput& camera = problem.cameras[k];
        const double pose_error_m = camera.pose.translation_m + camera.pose.time_m +
                                    camera.pose.rotation_rad * (witness - camera.T_world_camera.translation()).norm();
        EXPECT_TRUE(std::any_of(pieces[k].begin(), pieces[k].end(),
                                [&](const Polyhedron& piece) {
                                  return distance_m(piece, witness, pose_error_m + 1e-6) <= pose_error_m + 1e-8;
                                }))
            << "camera " << k << " frees the witness of " << p_world.transpose();
      }
    }
  });
  ASSERT_FALSE(widths_m.empty());
  std::sort(widths_m.begin(), widths_m.end());
  std::cout << "  hi - lo: median " << widths_m[widths_m.size() / 2] << " m, largest " << widths_m.back() << " m, "
            << boxes / static_cast<std::int64_t>(widths_m.size()) << " boxes a point, limit reached " << limited
            << " times\n";
  EXPECT_LT(widths_m[widths_m.size() / 2], 1e-3);
}

TEST(Reference, MoreCamerasNeverLowerAndWorseImagesNeverRaise) {
  RandomOptions options;
  options.width_px = 24;
  for_random_problems(options, 40, [](const RandomProblem& random) {
    const Problem all = random.problem();
    const Reference reference(all);
    std::vector<Interval> answers;
    for (const Vector3d& p_world : random.points_world) {
      answers.push_back(reference.distance(p_world));
    }
    const auto never_farther = [&](const Problem& worse, const char* what) {
      const Reference other(worse);
      for (std::size_t i = 0; i < answers.size(); ++i) {
        const double lo_m = other.distance(random.points_world[i]).lo_m;
        EXPECT_LE(lo_m, upper_m(answers[i], all.rho_m)) << what << ", " << random.points_world[i].transpose();
      }
    };
    // The principal camera alone.
    Problem alone = all;
    const auto& space = std::get<FrustumSpace>(all.space);
    alone.cameras = {all.cameras[space.principal]};
    alone.space = FrustumSpace{0, space.d_min_m, space.d_max_m};
    never_farther(alone, "without the secondary cameras");

    Problem wider = all;
    for (CameraInput& camera : wider.cameras) {
      camera.sensor.constant_m += 0.01;
    }
    never_farther(wider, "larger sensor margin");
    wider = all;
    for (CameraInput& camera : wider.cameras) {
      camera.sensor.lateral_px += 1;
    }
    never_farther(wider, "larger filter radius");
    wider = all;
    for (CameraInput& camera : wider.cameras) {
      camera.pose.time_m += 0.005;
    }
    never_farther(wider, "larger pose error");

    // Invalid pixels, in a copy of the images. Robot pixels are left out: they lose what was known behind the robot.
    std::vector<std::vector<float>> images;
    Problem holes = all;
    Random choose(random.options.seed);
    for (CameraInput& camera : holes.cameras) {
      std::vector<float> image;
      for (int v = 0; v < camera.camera.height_px; ++v) {
        for (int u = 0; u < camera.camera.width_px; ++u) {
          const float depth_m = measured_depth_m(camera.frame.depth, camera.rule, u, v).value_or(0.0F);
          image.push_back(choose.chance(0.05) ? 0.0F : depth_m);
        }
      }
      images.push_back(std::move(image));
      camera.frame.depth = depth_view(images.back(), camera.camera.width_px, camera.camera.height_px);
    }
    never_farther(holes, "invalid pixels");
  });
}

TEST(Reference, OrderOfCamerasAndRigidMotionChangeNothing) {
  RandomOptions options;
  options.width_px = 24;
  for_random_problems(options, 40, [](const RandomProblem& random) {
    const Problem problem = random.problem();
    const Reference reference(problem);

    Problem reversed = problem;
    std::reverse(reversed.cameras.begin(), reversed.cameras.end());
    auto space = std::get<FrustumSpace>(problem.space);
    space.principal = problem.cameras.size() - 1 - space.principal;
    reversed.space = space;
    const Reference other_order(reversed);

    Random motion(random.options.seed + 17);
    Pose T_moved_world = Pose::Identity();
    T_moved_world.linear() = Eigen::AngleAxisd(motion.uniform(-3, 3), motion.direction()).toRotationMatrix();
    T_moved_world.translation() = motion.in_cube(3);
    Problem moved = problem;
    for (CameraInput& camera : moved.cameras) {
      camera.T_world_camera = T_moved_world * camera.T_world_camera;
    }
    const Reference elsewhere(moved);

    for (const Vector3d& p_world : random.points_world) {
      const Interval interval = reference.distance(p_world);
      const Interval permuted = other_order.distance(p_world);
      EXPECT_EQ(interval.lo_m, permuted.lo_m);
      EXPECT_EQ(interval.hi_m, permuted.hi_m);
      const Interval there = elsewhere.distance(T_moved_world * p_world);
      EXPECT_LE(interval.lo_m, upper_m(there, problem.rho_m) + 1e-6) << p_world.transpose();
      EXPECT_LE(there.lo_m, upper_m(interval, problem.rho_m) + 1e-6) << p_world.transpose();
    }
  });
}

TEST(Reference, ProblemLinesReproduceTheProblem) {
  RandomOptions options;
  options.seed = 1234567;
  options.cameras = 2;
  options.rho_m = 0.1 + 0.2;
  options.robot = true;
  const RandomOptions again = parse_options(to_line(options));
  EXPECT_EQ(to_line(again), to_line(options));
  const RandomProblem a = make_random_problem(options);
  const RandomProblem b = make_random_problem(again);
  ASSERT_EQ(a.points_world.size(), b.points_world.size());
  for (std::size_t i = 0; i < a.points_world.size(); ++i) {
    EXPECT_EQ(a.points_world[i], b.points_world[i]);
    EXPECT_EQ(Reference(a.problem()).distance(a.points_world[i]).lo_m,
              Reference(b.problem()).distance(b.points_world[i]).lo_m);
  }
  EXPECT_THROW(parse_options("seed=1 sauce=3"), std::runtime_error);
  EXPECT_THROW(parse_options("seed=1 robot"), std::runtime_error);
}

}  // namespace
}  // namespace depthgrid::reference
