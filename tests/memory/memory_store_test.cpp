// What the memory is told at the start and later, what it does with images that are late, lost or impossible, and how
// long a snapshot stays as it is.
#include "depthgrid/memory/memory_store.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "depthgrid/memory/voxel_set.hpp"
#include "memory/small_cell.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::memory {
namespace {

using Eigen::Vector3d;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t kVoxels = 16 * 16 * 16;
const Wall kFar(3.0F);
/// Nothing of the region is seen.
const Wall kHidden(0.5F);

struct Cell {
  explicit Cell(std::size_t cameras = 1, const MemorySettings& memory = small_memory(), double v_max_m_s = kFastest)
      : views(small_rig(cameras), small_settings(cameras, v_max_m_s), 4), store(views, memory) {}

  void see(const Wall& wall, double time_s, std::size_t camera = 0) { see(wall.frame(time_s), camera); }
  void see(const Frame& frame, std::size_t camera = 0) {
    EXPECT_EQ(views.update(camera, frame).result, UpdateResult::taken);
    store.take(camera);
  }
  [[nodiscard]] std::int64_t voxels() const { return store.snapshot().voxels().count(); }
  [[nodiscard]] bool may_hold(const Vector3d& x_world, double time_s) const {
    const MemorySnapshot memory = store.snapshot();
    return memory.voxels().meets(x_world, x_world, memory.reach_m(time_s));
  }

  views::ViewStore views;
  MemoryStore store;
};

TEST(MemoryStore, SaysNothingBeforeTheFirstImage) {
  const Cell cell;
  EXPECT_EQ(cell.voxels(), kVoxels);
  EXPECT_EQ(cell.store.snapshot().reach_m(1.0), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(cell.store.snapshot().time_s()));
  MemorySettings empty = small_memory();
  empty.start = StartEmpty{};
  EXPECT_TRUE(Cell(1, empty).may_hold(Vector3d::Zero(), 1.0));
}

TEST(MemoryStore, BeginsAsDeclared) {
  MemorySettings settings = small_memory();
  settings.start = StartEmpty{};
  Cell empty(1, settings);
  empty.see(kHidden, 5);
  EXPECT_EQ(empty.voxels(), 0);
  EXPECT_FALSE(empty.may_hold(Vector3d::Zero(), 5));

  settings.start = StartEmptyAroundRobot{{Capsule{{-0.05, 0, 0}, {0.05, 0, 0}, 0.02}}, 0.1};
  for (const double thinnest_m : {0.0, 0.06}) {
    settings.thinnest_hidden_m = thinnest_m;
    Cell around(1, settings);
    around.see(kHidden, 5);
    EXPECT_FALSE(around.may_hold(Vector3d::Zero(), 5));
    EXPECT_FALSE(around.may_hold({0.05, 0.07, 0}, 5));
    EXPECT_TRUE(around.may_hold({0.05, 0.1201, 0}, 5));
    EXPECT_TRUE(around.may_hold({0.1701, 0, 0}, 5));
  }
}

TEST(MemoryStore, RemembersWhatWasSeenFree) {
  Cell cell;
  cell.see(kFar, 5);
  EXPECT_EQ(cell.voxels(), 0);
  EXPECT_EQ(cell.store.snapshot().reach_m(5), 0);
  EXPECT_DOUBLE_EQ(cell.store.snapshot().reach_m(5.01), kFastest * (5.01 - 5.0));
  EXPECT_DOUBLE_EQ(cell.store.snapshot().reach_m(4.99), kFastest * (5.0 - 4.99));
  EXPECT_EQ(cell.store.snapshot().reach_m(kNaN), std::numeric_limits<double>::infinity());
  // Half a wall's width from the border things need 0.2 s.
  cell.see(kHidden, 5.15);
  EXPECT_FALSE(cell.may_hold(Vector3d::Zero(), 5.15));
  EXPECT_TRUE(cell.may_hold({0.06, 0, 0}, 5.15));
  EXPECT_TRUE(cell.may_hold(Vector3d::Zero(), 5.21));
  cell.see(kHidden, 5.3);
  EXPECT_EQ(cell.voxels(), kVoxels);
  EXPECT_EQ(cell.store.count().images, 3);
  EXPECT_EQ(cell.store.count().dropped, 0);
  EXPECT_EQ(cell.store.count().impossible, 0);
}

TEST(MemoryStore, TakesLessOutForALateImage) {
  Cell cell;
  cell.see(kHidden, 5);
  cell.see(kFar, 5);
  Wall half(3.0F);
  half.put(0, 0, kWidth / 2, kHeight, 0.5F);
  std::int64_t before = -1;
  for (const double late_s : {0.0, 0.03, 0.06}) {
    Cell other(2);
    other.see(half, 5 + late_s, 1);
    other.see(half, 5, 0);
    Cell prompt(2);
    prompt.see(half, 5 + late_s, 1);
    prompt.see(half, 5 + late_s, 0);
    EXPECT_EQ(other.store.snapshot().time_s(), 5 + late_s);
    EXPECT_TRUE(late_s == 0 ? other.voxels() == prompt.voxels() : other.voxels() >= prompt.voxels());
    EXPECT_GE(other.voxels(), before);
    before = other.voxels();
  }
  // So late that anything may have come: nothing is taken out, and time does not run backwards.
  Cell late;
  late.see(kFar, 5);
  late.see(kHidden, 5.15);
  const std::int64_t voxels = late.voxels();
  late.see(kFar, 1);
  EXPECT_EQ(late.voxels(), voxels);
  EXPECT_EQ(late.store.snapshot().time_s(), 5.15);
}

TEST(MemoryStore, BeginsAnewAfterALongGap) {
  Cell cell;
  cell.see(kFar, 5);
  cell.see(kHidden, 1e6);  // a clock that jumped
  EXPECT_EQ(cell.voxels(), kVoxels);
  cell.see(kFar, 6);
  EXPECT_EQ(cell.voxels(), 0);
  EXPECT_EQ(cell.store.snapshot().time_s(), 6);
}

TEST(MemoryStore, IgnoresWhatIsNoImage) {
  Cell cell;
  cell.see(kFar, 5);
  cell.see(kFar, kNaN);
  cell.see(kFar, std::numeric_limits<double>::infinity());
  EXPECT_EQ(cell.views.update(0, Frame{}).result, UpdateResult::unusable);
  cell.store.take(0);
  cell.store.take(7);
  EXPECT_EQ(cell.store.count().images, 1);
  EXPECT_EQ(cell.store.snapshot().time_s(), 5);
}

TEST(MemoryStore, LooksAtAnImageOnce) {
  Cell cell;
  cell.see(kFar, 5);
  cell.store.take(0);
  EXPECT_EQ(cell.store.count().images, 1);
}

TEST(MemoryStore, KeepsSnapshotsAndDropsWhatHasNoRoom) {
  Cell cell;
  const MemorySnapshot first = cell.store.snapshot();
  cell.see(kFar, 5);
  std::optional<MemorySnapshot> second = cell.store.snapshot();
  EXPECT_NE(first.version(), second->version());
  cell.see(kHidden, 5.1);
  const MemorySnapshot third = cell.store.snapshot();
  cell.see(kHidden, 5.2);
  const MemorySnapshot fourth = cell.store.snapshot();
  cell.see(kFar, 5.3);
  EXPECT_EQ(cell.store.count().dropped, 1);
  EXPECT_EQ(cell.store.snapshot().version(), fourth.version());
  EXPECT_EQ(first.voxels().count(), kVoxels);
  EXPECT_EQ(second->voxels().count(), 0);
  EXPECT_GT(third.voxels().count(), 0);
  EXPECT_GT(fourth.voxels().count(), third.voxels().count());
  EXPECT_FALSE(cell.store.occupy({}, 0, 0));
  second.reset();
  cell.see(kFar, 5.4);
  EXPECT_EQ(cell.store.count().dropped, 1);
  EXPECT_EQ(cell.voxels(), 0);
}

TEST(MemoryStore, PutsInWhatTheRobotLetsGo) {
  Cell cell;
  cell.see(kFar, 5);
  const Capsule held{{0, 0, -0.05}, {0, 0, 0.05}, 0.03};
  ASSERT_TRUE(cell.store.occupy({&held, 1}, 0.01, 5.02));
  EXPECT_TRUE(cell.may_hold({0.039, 0, 0}, 5));
  EXPECT_TRUE(cell.may_hold({0, 0, -0.089}, 5));
  EXPECT_FALSE(cell.may_hold({0.12, 0, 0}, 5));
  // It was part of the robot to this image, which saw it free.
  cell.see(kFar, 5.01);
  EXPECT_TRUE(cell.may_hold({0.039, 0, 0}, 5.01));
  cell.see(kFar, 5.03);
  EXPECT_EQ(cell.voxels(), 0);
  const Capsule nowhere{{kNaN, 0, 0}, {0, 0, 0}, 0.03};
  ASSERT_TRUE(cell.store.occupy({&nowhere, 1}, 0.01, 5.02));
  EXPECT_EQ(cell.voxels(), kVoxels);
}

TEST(MemoryStore, WhatWasLetGoEarlierMayHaveGoneFarther) {
  Cell cell;
  EXPECT_EQ(cell.store.released_s(), -std::numeric_limits<double>::infinity());
  cell.see(kFar, 5);
  const Capsule held = Capsule::sphere({0, 0, 0}, 0.02);
  // 0.05 s before the newest image: 5 cm at 1 m/s.
  ASSERT_TRUE(cell.store.occupy({&held, 1}, 0.01, 4.95));
  EXPECT_EQ(cell.store.released_s(), 4.95);
  EXPECT_TRUE(cell.may_hold({0.079, 0, 0}, 5));
  EXPECT_FALSE(cell.may_hold({0.14, 0, 0}, 5));
  ASSERT_TRUE(cell.store.occupy({&held, 1}, 0.01, 4.9));
  EXPECT_EQ(cell.store.released_s(), 4.95) << "the latest";
  ASSERT_TRUE(cell.store.occupy({&held, 1}, 0.01, kNaN));
  EXPECT_EQ(cell.voxels(), kVoxels) << "nobody knows since when";
}

TEST(MemoryStore, IgnoredPocketsWouldStayIgnored) {
  views::Settings settings = small_settings();
  settings.policies.robot_pockets = views::Policy::ignored;
  settings.policies.ignored_pocket_m = 0.1;
  const views::ViewStore views(small_rig(), settings, 3);
  EXPECT_THROW(MemoryStore(views, small_memory()), Error);
}

/// A surface in the middle, 0.2 m wide.
Wall with_surface() { return Wall(3.0F).put(70, 50, 90, 70, 1.0F); }

TEST(MemoryStore, CountsSurfacesWhereNothingCouldBe) {
  Cell cell;
  cell.see(kFar, 5);
  cell.see(with_surface(), 5.01);
  EXPECT_GT(cell.store.count().impossible, 10);
  EXPECT_TRUE(cell.may_hold({0, 0, 0.001}, 5.01));
  EXPECT_TRUE(cell.may_hold({0.08, 0.08, 0.001}, 5.01));
  const ImpossibleSurfaces found = cell.store.snapshot().impossible();
  EXPECT_EQ(found.images, 1);
  EXPECT_EQ(found.voxels, cell.store.count().impossible);
  EXPECT_EQ(found.camera, 0);
  EXPECT_EQ(found.time_s, 5.01);
  EXPECT_LE((found.at_world - Vector3d(0, 0, 0)).cwiseAbs().maxCoeff(), 0.1125) << found.at_world.transpose();
  cell.see(with_surface(), 5.02);
  EXPECT_EQ(cell.store.snapshot().impossible().images, 1) << "it is in the set by now";
  // Long enough for it to have come from the border.
  Cell slow;
  slow.see(kFar, 5);
  slow.see(with_surface(), 5.25);
  EXPECT_EQ(slow.store.count().impossible, 0);
  EXPECT_EQ(slow.store.snapshot().impossible().images, 0);
  EXPECT_TRUE(slow.may_hold({0, 0, 0.001}, 5.25));
}

// What is pending has reached a place already, though no voxel says so. One voxel of 25 mm lies between the far end of
// the region and the surface's, and the sensor errs by 5 mm.
TEST(MemoryStore, ASurfaceWithinWhatIsPendingIsPossible) {
  for (const auto& [moved_m, possible] : {std::pair{0.018, false}, std::pair{0.022, true}}) {
    Cell cell;
    cell.see(kFar, 5);
    cell.see(Wall(3.0F).put(70, 50, 90, 70, 1.16F), 5 + moved_m / kFastest);
    EXPECT_TRUE(cell.may_hold({0, 0, 0.16}, 5 + moved_m / kFastest));
    EXPECT_EQ(cell.store.count().impossible == 0, possible) << moved_m;
  }
}

TEST(MemoryStore, DoesNotCountSinglePixels) {
  Cell cell;
  cell.see(kFar, 5);
  cell.see(Wall(3.0F).put(80, 60, 81, 61, 1.0F), 5.01);
  EXPECT_EQ(cell.store.count().impossible, 0);
  EXPECT_FALSE(cell.may_hold({0.01, 0.01, 0.005}, 5.01));
}

TEST(MemoryStore, DoesNotCountTheRobot) {
  Cell cell;
  cell.see(kFar, 5);
  std::vector<float> near_m(std::size_t{kWidth} * kHeight, 0.9F);
  std::vector<float> far_m(near_m.size(), 1.2F);
  Frame frame = with_surface().frame(5.01);
  const Wall wall = with_surface();
  frame = wall.frame(5.01);
  frame.robot = {near_m.data(), far_m.data(), kWidth, 0, 5};
  cell.see(frame);
  EXPECT_EQ(cell.store.count().impossible, 0);
  EXPECT_FALSE(cell.may_hold({0.01, 0.01, 0.005}, 5.01));
}

TEST(MemoryStore, DoesNotCountWhatAnotherCameraSeesFree) {
  Cell cell(2);
  cell.see(kFar, 5, 1);
  cell.see(kFar, 5, 0);
  cell.see(kFar, 5.01, 1);
  cell.see(with_surface(), 5.01, 0);
  EXPECT_EQ(cell.store.count().impossible, 0);
  EXPECT_FALSE(cell.may_hold({0, 0, 0.005}, 5.01));
}

TEST(MemoryStore, StandsStillWhereNothingMoves) {
  Cell cell(1, small_memory(), 0);
  cell.see(kFar, 5);
  cell.see(kHidden, 500);
  EXPECT_EQ(cell.voxels(), 0);
  EXPECT_EQ(cell.store.snapshot().reach_m(1e9), 0);
}

TEST(MemorySettings, HaveNoSilentDefaults) {
  const auto message = [](auto&& change) {
    MemorySettings settings = small_memory();
    change(settings);
    return test::thrown_message([&settings] { validate(settings); });
  };
  EXPECT_EQ(message([](MemorySettings&) {}), "");
  EXPECT_NE(message([](MemorySettings& s) { s.start = std::monostate{}; }).find("start is not declared"),
            std::string::npos);
  EXPECT_NE(message([](MemorySettings& s) { s.low_world = MemorySettings{}.low_world; }).find("must be set"),
            std::string::npos);
  EXPECT_NE(message([](MemorySettings& s) { s.high_world.y() = -1; }).find("from -0.2 to -1 m in y"),
            std::string::npos);
  EXPECT_NE(message([](MemorySettings& s) { s.voxel_m = 0; }).find("voxel is 0 m"), std::string::npos);
  EXPECT_NE(message([](MemorySettings& s) { s.high_world *= 1000; }).find("must have at most"), std::string::npos);
  EXPECT_NE(message([](MemorySettings& s) { s.thinnest_hidden_m = -1; }).find("-1 m"), std::string::npos);
  EXPECT_NE(message([](MemorySettings& s) { s.start = StartEmptyAroundRobot{}; }).find("no capsules"),
            std::string::npos);
  EXPECT_NE(message([](MemorySettings& s) {
              s.start = StartEmptyAroundRobot{{Capsule{}}, kNaN};
            }).find("distance around the robot is nan"),
            std::string::npos);
  EXPECT_NE(message([](MemorySettings& s) {
              s.start = StartEmptyAroundRobot{{Capsule{{0, 0, 0}, {0, 0, 0}, -2}}, 0.1};
            }).find("-2 m"),
            std::string::npos);
  const views::ViewStore views(small_rig(), small_settings());
  EXPECT_NE(test::thrown_message([&] { MemoryStore(views, small_memory(), 0); }).find("held_snapshots is 0"),
            std::string::npos);
}

}  // namespace
}  // namespace depthgrid::memory
