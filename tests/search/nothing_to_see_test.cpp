// Where evaluators go wrong: outside, behind and on top of cameras, and with nothing to see.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "search/one_camera.hpp"
#include "search/search_setup.hpp"

namespace depthgrid::search {
namespace {

using Eigen::Vector3d;

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

}  // namespace
}  // namespace depthgrid::search
