// What the worlds promise of their things: no point of them outruns the declared speed, none is thinner than promised.
#include "world/motion.hpp"

#include <gtest/gtest.h>

#include "support/random_run.hpp"
#include "world/draw.hpp"

namespace depthgrid::world {
namespace {

TEST(Motion, NoPointOfAThingIsFasterThanDeclared) {
  const test::RandomRun run = test::random_run(200);
  double fastest = 0;
  for (std::int64_t i = 0; i < run.count; ++i) {
    const World world = make_world({run.seed + static_cast<std::uint64_t>(i), 0, Broken::none});
    Random random(run.seed + static_cast<std::uint64_t>(i), 200);
    for (const Solid& solid : world.solids) {
      for (int pair = 0; pair < 40; ++pair) {
        const double t0_s = random.uniform(0, world.duration_s);
        const double t1_s = random.chance(0.5) ? t0_s + random.uniform(0, 0.05) : random.uniform(0, world.duration_s);
        const double most_m = world.settings.v_max_m_s * std::abs(t1_s - t0_s);
        for (const Place* end : {&solid.a, &solid.b}) {
          const double moved_m = (end->at(t1_s) - end->at(t0_s)).norm();
          EXPECT_LE(moved_m, most_m + 1e-12) << i << "; " << run.reproduce();
          fastest = most_m > 1e-4 ? std::max(fastest, moved_m / most_m) : fastest;
        }
      }
    }
  }
  EXPECT_GT(fastest, 0.999) << "the bound is reached";
}

TEST(Motion, AFasterWorldIsFaster) {
  const World world = make_world({1, 0, Broken::faster});
  EXPECT_GE(true_speed_m_s(world), 1.5 * world.settings.v_max_m_s);
}

TEST(Motion, NothingIsThinnerThanARayFinds) {
  const test::RandomRun run = test::random_run(200);
  for (std::int64_t i = 0; i < run.count; ++i) {
    const World world = make_world({run.seed + static_cast<std::uint64_t>(i), 0, Broken::none});
    for (const Solid& solid : world.solids) {
      EXPECT_GE(solid.radius_m, least_radius_m(world)) << i << "; " << run.reproduce();
    }
  }
}

TEST(Motion, AWorldIsTheSameEachTime) {
  const World a = make_world({17, 0, Broken::none});
  const World b = make_world({17, 0, Broken::none});
  ASSERT_EQ(a.solids.size(), b.solids.size());
  ASSERT_EQ(a.exposures.size(), b.exposures.size());
  for (std::size_t i = 0; i < a.solids.size(); ++i) {
    EXPECT_EQ(a.solids[i].at(1.5).a, b.solids[i].at(1.5).a);
  }
  EXPECT_EQ(to_string(a.rig), to_string(b.rig));
  EXPECT_EQ(views::to_string(a.settings), views::to_string(b.settings));
}

}  // namespace
}  // namespace depthgrid::world
