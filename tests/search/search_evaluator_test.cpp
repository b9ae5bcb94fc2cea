// The search for one thread: the same answers as store and search, images that are old or missing, and a budget.
#include "depthgrid/search/search_evaluator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "depthgrid/core/sensor_models.hpp"
#include "support/allocation_guard.hpp"

namespace depthgrid::search {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

constexpr int kWidth = 64;
constexpr int kHeight = 48;

Rig rig_of(int cameras) {
  Rig rig{.name = "rig", .cameras = {}, .T_floor_world = {}};
  for (int k = 0; k < cameras; ++k) {
    RigCamera& camera = rig.cameras.emplace_back();
    camera.id = "camera " + std::to_string(k);
    camera.intrinsics = from_opencv(kWidth, kHeight, 52.5, 52.5, 31.5, 23.5);
    camera.T_world_camera.translation().x() = 0.1 * k;
    camera.margins = sensor_margins(sensor_model("ideal"), camera.intrinsics, 0.001);
  }
  return rig;
}

views::Settings settings_for(const Rig& rig) {
  views::Settings settings;
  settings.space = views::BoxSpace{{-1.5, -1.5, 0.5}, {1.5, 1.5, 3}};
  settings.policies = {.unobserved = views::Policy::obstacle,
                       .outside = views::Policy::obstacle,
                       .robot_pockets = views::Policy::obstacle};
  settings.margins = camera_margins(rig);
  settings.v_max_m_s = 2;
  settings.rho_m = 0.5;
  return settings;
}

struct Wall {
  std::vector<float> depth_m = std::vector<float>(kWidth * kHeight, 2.3F);
  [[nodiscard]] Frame frame(double time_s = 0) const { return {depth_view(depth_m, kWidth, kHeight), {}, time_s}; }
};

/// 0.3 m before the wall.
const Capsule kPoint = Capsule::point({0, 0, 2});

TEST(SearchEvaluator, AnswersAsStoreAndSearchDo) {
  const Rig rig = rig_of(2);
  const Wall wall;
  views::ViewStore store(rig, settings_for(rig));
  SearchEvaluator all(rig, settings_for(rig), {.directions = 2});
  SearchEvaluator none(rig, settings_for(rig));
  EXPECT_EQ(all.camera_count(), 2U);
  const std::array<Frame, 2> frames{wall.frame(), wall.frame()};
  ASSERT_TRUE(store.update(0, frames[0]).taken() && store.update(1, frames[1]).taken());
  ASSERT_TRUE(update_all(all, frames).taken());
  ASSERT_TRUE(update_all(none, frames).taken());
  const std::array<Capsule, 4> asked{kPoint, Capsule::sphere({0.2, 0, 1.9}, 0.05),
                                     Capsule{{0, 0, 1.2}, {0, 0, 2.1}, 0.02}, Capsule::point({0, 0, 1})};
  std::array<Answer, 4> directed;
  std::array<Answer, 4> plain;
  std::array<Answer, 4> from_all;
  std::array<Answer, 5> from_none;
  Search search;
  search.hybrid(store.snapshot(), std::span(asked).first(2), std::span(directed).first(2));
  search.distances(store.snapshot(), std::span(asked).last(2), std::span(directed).last(2));
  search.distances(store.snapshot(), asked, plain);
  all.evaluate(asked, 0, from_all);
  from_none.back().nearest.state = ProximityState::measured;
  none.evaluate(asked, 0, from_none);
  const auto expect_same = [](const Answer& ours, const Answer& theirs) {
    EXPECT_EQ(ours.nearest.distance_m, theirs.nearest.distance_m);
    EXPECT_EQ(ours.nearest.state, theirs.nearest.state);
    EXPECT_EQ(ours.hybrid_direction_world, theirs.hybrid_direction_world);
    EXPECT_EQ(ours.distance_now_m, lower_bound_after(theirs.nearest, 0, 2));
    EXPECT_TRUE(std::isnan(theirs.distance_now_m)) << "no time was asked for";
  };
  for (std::size_t i = 0; i < asked.size(); ++i) {
    expect_same(from_all[i], directed[i]);
    expect_same(from_none[i], plain[i]);
    expect_same(none.distance(asked[i]), [&] {
      Answer one;
      search.distances(store.snapshot(), {&asked[i], 1}, {&one, 1});
      return one;
    }());
  }
  EXPECT_FALSE(from_all[1].hybrid_direction_world.isZero());
  EXPECT_TRUE(from_all[2].hybrid_direction_world.isZero());
  EXPECT_EQ(from_none.back().nearest.state, ProximityState::not_evaluated) << "no capsule";
  const Capsule negative = Capsule::sphere({0, 0, 1}, -1);
  EXPECT_EQ(none.distance(negative).nearest.state, ProximityState::not_evaluated);
}

TEST(SearchEvaluator, SubtractsWhatMayHaveComeNearer) {
  const Rig rig = rig_of(1);
  SearchEvaluator cell(rig, settings_for(rig));
  ASSERT_TRUE(cell.update(0, Wall().frame(5.0)).taken());
  const Answer fresh = cell.distance(kPoint);
  EXPECT_EQ(fresh.distance_now_m, cell.distance(kPoint, 5.0).distance_now_m);
  EXPECT_NEAR(fresh.distance_now_m, 0.3, 0.06);
  const Answer later = cell.distance(kPoint, 5.05);
  EXPECT_NEAR(fresh.distance_now_m - later.distance_now_m, 2 * 0.05, 1e-9);
  EXPECT_EQ(fresh.nearest.distance_m, later.nearest.distance_m);
}

TEST(SearchEvaluator, KnowsNothingAtATimeThatDoesNotFitTheImages) {
  const Rig rig = rig_of(1);
  SearchEvaluator cell(rig, settings_for(rig));
  EXPECT_TRUE(std::isnan(cell.distance(kPoint, 0).distance_now_m)) << "there is no image";
  EXPECT_TRUE(std::isnan(cell.distance(kPoint).distance_now_m)) << "there is no image";
  const auto at_age = [&](double exposed_s, double age_s) {
    EXPECT_TRUE(cell.update(0, Wall().frame(exposed_s)).taken());
    return cell.distance(kPoint, 5.0 + age_s).distance_now_m;
  };
  const double fresh_m = at_age(5.0, 0);
  EXPECT_GT(fresh_m, 0.2);
  // A little in the future: as old as it is young.
  EXPECT_NEAR(at_age(5.0, -0.003), fresh_m - 2 * 0.003, 1e-9);
  EXPECT_TRUE(std::isnan(at_age(5.0, -0.006)));
  EXPECT_TRUE(std::isnan(at_age(5.0, -1.0)));
  EXPECT_TRUE(std::isnan(at_age(5.0, Proximity::kNaN)));
  EXPECT_TRUE(std::isnan(at_age(Proximity::kNaN, 0))) << "an image without a time";
}

TEST(SearchEvaluator, SaysWhatBecameOfAFrame) {
  const Rig rig = rig_of(2);
  SearchEvaluator cell(rig, settings_for(rig));
  const Wall wall;
  const FrameUpdate none = cell.update(0, Frame{});
  EXPECT_EQ(none.result, UpdateResult::unusable);
  EXPECT_THAT(none.reason, HasSubstr("no depth image"));
  EXPECT_THAT(cell.update(2, wall.frame()).reason, HasSubstr("no such camera"));
  Pose scaled = Pose::Identity();
  scaled.linear() *= 1.1;
  EXPECT_THAT(cell.update(0, wall.frame(), scaled).reason, HasSubstr("rigid transform"));
  const FrameUpdate taken = cell.update(0, wall.frame(), Pose::Identity());
  EXPECT_TRUE(taken.taken());
  EXPECT_EQ(taken.reason, nullptr);
  // The second camera is missing: the first such frame's reason.
  const Frame frame = wall.frame();
  EXPECT_THAT(update_all(cell, {&frame, 1}).reason, HasSubstr("no depth image"));
  EXPECT_TRUE(cell.distance(kPoint).nearest.stale);
  std::vector<views::Snapshot> held;
  for (int i = 0; i < 4; ++i) {
    held.push_back(cell.store().snapshot());
    if (const FrameUpdate update = cell.update(0, frame); !update.taken()) {
      EXPECT_EQ(update.result, UpdateResult::dropped);
      EXPECT_THAT(update.reason, HasSubstr("snapshots"));
    }
  }
  EXPECT_EQ(cell.update(0, frame).result, UpdateResult::dropped);
}

TEST(SearchEvaluator, KeepsItsBudgetHoweverSmallItIs) {
  const Rig rig = rig_of(1);
  const Wall wall;
  const std::array<Capsule, 2> asked{kPoint, kPoint};
  for (std::int64_t nodes = 0; nodes <= 5; ++nodes) {
    for (const std::size_t directions : {0U, 1U, 2U}) {
      SearchEvaluator cell(rig, settings_for(rig), {.directions = directions, .budget = {.nodes = nodes}});
      ASSERT_TRUE(cell.update(0, wall.frame()).taken());
      std::array<Answer, 2> answers;
      cell.evaluate(asked, 0, answers);
      EXPECT_TRUE(answers[0].nearest.budget) << nodes;
      EXPECT_TRUE(answers[1].nearest.budget) << nodes;
    }
  }
  SearchEvaluator late(rig, settings_for(rig), {.directions = 1, .budget = {.time_s = 0}});
  ASSERT_TRUE(late.update(0, wall.frame()).taken());
  std::array<Answer, 2> answers;
  late.evaluate(asked, 0, answers);
  EXPECT_TRUE(answers[0].nearest.budget && answers[1].nearest.budget);
}

// With others after them the first ones have a quarter of the nodes, and the others the rest.
TEST(SearchEvaluator, SharesItsBudget) {
  const Rig rig = rig_of(1);
  const Wall wall;
  views::ViewStore store(rig, settings_for(rig));
  ASSERT_TRUE(store.update(0, wall.frame()).taken());
  const std::array<Capsule, 2> asked{kPoint, kPoint};
  Search search;
  for (const std::int64_t nodes : {4, 30, 101, 400}) {
    SearchEvaluator cell(rig, settings_for(rig), {.directions = 1, .budget = {.nodes = nodes}});
    ASSERT_TRUE(cell.update(0, wall.frame()).taken());
    std::array<Answer, 2> answers;
    cell.evaluate(asked, 0, answers);
    std::array<Answer, 2> expected;
    search.hybrid(store.snapshot(), {&kPoint, 1}, {expected.data(), 1}, {.nodes = nodes / 4});
    search.distances(store.snapshot(), {&kPoint, 1}, {&expected[1], 1}, {.nodes = nodes - nodes / 4});
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(answers[i].nearest.distance_m, expected[i].nearest.distance_m) << nodes;
      EXPECT_EQ(answers[i].nearest.budget, expected[i].nearest.budget) << nodes;
    }
  }
}

TEST(SearchEvaluator, AllocatesNothing) {
  DEPTHGRID_REQUIRE_ALLOCATION_COUNT();
  const Rig rig = rig_of(1);
  SearchEvaluator cell(rig, settings_for(rig), {.directions = 1});
  const Wall wall;
  const std::array<Capsule, 2> asked{kPoint, kPoint};
  std::array<Answer, 2> answers;
  const test::AllocationGuard guard;
  (void)cell.update(0, wall.frame());
  cell.evaluate(asked, 0, answers);
  (void)cell.distance(kPoint);
  EXPECT_EQ(guard.allocations(), 0);
}

}  // namespace
}  // namespace depthgrid::search
