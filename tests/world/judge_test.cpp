// The judge exempts what lies in the blind layer, point by point, and nothing else.
#include "world/judge.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "world/draw.hpp"

namespace depthgrid::world {
namespace {

using Eigen::Vector3d;

constexpr double kBlind_m = 0.1;

/// A link of radius 5 cm along z, and a stick of radius 1 cm from `from_m` to `to_m` beside it.
World world_with(double from_m, double to_m) {
  World world;
  world.solids.push_back({{standing({from_m, 0, 0})}, {standing({to_m, 0, 0})}, 0.01});
  return world;
}
const Look kLook{0.9, 1.1, {{{0, 0, -1}, {0, 0, 1}, 0.05}}};
const Capsule kAsked = Capsule::point({0.06, 0, 0.3});

Verdict verdict(const World& world, double answer_m, double blind_m = kBlind_m) {
  return judge(world, kAsked, answer_m, 1.0, blind_m, {&kLook, 1});
}

TEST(Judge, AnAnswerThatIsNotAboveTheTruthIsRight) {
  const World world = world_with(0.09, 0.12);
  const double truth_m = std::hypot(0.03, 0.3) - 0.01;
  EXPECT_NEAR(verdict(world, 0).truth_m, truth_m, 1e-12);
  EXPECT_FALSE(verdict(world, truth_m).excess_m);
  EXPECT_FALSE(verdict(world, truth_m).in_layer);
}

TEST(Judge, WhatIsWhollyInTheLayerIsExempt) {
  const Verdict found = verdict(world_with(0.08, 0.12), 0.5);
  EXPECT_TRUE(found.in_layer);
  EXPECT_FALSE(found.excess_m);
}

TEST(Judge, WhatReachesOutOfItCountsFromThere) {
  const World world = world_with(0.08, 0.3);
  // Its part beyond 15 cm from the link's axis is about hypot(0.09, 0.3) - 0.01 away.
  EXPECT_FALSE(verdict(world, std::hypot(0.09, 0.3) - 0.012).excess_m);
  const auto excess_m = verdict(world, 0.5).excess_m;
  ASSERT_TRUE(excess_m);
  EXPECT_NEAR(*excess_m, 0.5 - (std::hypot(0.09, 0.3) - 0.01), 0.01);
}

TEST(Judge, WithoutLayerOrWithAnUnknownOneNothingIsExempt) {
  EXPECT_TRUE(verdict(world_with(0.08, 0.12), 0.5, 0.0).excess_m);
  EXPECT_TRUE(verdict(world_with(0.08, 0.12), 0.5, std::nan("")).excess_m);
  EXPECT_TRUE(judge(world_with(0.08, 0.12), kAsked, 0.5, 1.0, kBlind_m, {}).excess_m);
}

TEST(Judge, AThingIsWhereItWasAtTheExposure) {
  World world = world_with(0.08, 0.12);
  // At the exposure it was 30 cm away, in no layer; now it is.
  for (Place* end : {&world.solids[0].a, &world.solids[0].b}) {
    end->path = std::make_shared<const Path>(
        std::vector<Path::Stop>{{1.1, end->path->at(0) + Vector3d(0.3, 0, 0)}, {1.3, end->path->at(0)}});
  }
  EXPECT_TRUE(judge(world, kAsked, 0.5, 1.3, kBlind_m, {&kLook, 1}).excess_m);
}

TEST(Judge, TheFloorIsJudgedAsWell) {
  World world;
  world.walls.push_back({Vector3d::UnitZ(), 0.0});
  const Look standing_link{0, 0, {{{0, 0, 0.05}, {0, 0, 1}, 0.05}}};
  const Capsule asked = Capsule::point({0, 0, 0.2});
  EXPECT_FALSE(judge(world, asked, 0.2, 0, kBlind_m, {&standing_link, 1}).in_layer);
  EXPECT_TRUE(judge(world, asked, 0.21, 0, kBlind_m, {&standing_link, 1}).in_layer);
  EXPECT_TRUE(judge(world, asked, 0.4, 0, kBlind_m, {&standing_link, 1}).excess_m);
}

}  // namespace
}  // namespace depthgrid::world
