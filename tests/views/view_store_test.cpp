// The store of prepared images: which frame a snapshot shows, how long it keeps it, and what its margins are.
#include "depthgrid/views/view_store.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "support/allocation_guard.hpp"

namespace depthgrid::views {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr int kSide = 4;

Rig rig_of(std::size_t count) {
  Rig rig{.name = "cell", .cameras = std::vector<RigCamera>(count), .T_floor_world = {}};
  for (std::size_t k = 0; k < count; ++k) {
    rig.cameras[k].id = std::to_string(k);
    rig.cameras[k].intrinsics = {kSide, kSide, 10, 10, 2, 2};
    rig.cameras[k].T_world_camera.translation().x() = static_cast<double>(k);
  }
  return rig;
}

Settings settings_for(std::size_t count) {
  Settings settings;
  settings.space = BoxSpace{{-1, -1, 0}, {1, 1, 2}};
  settings.policies = {Policy::obstacle, Policy::ignored, Policy::obstacle, 0};
  settings.margins.resize(count);
  for (CameraMargins& margins : settings.margins) {
    margins.sensor.lateral_px = 0;
    margins.smallest_obstacle_m = 0;
  }
  settings.v_max_m_s = 2;
  return settings;
}

/// A frame that sees one depth everywhere.
struct Wall {
  explicit Wall(float depth_m, double exposed_s = 0) : metres(kSide * kSide, depth_m), time_s(exposed_s) {}
  [[nodiscard]] Frame frame() const { return {depth_view(metres, kSide, kSide), {}, time_s}; }
  std::vector<float> metres;
  double time_s;
};

float free_m(const Snapshot& snapshot, std::size_t camera = 0) { return snapshot.view(camera).free_m(1, 2); }

TEST(ViewStore, FreesNothingBeforeTheFirstFrame) {
  const ViewStore store(rig_of(2), settings_for(2));
  const Snapshot snapshot = store.snapshot();
  EXPECT_EQ(snapshot.camera_count(), 2U);
  EXPECT_FALSE(snapshot.view(0).present());
  EXPECT_EQ(free_m(snapshot), 0.0F);
  EXPECT_TRUE(std::isnan(snapshot.reference_time_s()));
  EXPECT_TRUE(snapshot.stale());
}

TEST(ViewStore, ASnapshotKeepsWhatItShowed) {
  ViewStore store(rig_of(2), settings_for(2));
  EXPECT_EQ(store.update(0, Wall(1.0F, 10.0).frame()).result, UpdateResult::taken);
  const Snapshot first = store.snapshot();
  EXPECT_EQ(store.update(0, Wall(2.0F, 10.1).frame()).result, UpdateResult::taken);
  EXPECT_EQ(store.update(1, Wall(3.0F, 10.2).frame()).result, UpdateResult::taken);
  const Snapshot second = store.snapshot();
  EXPECT_EQ(free_m(first, 0), 1.0F);
  EXPECT_EQ(free_m(first, 1), 0.0F);
  EXPECT_EQ(first.reference_time_s(), 10.0);
  EXPECT_TRUE(first.stale()) << "camera 1 was missing";
  EXPECT_EQ(free_m(second, 0), 2.0F);
  EXPECT_EQ(free_m(second, 1), 3.0F);
  EXPECT_EQ(second.reference_time_s(), 10.2);
  EXPECT_FALSE(second.stale());
}

TEST(ViewStore, DropsAFrameOnlyWhenHeldSnapshotsOccupyEveryBuffer) {
  for (const int held : {1, 2, 13}) {
    ViewStore store(rig_of(1), settings_for(1), held);
    std::vector<Snapshot> snapshots;
    float depth_m = 1;
    for (int n = 0; n <= held; ++n, ++depth_m) {
      ASSERT_EQ(store.update(0, Wall(depth_m).frame()).result, UpdateResult::taken) << held << " held, frame " << n;
      snapshots.push_back(store.snapshot());
    }
    // One snapshot more than promised is held: the newest image is pinned, and every other buffer.
    ASSERT_EQ(store.update(0, Wall(depth_m).frame()).result, UpdateResult::taken) << "the last buffer";
    EXPECT_EQ(store.update(0, Wall(99).frame()).result, UpdateResult::dropped);
    EXPECT_EQ(free_m(store.snapshot()), depth_m) << "the frame before stays the newest";
    for (int n = 0; n <= held; ++n) {
      EXPECT_EQ(free_m(snapshots[static_cast<std::size_t>(n)]), static_cast<float>(n + 1));
    }
    snapshots.erase(snapshots.begin());
    EXPECT_EQ(store.update(0, Wall(99).frame()).result, UpdateResult::taken) << "a release makes room";
    for (int n = 0; n < 40; ++n) {
      EXPECT_EQ(store.update(0, Wall(100).frame()).result, UpdateResult::taken)
          << "without new snapshots there is always room";
    }
  }
}

TEST(ViewStore, MovedSnapshotsReleaseOnce) {
  ViewStore store(rig_of(1), settings_for(1), 1);
  for (int n = 1; n < 50; ++n) {
    const auto depth_m = static_cast<float>(n);
    ASSERT_EQ(store.update(0, Wall(depth_m).frame()).result, UpdateResult::taken) << n;
    Snapshot a = store.snapshot();
    Snapshot b = std::move(a);
    Snapshot& same = b;
    b = std::move(same);
    EXPECT_EQ(free_m(b), depth_m);
    a = std::move(b);
    EXPECT_EQ(free_m(a), depth_m);
    b = store.snapshot();
    a = std::move(b);
    EXPECT_EQ(free_m(a), depth_m);
  }
}

// Every number of a snapshot goes with it, whatever stood where it goes to.
TEST(ViewStore, MovedSnapshotsAreWhatTheyWere) {
  Settings settings = settings_for(2);
  settings.margins[0].translation_m = 0.01;
  const std::vector<float> metres(kSide * kSide, 1.0F);
  const std::vector<float> near_m(kSide * kSide, 0.9F);
  const std::vector<float> far_m(kSide * kSide, 1.1F);
  // One with everything: late, stale, a layer, another time; and one with nothing of it.
  ViewStore full(rig_of(2), settings);
  ViewStore plain(rig_of(1), settings_for(1));
  Frame robot{depth_view(metres, kSide, kSide), {near_m.data(), far_m.data(), kSide, 0.05, 2.0}, 3.0};
  ASSERT_TRUE(full.update(0, robot).taken());
  ASSERT_TRUE(plain.update(0, Wall(2.0F, 8.0).frame()).taken());
  const auto expect_full = [](const Snapshot& snapshot) {
    EXPECT_EQ(snapshot.camera_count(), 2U);
    EXPECT_TRUE(snapshot.stale());
    EXPECT_TRUE(snapshot.late(0));
    EXPECT_EQ(snapshot.late_cameras(), 1U);
    EXPECT_EQ(snapshot.reference_time_s(), 3.0);
    EXPECT_NEAR(snapshot.blind_m(), 0.06, 1e-12);
    EXPECT_EQ(snapshot.pose_margin(0).translation_m, 0.01);
    EXPECT_GT(free_m(snapshot), 1.0F) << "the robot counts as free";
  };
  const auto expect_plain = [](const Snapshot& snapshot) {
    EXPECT_EQ(snapshot.camera_count(), 1U);
    EXPECT_FALSE(snapshot.stale());
    EXPECT_FALSE(snapshot.late(0));
    EXPECT_EQ(snapshot.reference_time_s(), 8.0);
    EXPECT_EQ(snapshot.blind_m(), 0);
    EXPECT_EQ(snapshot.pose_margin(0).translation_m, 0);
    EXPECT_EQ(free_m(snapshot), 2.0F);
  };
  Snapshot a = full.snapshot(4.0);
  Snapshot b = plain.snapshot(4.0);
  expect_full(a);
  expect_plain(b);
  Snapshot c(std::move(a));
  expect_full(c);
  a = std::move(b);
  expect_plain(a);
  a = std::move(c);
  expect_full(a);
  a = plain.snapshot(4.0);
  expect_plain(a);
}

TEST(ViewStore, AnUnusableFrameFreesNothing) {
  ViewStore store(rig_of(2), settings_for(2));
  ASSERT_EQ(store.update(0, Wall(1.0F).frame()).result, UpdateResult::taken);
  EXPECT_EQ(store.update(0, Frame{}).result, UpdateResult::unusable);
  EXPECT_EQ(free_m(store.snapshot()), 0.0F);
  EXPECT_FALSE(store.snapshot().view(0).present());
  EXPECT_EQ(store.update(2, Wall(1.0F).frame()).result, UpdateResult::unusable) << "no such camera";
  EXPECT_EQ(store.update(99, Wall(1.0F).frame(), Pose::Identity()).result, UpdateResult::unusable) << "no such camera";
}

TEST(ViewStore, SaysWhyAFrameIsUnusable) {
  ViewStore store(rig_of(2), settings_for(2));
  const Wall wall(1.0F);
  EXPECT_STREQ(store.update(0, wall.frame()).reason, "");
  EXPECT_STREQ(store.update(1, wall.frame(), Pose::Identity()).reason, "");
  const auto expect = [&](const char* words, const auto& change) {
    Frame frame = wall.frame();
    change(frame);
    const FrameUpdate update = store.update(0, frame);
    EXPECT_EQ(update.result, UpdateResult::unusable) << words;
    EXPECT_NE(std::string(update.reason).find(words), std::string::npos) << update.reason;
  };
  const float some_m = 1.0F;
  expect("no depth image", [](Frame& f) { f.depth.data = nullptr; });
  expect("another size", [](Frame& f) { ++f.depth.width_px; });
  expect("image's rows overlap", [](Frame& f) { f.depth.stride_bytes = 1; });
  expect("only one of", [&](Frame& f) { f.robot.near_m = &some_m; });
  expect("view's rows overlap", [&](Frame& f) { f.robot = {&some_m, &some_m, 1}; });
  expect("another scale", [](Frame& f) {
    f.depth.format = DepthFormat::uint16_units;
    f.depth.metres_per_unit = 0.5;
  });
  EXPECT_STREQ(store.update(2, wall.frame()).reason, "the rig has no such camera");
  Pose broken = Pose::Identity();
  broken.translation().x() = kNaN;
  EXPECT_NE(std::string(store.update(0, wall.frame(), broken).reason).find("rigid"), std::string::npos);
}

TEST(ViewStore, MovesACameraWithItsFrame) {
  ViewStore store(rig_of(2), settings_for(2));
  const Wall wall(1.0F);
  EXPECT_EQ(store.update(1, wall.frame()).result, UpdateResult::taken);
  EXPECT_EQ(store.snapshot().view(1).T_world_camera().translation().x(), 1.0) << "where the rig says";
  Pose moved = Pose::Identity();
  moved.translation() = Eigen::Vector3d(1, 2, 3);
  EXPECT_EQ(store.update(1, wall.frame(), moved).result, UpdateResult::taken);
  EXPECT_EQ(store.snapshot().view(1).T_world_camera().translation(), moved.translation());
  Pose inexact = moved;
  inexact.linear() *= 1.0002;
  EXPECT_EQ(store.update(1, wall.frame(), inexact).result, UpdateResult::taken);
  EXPECT_TRUE(store.snapshot().view(1).T_world_camera().linear().isIdentity(1e-12)) << "repaired";
  const auto refused = [&](const char* why, const auto& change) {
    ASSERT_EQ(store.update(1, wall.frame(), moved).result, UpdateResult::taken);
    Pose broken = moved;
    change(broken);
    EXPECT_EQ(store.update(1, wall.frame(), broken).result, UpdateResult::unusable) << why;
    EXPECT_EQ(free_m(store.snapshot(), 1), 0.0F) << why;
    EXPECT_EQ(store.snapshot().T_world_camera(1).translation(), moved.translation()) << "stays where it was: " << why;
  };
  refused("not a number", [](Pose& p) { p.translation().y() = kNaN; });
  refused("infinite", [](Pose& p) { p.translation().y() = kInf; });
  refused("too far away", [](Pose& p) { p.translation().y() = 2e5; });
  refused("scaled", [](Pose& p) { p.linear() *= 1.01; });
  refused("a reflection", [](Pose& p) { p.linear().col(0) *= -1.0; });
  refused("rotation not a number", [](Pose& p) { p.linear()(1, 1) = kNaN; });
  refused("no transform", [](Pose& p) { p.matrix()(3, 3) = 2.0; });
}

TEST(ViewStore, PoseMarginsFollowTheTimes) {
  Settings settings = settings_for(3);
  settings.margins[0] = {{}, 0.01, 0.002, 0.005, 0.001, 0};
  settings.margins[1] = {{}, 0.03, 0.004, 0.015, 0.002, 0};
  settings.max_frame_age_s = 0.05;
  ViewStore store(rig_of(3), settings);
  (void)store.update(0, Wall(1.0F, 100.0).frame());
  (void)store.update(1, Wall(1.0F, 99.96).frame());
  Snapshot snapshot = store.snapshot();
  EXPECT_EQ(snapshot.reference_time_s(), 100.0);
  EXPECT_EQ(snapshot.pose_margin(0).translation_m, 0.01);
  EXPECT_EQ(snapshot.pose_margin(0).rotation_rad, 0.002);
  EXPECT_NEAR(snapshot.pose_margin(0).time_m, 1.002 * 2 * (0.005 + 0.001), 1e-12);
  EXPECT_EQ(snapshot.pose_margin(1).translation_m, 0.03);
  EXPECT_EQ(snapshot.pose_margin(1).rotation_rad, 0.004);
  EXPECT_NEAR(snapshot.pose_margin(1).time_m, 1.004 * 2 * (0.04 + 0.015 + 0.002), 1e-12);
  EXPECT_TRUE(snapshot.stale()) << "camera 2 is missing";
  (void)store.update(2, Wall(1.0F, 99.97).frame());
  EXPECT_FALSE(store.snapshot().stale());
  (void)store.update(1, Wall(1.0F, 99.94).frame());
  EXPECT_TRUE(store.snapshot().stale()) << "camera 1 is too old";
}

TEST(ViewStore, ACameraWithoutATimeFreesNothingThatMayMove) {
  for (const double time_s : {kNaN, kInf, -kInf}) {
    ViewStore store(rig_of(2), settings_for(2));
    (void)store.update(0, Wall(1.0F, 5.0).frame());
    EXPECT_EQ(store.update(1, Wall(1.0F, time_s).frame()).result, UpdateResult::taken);
    const Snapshot snapshot = store.snapshot();
    EXPECT_EQ(snapshot.reference_time_s(), 5.0);
    EXPECT_TRUE(snapshot.stale());
    EXPECT_EQ(snapshot.pose_margin(0).time_m, 0.0);
    EXPECT_EQ(snapshot.pose_margin(1).time_m, 1e9) << "anything may have got anywhere";
  }
  Settings still = settings_for(2);
  still.v_max_m_s = 0;
  ViewStore store(rig_of(2), still);
  (void)store.update(0, Wall(1.0F, 5.0).frame());
  (void)store.update(1, Wall(1.0F, kNaN).frame());
  EXPECT_TRUE(store.snapshot().stale());
  EXPECT_EQ(store.snapshot().pose_margin(1).time_m, 0.0) << "nothing moves";
  (void)store.update(0, Wall(1.0F, kNaN).frame());
  EXPECT_TRUE(std::isnan(store.snapshot().reference_time_s()));
}

TEST(ViewStore, TimesFarApartStayFinite) {
  ViewStore store(rig_of(2), settings_for(2));
  (void)store.update(0, Wall(1.0F, 1.7e308).frame());
  (void)store.update(1, Wall(1.0F, -1.7e308).frame());
  EXPECT_EQ(store.snapshot().pose_margin(0).time_m, 0.0);
  EXPECT_EQ(store.snapshot().pose_margin(1).time_m, 1e9);
}

TEST(ViewStore, SixteenCamerasHaveBuffersOfTheirOwn) {
  ViewStore store(rig_of(16), settings_for(16), 13);
  std::vector<Snapshot> held;
  for (std::size_t k = 0; k < 16; ++k) {
    // Different numbers of frames, so that every camera's newest buffer is another one.
    for (std::size_t n = 0; n <= k && held.size() < 13; ++n) {
      (void)store.update(k, Wall(static_cast<float>(100 * k + n + 1)).frame());
    }
    (void)store.update(k, Wall(static_cast<float>(1000 + k)).frame());
    if (held.size() < 13) {
      held.push_back(store.snapshot());
    }
  }
  for (std::size_t k = 0; k < 16; ++k) {
    EXPECT_EQ(free_m(store.snapshot(), k), static_cast<float>(1000 + k));
    EXPECT_EQ(free_m(held.back(), k), k < held.size() ? static_cast<float>(1000 + k) : 0.0F);
  }
}

TEST(ViewStore, AllocatesNothingAfterConstruction) {
  DEPTHGRID_REQUIRE_ALLOCATION_COUNT();
  ViewStore store(rig_of(2), settings_for(2), 1);
  const Wall wall(1.0F);
  Pose moved = Pose::Identity();
  moved.translation().x() = 1;
  Pose broken = moved;
  broken.linear() *= 2.0;
  const test::AllocationGuard guard;
  std::optional<Snapshot> held;
  for (int n = 0; n < 4; ++n) {
    (void)store.update(0, wall.frame());
    (void)store.update(1, wall.frame(), moved);
    (void)store.update(1, wall.frame(), broken);
    (void)store.update(0, Frame{});
    held.emplace(store.snapshot());
  }
  EXPECT_EQ(guard.allocations(), 0);
}

}  // namespace
}  // namespace depthgrid::views
