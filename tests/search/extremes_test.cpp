// Where evaluators go wrong: outside, behind, on top of cameras, with nothing to see, far from the origin, and with
// settings at the ends of their ranges.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "depthgrid/core/pixel_frustum.hpp"
#include "search/search_setup.hpp"

namespace depthgrid::search {
namespace {

using Eigen::Vector3d;
using reference::Interval;
using reference::Random;
using reference::RandomProblem;
using reference::Reference;

/// One camera at the origin that looks along z at a wall, W a box around both.
struct OneCamera {
  static constexpr int kWidthPx = 64;
  static constexpr int kHeightPx = 48;
  std::vector<float> image_m;
  SearchSetup setup;

  explicit OneCamera(float wall_m = 2.0F, int width_px = kWidthPx, int height_px = kHeightPx)
      : image_m(static_cast<std::size_t>(width_px * height_px), wall_m) {
    RigCamera camera;
    camera.id = "front";
    camera.intrinsics = {width_px, height_px, 50, 50, 0.5 * width_px, 0.5 * height_px};
    camera.rule.near_m = 0.3;
    setup.rig.name = "one camera";
    setup.rig.cameras = {camera};
    setup.frames.resize(1);
    refer();
    setup.settings.space = views::BoxSpace{{-3, -3, -3}, {3, 3, 3}};
    setup.settings.policies = {views::Policy::obstacle, views::Policy::obstacle, views::Policy::obstacle, 0};
    setup.settings.margins = {CameraMargins{SensorMargin{0, 0, 0, 0}}};
    setup.settings.v_max_m_s = 0;
  }
  void refer() {
    const PinholeCamera& pinhole = setup.rig.cameras[0].intrinsics;
    setup.frames[0].depth = depth_view(image_m, pinhole.width_px, pinhole.height_px);
  }
};

/// Both ends of what the oracle allows.
void expect_within_oracle(const SearchSetup& setup, const Vector3d& p_world) {
  const double rho_m = setup.settings.rho_m;
  const double answer_m = Asker(setup).distance(Capsule::point(p_world)).nearest.distance_m;
  const Interval exact = Reference(oracle_problem(setup)).distance(p_world);
  const Interval grown = Reference(oracle_problem(setup, setup.settings.resolution_m)).distance(p_world);
  EXPECT_LE(answer_m, exact.hi_m.value_or(rho_m)) << "point " << p_world.transpose();
  EXPECT_GE(answer_m, grown.lo_m - kRounding - kDoubleRounding) << "point " << p_world.transpose();
}

TEST(Outside, IsAtDistanceZeroWhereItIsAnObstacle) {
  const OneCamera one;
  for (const Vector3d& p : {Vector3d(3.001, 0, 1), Vector3d(0, 0, 3.5), Vector3d(1e6, 0, 0), Vector3d(0, -1e4, 1e4)}) {
    const Answer answer = Asker(one.setup).distance(Capsule::point(p));
    EXPECT_EQ(answer.nearest.distance_m, 0) << p.transpose();
    EXPECT_EQ(answer.nearest.state, ProximityState::outside) << p.transpose();
  }
}

TEST(Outside, HasNoDistanceWhereItIsIgnored) {
  OneCamera one;
  one.setup.settings.policies.outside = views::Policy::ignored;
  for (const Vector3d& p : {Vector3d(3.001, 0, 1), Vector3d(0, 0, 3.5), Vector3d(1e6, 0, 0), Vector3d(0, -1e4, 1e4)}) {
    const Answer answer = Asker(one.setup).distance(Capsule::point(p));
    EXPECT_TRUE(std::isnan(answer.nearest.distance_m)) << p.transpose();
    EXPECT_EQ(answer.nearest.state, ProximityState::outside) << p.transpose();
  }
}

TEST(Outside, BeginsAtKnownToWhereItIsIgnored) {
  OneCamera one(5.0F);
  one.setup.settings.policies.outside = views::Policy::ignored;
  one.setup.settings.rho_m = 2.0;
  Asker asker(one.setup);
  for (const Vector3d& p : {Vector3d(0, 0, 2.75), Vector3d(0, 0, 1.0), Vector3d(0.1, 0.1, 2.999)}) {
    const double border_m = std::min({3 - p.z(), 3 - std::abs(p.x()), 3 - std::abs(p.y())});
    EXPECT_NEAR(asker.distance(Capsule::point(p)).nearest.known_to_m, border_m, 1e-5) << p.transpose();
    EXPECT_LE(asker.distance(Capsule::point(p)).nearest.known_to_m, border_m) << p.transpose();
  }
  one.setup.settings.policies.outside = views::Policy::obstacle;
  EXPECT_TRUE(std::isnan(Asker(one.setup).distance(Capsule::point({0, 0, 1})).nearest.known_to_m))
      << "nothing is ignored";
}

TEST(Cameras, SeeNothingBehindThem) {
  OneCamera one;
  for (const Vector3d& p : {Vector3d(0, 0, -1), Vector3d(1, 1, -0.001), Vector3d(-2, 0, -2.5)}) {
    const Answer answer = Asker(one.setup).distance(Capsule::point(p));
    EXPECT_EQ(answer.nearest.distance_m, 0) << p.transpose();
    EXPECT_EQ(answer.nearest.state, ProximityState::unobserved) << p.transpose();
  }
  one.setup.settings.policies.unobserved = views::Policy::ignored;
  one.setup.settings.policies.outside = views::Policy::ignored;
  for (const Vector3d& p : {Vector3d(0, 0, -1), Vector3d(-2, 0, -2.5)}) {
    const Answer answer = Asker(one.setup).distance(Capsule::point(p));
    EXPECT_EQ(answer.nearest.state, ProximityState::beyond_rho) << p.transpose();
    EXPECT_EQ(answer.nearest.distance_m, one.setup.settings.rho_m) << p.transpose();
  }
}

TEST(Cameras, SeeNothingInTheirOwnPlace) {
  const OneCamera one;
  const Answer answer = Asker(one.setup).distance(Capsule::point(Vector3d::Zero()));
  EXPECT_EQ(answer.nearest.distance_m, 0);
  EXPECT_TRUE(answer.nearest.state == ProximityState::unobserved || answer.nearest.state == ProximityState::unmeasured);
}

TEST(Cameras, FreeNothingNearerThanTheirBlindZoneEnds) {
  OneCamera one(4.0F);
  one.setup.settings.rho_m = 0.4;
  for (const double near_m : {0.2, 1.0, 2.0}) {
    one.setup.rig.cameras[0].rule.near_m = near_m;
    for (const double beyond_m : {-0.1, -0.001, 0.001, 0.02, 0.1, 0.2, 0.3, 0.39}) {
      expect_within_oracle(one.setup, {0.01, -0.02, near_m + beyond_m});
      expect_within_oracle(one.setup, {0.1 * near_m, 0.05 * near_m, near_m + beyond_m});
    }
  }
}

TEST(Cameras, DoNotTakeTheRobotInTheirBlindZoneForAnObstacle) {
  // Nothing is measured; a link fills the depths around the end of the blind zone (0.3 m).
  OneCamera one(0.0F);
  const std::vector<float> near_m(one.image_m.size(), 0.1F);
  const std::vector<float> far_m(one.image_m.size(), 0.4F);
  one.setup.frames[0].robot = {near_m.data(), far_m.data()};
  for (const double z_m : {0.12, 0.2, 0.29, 0.31, 0.38}) {
    SCOPED_TRACE(z_m);
    expect_within_oracle(one.setup, {0, 0, z_m});
  }
  EXPECT_GT(Asker(one.setup).distance(Capsule::point({0, 0, 0.2})).nearest.distance_m, 0.08);
}

TEST(Cameras, DoNotTakeTheRobotInTheirBlindZoneForAnObstacleInFreeSpaceEither) {
  // A wall is measured far behind the link, so that all of the link but what lies in the blind zone (to 0.3 m) is free.
  for (const float exit_m : {0.2F, 0.29F, 0.3F, 0.31F, 0.4F}) {
    OneCamera one(4.0F);
    const std::vector<float> near_m(one.image_m.size(), 0.1F);
    const std::vector<float> far_m(one.image_m.size(), exit_m);
    one.setup.frames[0].robot = {near_m.data(), far_m.data()};
    for (const double z_m : {0.05, 0.12, 0.15, 0.19, 0.25, 0.295, 0.305, 0.35, 0.45}) {
      SCOPED_TRACE(testing::Message() << "link to " << exit_m << " m, point at " << z_m << " m");
      expect_within_oracle(one.setup, {0, 0, z_m});
    }
    EXPECT_GT(Asker(one.setup).distance(Capsule::point({0, 0, 0.15})).nearest.distance_m, 0.045);
  }
}

TEST(Cameras, CanBeSeenFreeByAnother) {
  OneCamera one(4.0F);
  RigCamera other = one.setup.rig.cameras[0];
  other.id = "behind";
  other.T_world_camera.translation() = Vector3d(0, 0, -2);
  one.setup.rig.cameras.push_back(other);
  one.setup.frames.push_back(one.setup.frames[0]);
  one.setup.settings.margins.push_back(one.setup.settings.margins[0]);
  one.setup.settings.rho_m = 1.5;
  for (const Vector3d& p : {Vector3d(0, 0, 0), Vector3d(0, 0, 1e-7), Vector3d(0, 0, -1e-12), Vector3d(0, 0, 0.3)}) {
    expect_within_oracle(one.setup, p);
    EXPECT_GT(Asker(one.setup).distance(Capsule::point(p)).nearest.distance_m, 0.5) << p.transpose();
  }
}

TEST(Snapshots, WithoutAnyFrameFreeNothing) {
  OneCamera one;
  const views::ViewStore store(one.setup.rig, one.setup.settings);
  const views::Snapshot snapshot = store.snapshot();
  EXPECT_TRUE(snapshot.stale());
  EXPECT_TRUE(std::isnan(snapshot.reference_time_s()));
  Search search;
  const std::vector<Capsule> primitives{Capsule::point({0, 0, 1}), Capsule::point({0, 0, -1}),
                                        Capsule::point({0, 0, 0.1}), Capsule::point({2.5, 0, 0.5})};
  std::vector<Answer> answers(primitives.size());
  search.distances(snapshot, primitives, answers);
  const std::vector<ProximityState> states{ProximityState::unmeasured, ProximityState::unobserved,
                                           ProximityState::unmeasured, ProximityState::unobserved};
  for (std::size_t i = 0; i < answers.size(); ++i) {
    EXPECT_EQ(answers[i].nearest.distance_m, 0) << i;
    EXPECT_EQ(answers[i].nearest.state, states[i]) << i;
    EXPECT_TRUE(answers[i].nearest.stale) << i;
  }
}

TEST(Snapshots, WithoutAnyFrameLeaveTheIgnoredOut) {
  OneCamera one;
  one.setup.settings.policies.unobserved = views::Policy::ignored;
  one.setup.settings.policies.outside = views::Policy::ignored;
  const views::ViewStore store(one.setup.rig, one.setup.settings);
  Search search;
  const auto ask = [&](const Vector3d& p) {
    const Capsule primitive = Capsule::point(p);
    Answer answer;
    search.distances(store.snapshot(), {&primitive, 1}, {&answer, 1});
    return answer.nearest;
  };
  EXPECT_EQ(ask({0, 0, 1}).state, ProximityState::unmeasured);
  EXPECT_EQ(ask({0, 0, 1}).distance_m, 0);
  EXPECT_EQ(ask({0, 0, -1}).state, ProximityState::beyond_rho);
  // 0.1 m before the camera's view begins: at the blind zone's end, or beside the view's border.
  const double before_m = ask({0, 0, 0.2}).distance_m;
  EXPECT_LE(before_m, 0.1);
  EXPECT_GE(before_m, 0.1 - one.setup.settings.resolution_m - kRounding - kDoubleRounding);
}

TEST(Snapshots, AreStaleWithoutATimeOrWithAnOldFrame) {
  OneCamera one;
  one.setup.settings.max_frame_age_s = 0.1;
  RigCamera other = one.setup.rig.cameras[0];
  other.id = "other";
  one.setup.rig.cameras.push_back(other);
  one.setup.frames.push_back(one.setup.frames[0]);
  one.setup.settings.margins.push_back(one.setup.settings.margins[0]);
  const auto stale = [&](double first_s, double second_s) {
    one.setup.frames[0].time_s = first_s;
    one.setup.frames[1].time_s = second_s;
    return Asker(one.setup).distance(Capsule::point({0, 0, 1})).nearest.stale;
  };
  EXPECT_FALSE(stale(10, 10));
  EXPECT_FALSE(stale(10, 10.09));
  EXPECT_TRUE(stale(10, 10.11));
  EXPECT_TRUE(stale(10.11, 10));
  EXPECT_TRUE(stale(std::nan(""), 10));
  EXPECT_TRUE(stale(10, HUGE_VAL));
  EXPECT_TRUE(stale(-HUGE_VAL, 10));
}

/// A camera with a frame that has no time may have seen obstacles anywhere, unless they do not move.
TEST(Snapshots, FreeNothingThroughACameraWithoutATime) {
  for (const double time_s : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    OneCamera one;
    one.setup.frames[0].time_s = time_s;
    EXPECT_GT(Asker(one.setup).distance(Capsule::point({0, 0, 1})).nearest.distance_m, 0)
        << time_s << " s, nothing moves";
    one.setup.settings.v_max_m_s = 1;
    EXPECT_EQ(Asker(one.setup).distance(Capsule::point({0, 0, 1})).nearest.distance_m, 0) << time_s << " s";
    EXPECT_TRUE(Asker(one.setup).distance(Capsule::point({0, 0, 1})).nearest.stale) << time_s << " s";
    // Beside a camera whose time is known.
    RigCamera other = one.setup.rig.cameras[0];
    other.id = "turned away";
    other.T_world_camera.linear() = Eigen::AngleAxisd(3, Vector3d::UnitY()).toRotationMatrix();
    one.setup.rig.cameras.push_back(other);
    one.setup.frames.push_back(one.setup.frames[0]);
    one.setup.frames[1].time_s = 10;
    one.setup.settings.margins.push_back(one.setup.settings.margins[0]);
    EXPECT_EQ(Asker(one.setup).distance(Capsule::point({0, 0, 1})).nearest.distance_m, 0) << time_s << " s and 10 s";
    EXPECT_TRUE(Asker(one.setup).distance(Capsule::point({0, 0, 1})).nearest.stale) << time_s << " s and 10 s";
  }
}

/// What a camera covers is geometry: without a frame, or with one that cannot be used, it covers the space before the
/// place where it stands, which is not seen free. Only that counts here.
TEST(Snapshots, KnowWhereACameraWithoutAFrameStands) {
  OneCamera one;
  one.setup.settings.policies.unobserved = views::Policy::ignored;
  one.setup.settings.policies.outside = views::Policy::ignored;
  one.setup.settings.rho_m = 0.2;
  const Pose at_rig = look_at(Vector3d(1, 0, 0), Vector3d(1, 1, 0));
  const Pose moved = look_at(Vector3d(-1, 0, 0), Vector3d(-1, 1, 0));
  one.setup.rig.cameras[0].T_world_camera = at_rig;
  views::ViewStore store(one.setup.rig, one.setup.settings);
  Search search;
  const auto distance_m = [&](const Vector3d& p_world) {
    const Capsule primitive = Capsule::point(p_world);
    Answer answer;
    search.distances(store.snapshot(), {&primitive, 1}, {&answer, 1});
    return answer.nearest.distance_m;
  };
  const Vector3d before_rig = at_rig * Vector3d(0, 0, 1);
  const Vector3d before_moved = moved * Vector3d(0, 0, 1);
  EXPECT_EQ(distance_m(before_rig), 0) << "no frame yet";
  EXPECT_EQ(distance_m(before_moved), 0.2) << "no frame yet";
  Frame unusable;
  for (int i = 0; i < 5; ++i) {  // every buffer once
    EXPECT_EQ(store.update(0, one.setup.frames[0], moved).result, UpdateResult::taken);
    EXPECT_EQ(distance_m(before_rig), 0.2) << "moved away";
    EXPECT_EQ(store.update(0, unusable).result, UpdateResult::unusable);
    EXPECT_EQ(distance_m(before_rig), 0) << "an unusable frame from where the rig says, " << i;
    EXPECT_EQ(distance_m(before_moved), 0.2) << "an unusable frame from where the rig says, " << i;
    EXPECT_EQ(store.update(0, one.setup.frames[0]).result, UpdateResult::taken);
    EXPECT_EQ(store.update(0, unusable, moved).result, UpdateResult::unusable);
    EXPECT_EQ(distance_m(before_moved), 0) << "an unusable frame from elsewhere, " << i;
    EXPECT_EQ(distance_m(before_rig), 0.2) << "an unusable frame from elsewhere, " << i;
  }
}

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

TEST(Extremes, AnImageWithoutMeasurementsFreesNothing) {
  OneCamera one(0.0F);
  const Answer answer = Asker(one.setup).distance(Capsule::point({0, 0, 1}));
  EXPECT_EQ(answer.nearest.distance_m, 0);
  EXPECT_EQ(answer.nearest.state, ProximityState::unmeasured);
}

}  // namespace
}  // namespace depthgrid::search
