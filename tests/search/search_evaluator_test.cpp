// The search for one thread: the same answers as store and search, images that are old or missing, and a budget.
#include "depthgrid/search/search_evaluator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <limits>
#include <random>

#include "depthgrid/core/sensor_models.hpp"
#include "support/allocation_guard.hpp"
#include "support/random_run.hpp"
#include "support/thrown_message.hpp"
#include "support/ticking_clock.hpp"

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
    camera.margins->smallest_obstacle_m = 0;
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
  EXPECT_STREQ(taken.reason, "");
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

// Likewise the time, of which a millisecond passes whenever the clock is read: at the beginning of each part, then
// until the part's time is over.
TEST(SearchEvaluator, SharesItsTime) {
  const Rig rig = rig_of(1);
  std::vector<Capsule> asked;
  for (int i = 0; i < 24; ++i) {
    asked.push_back(Capsule::point({-0.5 + 0.2 * (i % 6), -0.3 + 0.2 * (i / 6), 1.9}));
  }
  std::vector<Answer> answers(asked.size());
  for (const std::size_t directions : {std::size_t{0}, std::size_t{12}, asked.size()}) {
    SearchEvaluator cell(rig, settings_for(rig), {.directions = directions, .budget = {.time_s = 0.02}});
    ASSERT_TRUE(cell.update(0, Wall().frame()).taken());
    const test::TickingClock clock(std::chrono::milliseconds(1));
    cell.evaluate(asked, 0, answers);
    const int parts = directions == 0 ? 1 : 2;  // the second may be empty
    EXPECT_EQ(clock.reads(), parts + 20) << directions;
    EXPECT_TRUE(answers.back().nearest.budget) << directions;
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

TEST(SearchEvaluator, AnImageThatIsTooOldFreesNothing) {
  for (const double v_max_m_s : {0.0, 0.1}) {
    const Rig rig = rig_of(2);
    views::Settings settings = settings_for(rig);
    settings.v_max_m_s = v_max_m_s;
    SearchEvaluator evaluator(rig, settings, {.max_image_age_s = 0.2});
    EXPECT_TRUE(std::isnan(evaluator.image_time_s(0)));
    const Wall wall;
    ASSERT_TRUE(evaluator.update(0, wall.frame(1.0)).taken());
    ASSERT_TRUE(evaluator.update(1, wall.frame(1.1)).taken());
    const Answer both = evaluator.distance(kPoint, 1.15);
    EXPECT_GT(both.nearest.distance_m, 0.2);
    EXPECT_FALSE(both.nearest.stale);
    EXPECT_EQ(evaluator.image_time_s(0), 1.0);
    EXPECT_EQ(evaluator.image_time_s(1), 1.1);
    EXPECT_TRUE(std::isnan(evaluator.image_time_s(2)));
    // Camera 0 is late: what camera 1 sees is still free.
    const Answer one = evaluator.distance(kPoint, 1.25);
    EXPECT_GT(one.nearest.distance_m, 0.2);
    EXPECT_TRUE(one.nearest.stale);
    const Answer none = evaluator.distance(kPoint, 1.35);
    EXPECT_EQ(none.nearest.distance_m, 0);
    EXPECT_TRUE(none.nearest.stale);
    EXPECT_EQ(none.nearest.state, ProximityState::unmeasured) << "nothing that a late image shows is measured";
    // What was found out about late images is not kept for others.
    const Answer again = evaluator.distance(kPoint, 1.15);
    EXPECT_EQ(again.nearest.distance_m, both.nearest.distance_m);
    EXPECT_FALSE(again.nearest.stale);
    ASSERT_TRUE(evaluator.update(0, wall.frame(1.34)).taken());
    EXPECT_GT(evaluator.distance(kPoint, 1.35).nearest.distance_m, 0.2) << "it is back";
  }
}

TEST(SearchEvaluator, AnImageWithoutATimeIsOfAnyAge) {
  const Rig rig = rig_of(2);
  views::Settings settings = settings_for(rig);
  settings.v_max_m_s = 0;
  SearchEvaluator evaluator(rig, settings);
  const Wall wall;
  const double no_time_s = std::numeric_limits<double>::quiet_NaN();
  ASSERT_TRUE(evaluator.update(0, wall.frame(no_time_s)).taken());
  // The other one covers its lens, and has a time.
  Wall covered;
  std::fill(covered.depth_m.begin(), covered.depth_m.end(), 0.0F);
  ASSERT_TRUE(evaluator.update(1, covered.frame(1.0)).taken());
  EXPECT_EQ(evaluator.distance(kPoint, 1.1).nearest.distance_m, 0);
  EXPECT_GT(evaluator.distance(kPoint, no_time_s).nearest.distance_m, 0.2)
      << "without a clock it is asked about itself";
}

TEST(SearchEvaluator, AnImageThatIsNoneHasNoTime) {
  const Rig rig = rig_of(2);
  SearchEvaluator evaluator(rig, settings_for(rig));
  const Wall wall;
  ASSERT_TRUE(evaluator.update(0, wall.frame(1.0)).taken());
  ASSERT_TRUE(evaluator.update(1, wall.frame(1.0)).taken());
  (void)evaluator.distance(kPoint, 1.0);
  EXPECT_EQ(evaluator.image_time_s(0), 1.0);
  ASSERT_FALSE(evaluator.update(0, Frame{}).taken());
  (void)evaluator.distance(kPoint, 1.0);
  EXPECT_TRUE(std::isnan(evaluator.image_time_s(0))) << "the image before it is gone";
  EXPECT_EQ(evaluator.image_time_s(1), 1.0);
}

TEST(SearchEvaluator, AMemoryDoesNotOutliveItsCameras) {
  for (const double v_max_m_s : {0.0, 0.1}) {
    const Rig rig = rig_of(2);
    views::Settings settings = settings_for(rig);
    settings.v_max_m_s = v_max_m_s;
    memory::MemorySettings remembered;
    remembered.low_world = Vector3d(-0.6, -0.6, 1.2);
    remembered.high_world = Vector3d(0.6, 0.6, 2.6);
    remembered.start = memory::StartEmpty{};
    SearchEvaluator evaluator(rig, settings, {.max_image_age_s = 0.2, .memory = remembered});
    const Wall wall;
    ASSERT_TRUE(evaluator.update(0, wall.frame(1.0)).taken());
    ASSERT_TRUE(evaluator.update(1, wall.frame(1.1)).taken());
    EXPECT_GT(evaluator.distance(kPoint, 1.15).nearest.distance_m, 0.2);
    EXPECT_GT(evaluator.distance(kPoint, 1.25).nearest.distance_m, 0.2) << "one camera is left";
    EXPECT_EQ(evaluator.distance(kPoint, 1.35).nearest.distance_m, 0);
    // What is let go was part of the robot to both images.
    ASSERT_TRUE(evaluator.memory()->occupy({&kPoint, 1}, 0.02, 1.12));
    EXPECT_EQ(evaluator.distance(kPoint, 1.15).nearest.distance_m, 0);
    EXPECT_TRUE(evaluator.distance(kPoint, 1.15).nearest.stale);
  }
}

/// Where the claim of an answer can be looked up: one camera, its images, and a place that it looks at.
struct Looked {
  const Rig& rig;
  const Wall& wall;
  Vector3d x;
  double slack_m;  ///< of the answer's nearest point

  /// Readings within so many pixels of the place and of the ball of slack around it.
  [[nodiscard]] bool misses_a_reading(int beside_px) const {
    bool missing = false;
    for_pixels(beside_px, [&](int u, int v) {
      const bool inside = u >= 0 && v >= 0 && u < kWidth && v < kHeight;
      missing = missing || (inside && !(wall.depth_m[static_cast<std::size_t>(v * kWidth + u)] >= 0.4F));
    });
    return missing;
  }
  [[nodiscard]] bool leaves_the_image(int beside_px) const {
    bool leaves = false;
    for_pixels(beside_px, [&](int u, int v) { leaves = leaves || u < 0 || v < 0 || u >= kWidth || v >= kHeight; });
    return leaves;
  }

 private:
  template <class Use>
  void for_pixels(int beside_px, Use&& use) const {
    const PinholeCamera& c = rig.cameras[0].intrinsics;
    const DepthPoint at = project(c, x);
    const int reach_px = beside_px + static_cast<int>(std::ceil(c.fx_px * slack_m / (x.z() - slack_m) * 1.5));
    for (int v = static_cast<int>(at.y_px) - reach_px; v <= static_cast<int>(at.y_px) + reach_px; ++v) {
      for (int u = static_cast<int>(at.x_px) - reach_px; u <= static_cast<int>(at.x_px) + reach_px; ++u) {
        use(u, v);
      }
    }
  }
};

TEST(SearchEvaluator, SaysWhyACameraSaysNothing) {
  const test::RandomRun run = test::random_run(60);
  std::array<int, 5> told{};
  for (std::int64_t n = 0; n < run.count && !HasFailure(); ++n) {
    const test::RandomRun again{run.seed + static_cast<std::uint64_t>(n), 1};
    SCOPED_TRACE(again.reproduce());
    std::mt19937_64 random(again.seed);
    const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    Rig rig = rig_of(1);
    rig.cameras[0].rule.near_m = 0.4;
    views::Settings settings = settings_for(rig);
    settings.space = views::BoxSpace{{-1.5, -1.5, 0.3}, {1.5, 1.5, 3}};
    settings.policies.outside = views::Policy::ignored;
    settings.policies.unobserved = views::Policy::ignored;
    settings.margins[0].translation_m = n % 2 == 0 ? 0 : 0.02;
    settings.margins[0].sensor.lateral_px = static_cast<int>(n % 3);
    Wall wall;
    for (int hole = 0; hole < 6; ++hole) {
      const auto u = static_cast<int>(uniform(0, kWidth - 3));
      const auto v = static_cast<int>(uniform(0, kHeight - 3));
      for (int i = 0; i < 9; ++i) {
        wall.depth_m[static_cast<std::size_t>((v + i / 3) * kWidth + u + i % 3)] = hole < 3 ? 0.0F : 1.5F;
      }
    }
    SearchEvaluator evaluator(rig, settings, {.max_image_age_s = 0.5});
    ASSERT_TRUE(evaluator.update(0, wall.frame(1)).taken());
    const bool late = n % 10 == 9;
    for (int q = 0; q < 40; ++q) {
      const double z = uniform(0.35, 2.5);
      const Capsule at = Capsule::point({uniform(-0.7, 0.7) * z, uniform(-0.6, 0.6) * z, z});
      const Proximity nearest = evaluator.distance(at, late ? 2.0 : 1.0).nearest;
      if (nearest.state != ProximityState::unmeasured) {
        EXPECT_EQ(nearest.unmeasured, Unmeasured::not_told);
        continue;
      }
      ++told[static_cast<std::size_t>(nearest.unmeasured)];
      const double slack_m =
          settings.resolution_m + settings.margins[0].translation_m + 2 * settings.margins[0].half_exposure_s + 1e-4;
      const Looked looked{rig, wall, nearest.nearest_world, slack_m};
      const int w = settings.margins[0].sensor.lateral_px;
      switch (nearest.unmeasured) {
        case Unmeasured::no_reading:
          EXPECT_TRUE(!late && looked.misses_a_reading(w));
          break;
        case Unmeasured::image_edge:
          EXPECT_TRUE(!late && looked.leaves_the_image(w));
          break;
        case Unmeasured::blind_zone:
          EXPECT_TRUE(!late && nearest.nearest_world.z() - slack_m <= 0.4);
          break;
        case Unmeasured::late_image:
          EXPECT_TRUE(late);
          break;
        case Unmeasured::not_told:
          ADD_FAILURE() << "no reason";
      }
    }
  }
  std::cout << told[1] << " without a reading, " << told[2] << " at the edge, " << told[3] << " in the blind zone, "
            << told[4] << " with a late image\n";
  EXPECT_TRUE(run.count < 60 || (told[1] > 20 && told[2] > 20 && told[3] > 20 && told[4] > 20));
}

TEST(SearchEvaluator, TheAgeOfImagesIsAlwaysLimited) {
  const Rig rig = rig_of(1);
  const auto refused = [&](double age_s) {
    return test::thrown_message([&] { SearchEvaluator(rig, settings_for(rig), {.max_image_age_s = age_s}); });
  };
  EXPECT_EQ(refused(0.1), "");
  EXPECT_THAT(refused(0), HasSubstr("age of 0 s"));
  EXPECT_THAT(refused(std::numeric_limits<double>::infinity()), HasSubstr("age of inf s"));
  EXPECT_THAT(refused(std::numeric_limits<double>::quiet_NaN()), HasSubstr("age of nan s"));
}

}  // namespace
}  // namespace depthgrid::search
