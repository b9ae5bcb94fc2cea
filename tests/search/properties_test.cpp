// Properties of the distance D that hold whatever the scene is. Each says that one question's D is at most another's,
// D_x <= D_y. An evaluator that is tight to r only knows D to lie between its answer and D_r, so what holds for answers
// is
//   answer_x <= D_y     and     answer_y >= D_r of x,
// with D and D_r as proven intervals from the oracle. Everything that no camera has seen free counts as obstacle.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "search/search_setup.hpp"

namespace depthgrid::search {
namespace {

using Eigen::Vector3d;
using reference::Interval;
using reference::Random;
using reference::RandomProblem;
using reference::Reference;

/// Counts the comparisons that say something: neither zero nor cut at rho.
struct Tally {
  int telling = 0;
  ~Tally() { EXPECT_GT(telling, 0) << "every point lay in an obstacle or had none within rho"; }
};

/// One question: its rig, frames and settings, and where the points are.
struct Question {
  SearchSetup setup;
  std::vector<Vector3d> points_world;
};

/// D_x(P) <= D_y(P) for corresponding points.
void expect_not_farther(const Question& x, const Question& y, Tally& tally) {
  Asker ask_x(x.setup);
  Asker ask_y(y.setup);
  const Reference oracle_y(oracle_problem(y.setup));
  const Reference grown_x(oracle_problem(x.setup, x.setup.settings.resolution_m));
  const double rho_m = y.setup.settings.rho_m;
  for (std::size_t i = 0; i < x.points_world.size(); ++i) {
    const double answer_x_m = ask_x.distance(Capsule::point(x.points_world[i])).nearest.distance_m;
    const double answer_y_m = ask_y.distance(Capsule::point(y.points_world[i])).nearest.distance_m;
    const Interval interval_y = oracle_y.distance(y.points_world[i]);
    const Interval interval_x = grown_x.distance(x.points_world[i]);
    EXPECT_LE(answer_x_m, interval_y.hi_m.value_or(rho_m)) << "point " << x.points_world[i].transpose();
    EXPECT_GE(answer_y_m, interval_x.lo_m - kRounding - kDoubleRounding) << "point " << y.points_world[i].transpose();
    tally.telling += answer_x_m > 0 && answer_x_m < rho_m ? 1 : 0;
  }
}

SearchSetup with_cameras(const SearchSetup& setup, const std::vector<std::size_t>& order) {
  SearchSetup result;
  result.rig.name = setup.rig.name;
  result.settings = setup.settings;
  result.settings.margins.clear();
  for (const std::size_t k : order) {
    result.rig.cameras.push_back(setup.rig.cameras[k]);
    result.frames.push_back(setup.frames[k]);
    result.settings.margins.push_back(setup.settings.margins[k]);
  }
  if (auto* frustum = std::get_if<views::FrustumSpace>(&result.settings.space)) {
    frustum->principal =
        static_cast<std::size_t>(std::find(order.begin(), order.end(), frustum->principal) - order.begin());
  }
  return result;
}

SpaceKind random_space(Random& random) { return random.chance(0.5) ? SpaceKind::box : SpaceKind::frustum; }

TEST(Properties, SeveralCamerasKnowAtLeastWhatEachOfThemKnows) {
  Tally tally;
  for_random_problems(100, {}, [&](const RandomProblem& problem, Random&) {
    const SearchSetup all = make_setup(problem, SpaceKind::box);
    for (std::size_t k = 0; k < all.rig.cameras.size(); ++k) {
      expect_not_farther({with_cameras(all, {k}), problem.points_world}, {all, problem.points_world}, tally);
    }
  });
}

/// With one camera the shortfall is at most r, enlarged where e_k grows with the range; so the answer of all cameras
/// falls short of what one of them proves by no more than that.
TEST(Properties, SeveralCamerasAnswerAtLeastTheDistanceOfEachLessTheResolution) {
  Tally tally;
  for_random_problems(100, {}, [&](const RandomProblem& problem, Random&) {
    const SearchSetup all = make_setup(problem, SpaceKind::box);
    Asker asker(all);
    for (std::size_t k = 0; k < all.rig.cameras.size(); ++k) {
      const Reference single(oracle_problem(with_cameras(all, {k})));
      const double shortfall_m = all.settings.resolution_m / (1 - all.settings.margins[k].rotation_rad);
      for (const Vector3d& p : problem.points_world) {
        const double answer_m = asker.distance(Capsule::point(p)).nearest.distance_m;
        const double proven_m = single.distance(p).lo_m;
        EXPECT_GE(answer_m, proven_m - shortfall_m - kRounding - kDoubleRounding)
            << "camera " << k << ", point " << p.transpose();
        tally.telling += proven_m > shortfall_m ? 1 : 0;
      }
    }
  });
}

TEST(Properties, OneMoreCameraNeverBringsObstaclesNearer) {
  Tally tally;
  for_random_problems(100, {}, [&](const RandomProblem& problem, Random& random) {
    const SearchSetup all = make_setup(problem, random_space(random));
    const std::size_t count = all.rig.cameras.size();
    const auto* frustum = std::get_if<views::FrustumSpace>(&all.settings.space);
    std::vector<std::size_t> fewer;
    const auto left_out = static_cast<std::size_t>(random.integer(0, static_cast<int>(count) - 1));
    for (std::size_t k = 0; k < count; ++k) {
      if (k != left_out || (frustum != nullptr && frustum->principal == k)) {
        fewer.push_back(k);
      }
    }
    if (!fewer.empty()) {
      expect_not_farther({with_cameras(all, fewer), problem.points_world}, {all, problem.points_world}, tally);
    }
  });
}

/// The pixel onto which a point near P falls, so that P has to do with it.
void invalidate_pixel_near(RandomProblem& problem, const Vector3d& p_world, Random& random) {
  const auto k = static_cast<std::size_t>(random.integer(0, static_cast<int>(problem.rig.cameras.size()) - 1));
  const RigCamera& camera = problem.rig.cameras[k];
  const DepthPoint at = project(camera.intrinsics, camera.T_world_camera.inverse(Eigen::Isometry) *
                                                       (p_world + random.in_cube(0.5 * problem.rho_m)));
  if (!(at.depth_m > 0 && at.x_px >= 0 && at.y_px >= 0 && at.x_px < camera.intrinsics.width_px &&
        at.y_px < camera.intrinsics.height_px)) {
    return;
  }
  DepthImage& image = problem.views[k].depth_m;
  const std::size_t index = image.index(static_cast<int>(at.x_px), static_cast<int>(at.y_px));
  image.data()[index] = 0;
  if (!problem.units[k].empty()) {
    problem.units[k][index] = 0;
  }
}

TEST(Properties, APixelWithoutMeasurementNeverMovesObstaclesAway) {
  Tally tally;
  for_random_problems(100, {}, [&](const RandomProblem& problem, Random& random) {
    RandomProblem fewer_pixels = reference::make_random_problem(problem.options);
    for (const Vector3d& p_world : problem.points_world) {
      for (int i = 0; i < 3; ++i) {
        invalidate_pixel_near(fewer_pixels, p_world, random);
      }
    }
    const SpaceKind space = random_space(random);
    expect_not_farther({make_setup(fewer_pixels, space), problem.points_world},
                       {make_setup(problem, space), problem.points_world}, tally);
  });
}

TEST(Properties, ALargerSensorMarginNeverMovesObstaclesAway) {
  Tally tally;
  for_random_problems(100, {}, [&](const RandomProblem& problem, Random& random) {
    const SearchSetup setup = make_setup(problem, random_space(random), true);
    SearchSetup larger = setup;
    const auto k = static_cast<std::size_t>(random.integer(0, static_cast<int>(setup.rig.cameras.size()) - 1));
    SensorMargin& sensor = larger.settings.margins[k].sensor;
    switch (random.integer(0, 4)) {
      case 0:
        sensor.constant_m += 0.02;
        break;
      case 1:
        sensor.linear += 0.01;
        break;
      case 2:
        sensor.quadratic_per_m += 0.005;
        break;
      case 3:
        sensor.lateral_px += 1;
        break;
      default:
        larger.rig.cameras[k].rule.near_m += 0.6;
    }
    expect_not_farther({larger, problem.points_world}, {setup, problem.points_world}, tally);
  });
}

TEST(Properties, ALargerErrorOfPoseOrTimeNeverMovesObstaclesAway) {
  Tally tally;
  for_random_problems(100, {}, [&](const RandomProblem& problem, Random& random) {
    SearchSetup setup = make_setup(problem, random_space(random), true);
    const auto k = static_cast<std::size_t>(random.integer(0, static_cast<int>(setup.rig.cameras.size()) - 1));
    setup.settings.v_max_m_s = std::max(setup.settings.v_max_m_s, 1.0);
    setup.settings.margins[k].half_exposure_s += 0.002;
    // Another camera's frame is the newest and stays it, so that t_ref is the same in both questions.
    setup.frames[(k + 1) % setup.frames.size()].time_s += 0.02;
    SearchSetup larger = setup;
    CameraMargins& more = larger.settings.margins[k];
    switch (random.integer(0, 4)) {
      case 0:
        more.translation_m += 0.01;
        break;
      case 1:
        more.rotation_rad += 0.005;
        break;
      case 2:
        larger.settings.v_max_m_s += 1.0;
        break;
      case 3:
        more.time_uncertainty_s += 0.005;
        break;
      default:
        larger.frames[k].time_s -= 0.01;
    }
    expect_not_farther({larger, problem.points_world}, {setup, problem.points_world}, tally);
  });
}

TEST(Properties, AMotionOfEverythingChangesNothing) {
  Tally tally;
  for_random_problems(100, {}, [&](const RandomProblem& problem, Random& random) {
    const Question still{make_setup(problem, SpaceKind::frustum, true), problem.points_world};
    Pose motion = Pose::Identity();
    motion.linear() = Eigen::AngleAxisd(random.uniform(-3, 3), random.direction()).toRotationMatrix();
    motion.translation() = random.in_cube(20);
    Question moved = still;
    for (RigCamera& camera : moved.setup.rig.cameras) {
      camera.T_world_camera = motion * camera.T_world_camera;
    }
    for (Vector3d& p_world : moved.points_world) {
      p_world = motion * p_world;
    }
    expect_not_farther(still, moved, tally);
    expect_not_farther(moved, still, tally);
  });
}

TEST(Properties, ABoxMovedWithEverythingChangesNothing) {
  Tally tally;
  for_random_problems(100, {}, [&](const RandomProblem& problem, Random& random) {
    const Question still{make_setup(problem, SpaceKind::box, true), problem.points_world};
    Pose motion = Pose::Identity();
    // A quarter turn about z keeps the box's axes along the world's.
    motion.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    motion.translation() = random.in_cube(20);
    Question moved = still;
    for (RigCamera& camera : moved.setup.rig.cameras) {
      camera.T_world_camera = motion * camera.T_world_camera;
    }
    for (Vector3d& p_world : moved.points_world) {
      p_world = motion * p_world;
    }
    const auto& box = std::get<views::BoxSpace>(still.setup.settings.space);
    const Vector3d one = motion * box.low_world;
    const Vector3d other = motion * box.high_world;
    moved.setup.settings.space = views::BoxSpace{one.cwiseMin(other), one.cwiseMax(other)};
    expect_not_farther(still, moved, tally);
    expect_not_farther(moved, still, tally);
  });
}

TEST(Properties, TheOrderOfTheCamerasChangesNothing) {
  Tally tally;
  reference::RandomOptions options;
  options.cameras = 3;
  for_random_problems(100, options, [&](const RandomProblem& problem, Random& random) {
    const Question one{make_setup(problem, random_space(random), true), problem.points_world};
    std::vector<std::size_t> order{0, 1, 2};
    std::rotate(order.begin(), order.begin() + random.integer(1, 2), order.end());
    const Question other{with_cameras(one.setup, order), problem.points_world};
    expect_not_farther(one, other, tally);
    expect_not_farther(other, one, tally);
  });
}

/// It makes no difference whether the rig knows where the cameras stand or every frame says so.
TEST(Properties, PosesOfFramesAreThoseOfTheRig) {
  Tally tally;
  for_random_problems(30, {}, [&](const RandomProblem& problem, Random& random) {
    const SearchSetup setup = make_setup(problem, random_space(random), true);
    Rig elsewhere = setup.rig;
    for (RigCamera& camera : elsewhere.cameras) {
      camera.T_world_camera = look_at(random.in_cube(2), random.in_cube(1));
    }
    views::ViewStore store(elsewhere, setup.settings);
    for (std::size_t k = 0; k < setup.frames.size(); ++k) {
      ASSERT_EQ(store.update(k, setup.frames[k], setup.rig.cameras[k].T_world_camera).result, UpdateResult::taken);
    }
    Asker asker(setup);
    Search search;
    for (const Vector3d& p_world : problem.points_world) {
      const Capsule primitive = Capsule::point(p_world);
      Answer answer;
      search.distances(store.snapshot(), {&primitive, 1}, {&answer, 1});
      const Proximity expected = asker.distance(primitive).nearest;
      EXPECT_EQ(answer.nearest.distance_m, expected.distance_m) << p_world.transpose();
      EXPECT_EQ(answer.nearest.state, expected.state) << p_world.transpose();
      tally.telling += expected.distance_m > 0 && expected.distance_m < setup.settings.rho_m ? 1 : 0;
    }
  });
}

/// D <= D: what the oracle says of the same question. Used where a property of the scene is what is hard.
void expect_as_the_oracle(const Question& question, Tally& tally) { expect_not_farther(question, question, tally); }

/// An orientation that is off by degrees makes e_k grow fast with the range, also within one cube.
TEST(Properties, LargeErrorsOfOrientationAreCoveredEverywhere) {
  Tally tally;
  for_random_problems(100, {}, [&](const RandomProblem& problem, Random& random) {
    Question question{make_setup(problem, random_space(random), true), problem.points_world};
    for (CameraMargins& margins : question.setup.settings.margins) {
      margins.rotation_rad = random.uniform(0.02, 0.15);
      margins.translation_m = 0;
      margins.half_exposure_s = margins.time_uncertainty_s = 0;
    }
    expect_as_the_oracle(question, tally);
  });
}

/// The same problem with a share of the robot's pixels without a measurement: islands that only the model explains.
RandomProblem with_islands(const RandomProblem& given, Random& random) {
  RandomProblem problem = reference::make_random_problem(given.options);
  const double share = random.uniform(0, 1);
  for (std::size_t k = 0; k < problem.views.size(); ++k) {
    const simulation::View& view = problem.views[k];
    for (std::size_t i = 0; i < view.depth_m.index(0, view.depth_m.height_px()); ++i) {
      if (view.robot_near_m.data()[i] > 0 && random.chance(share)) {
        problem.views[k].depth_m.data()[i] = 0;
        if (!problem.units[k].empty()) {
          problem.units[k][i] = 0;
        }
      }
    }
  }
  return problem;
}

/// Before, in and behind where the cameras see the robot.
std::vector<Vector3d> points_at_the_robot(const RandomProblem& problem, Random& random) {
  std::vector<Vector3d> points_world;
  for (std::size_t k = 0; k < problem.views.size(); ++k) {
    const RigCamera& camera = problem.rig.cameras[k];
    const DepthImage& near_m = problem.views[k].robot_near_m;
    for (int attempt = 0; attempt < 200 && points_world.size() < 2 * (k + 1); ++attempt) {
      const int u = random.integer(0, near_m.width_px() - 1);
      const int v = random.integer(0, near_m.height_px() - 1);
      if (near_m.at(u, v) > 0) {
        const double z_m = static_cast<double>(near_m.at(u, v)) + random.uniform(-0.05, 0.2);
        points_world.push_back(camera.T_world_camera * deproject(camera.intrinsics, {u + 0.5, v + 0.5, z_m}));
      }
    }
  }
  return points_world;
}

reference::RandomOptions with_robot() {
  reference::RandomOptions options;
  options.robot = true;
  options.margins = false;
  return options;
}

/// Pixels of the robot without a measurement, and obstacles before it, leave islands that are the robot and nothing
/// else.
TEST(Properties, RobotsBehindMissingMeasurementsAreNoMoreThanRobots) {
  Tally tally;
  for_random_problems(100, with_robot(), [&](const RandomProblem& given, Random& random) {
    const RandomProblem problem = with_islands(given, random);
    Question question{make_setup(problem, random_space(random)), {}};
    question.points_world = points_at_the_robot(problem, random);
    expect_as_the_oracle(question, tally);
  });
}

/// Whatever a store took before: a robot in the images that has gone leaves nothing behind, and one that has come finds
/// nothing left.
TEST(Properties, OnlyTheNewestFramesCount) {
  Tally tally;
  for_random_problems(60, with_robot(), [&](const RandomProblem& given, Random& random) {
    const RandomProblem problem = with_islands(given, random);
    const std::vector<Vector3d> points_world = points_at_the_robot(problem, random);
    const SearchSetup robot = make_setup(problem, random_space(random));
    const SearchSetup none = [&] {
      SearchSetup result = robot;
      for (Frame& frame : result.frames) {
        frame.robot = {};
      }
      return result;
    }();
    const auto take = [](views::ViewStore& store, const SearchSetup& setup, int times) {
      for (int n = 0; n < times; ++n) {
        for (std::size_t k = 0; k < setup.frames.size(); ++k) {
          ASSERT_EQ(store.update(k, setup.frames[k]).result, UpdateResult::taken);
        }
      }
    };
    for (const auto& [before, now] : {std::pair{&robot, &none}, std::pair{&none, &robot}}) {
      views::ViewStore store(now->rig, now->settings);
      take(store, *before, 5);  // every buffer once
      take(store, *now, 1);
      Asker fresh(*now);
      Search search;
      for (const Vector3d& p_world : points_world) {
        const Capsule primitive = Capsule::point(p_world);
        Answer answer;
        search.distances(store.snapshot(), {&primitive, 1}, {&answer, 1});
        const Proximity expected = fresh.distance(primitive).nearest;
        EXPECT_EQ(answer.nearest.distance_m, expected.distance_m) << p_world.transpose();
        EXPECT_EQ(answer.nearest.state, expected.state) << p_world.transpose();
        tally.telling += expected.distance_m > 0 && expected.distance_m < now->settings.rho_m ? 1 : 0;
      }
    }
  });
}

}  // namespace
}  // namespace depthgrid::search
