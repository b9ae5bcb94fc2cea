// The least padding of two posts whose images are made so that the answer is known: who decides, what never clears, and
// what a layer must not cover.
#include "depthgrid/avoidance/least_padding.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "avoidance/post_cell.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::avoidance {
namespace {

using depthgrid::test::thrown_message;
using Eigen::Vector3d;
using ::testing::HasSubstr;

LeastPadding found_in(const test::PostCell& cell) {
  return least_padding(cell.rig, cell.model, cell.cells, cell.settings);
}

/// A ball of 3 cm beside 'post', whose surface is gap_m from it.
Capsule beside_post(double gap_m) { return Capsule::sphere({0, -(0.05 + gap_m + 0.015), 0.4}, 0.015); }

TEST(LeastPadding, IsTheSmallestTestedWhereNothingErrs) {
  const test::PostCell cell = test::post_cell({{}});
  const LeastPadding found = found_in(cell);
  ASSERT_EQ(found.links.size(), 2U);
  for (const LinkPadding& link : found.links) {
    EXPECT_EQ(link.least_m, 0.01);
    EXPECT_FALSE(link.before);
  }
  EXPECT_EQ(found.padding_m, 0.01);
  EXPECT_THAT(to_string(found, cell.rig), HasSubstr("the smallest that was tested"));
}

TEST(LeastPadding, IsDecidedByTheCameraThatErrs) {
  for (const std::size_t wrong : {0U, 1U}) {
    test::PostOptions options;
    options.nearer_m.assign(2, 0);
    options.nearer_m[wrong] = 0.05;
    const test::PostCell cell = test::post_cell({{}, options});
    const LeastPadding found = found_in(cell);
    ASSERT_TRUE(found.padding_m) << to_string(found, cell.rig);
    // Its readings lie 5 cm before the posts; the layer is thicker than the padding by a pixel.
    EXPECT_GE(*found.padding_m, 0.03);
    EXPECT_LE(*found.padding_m, 0.05);
    EXPECT_GT(found.blind_m, *found.padding_m);
    const LinkPadding& link = found.links[*found.decides];
    EXPECT_EQ(link.least_m, found.padding_m);
    ASSERT_TRUE(link.before);
    EXPECT_EQ(link.before->cell, 1U);
    EXPECT_EQ(link.before->decides, wrong);
    EXPECT_EQ(link.before->answer.nearest.state, ProximityState::occluded);
    const double side = wrong == 0 ? -1 : 1;
    EXPECT_GT(side * link.before->answer.nearest.nearest_world.x(), 0.05);
    ASSERT_EQ(link.before->cameras.size(), 2U);
    EXPECT_EQ(link.before->cameras[wrong].state, ProximityState::occluded);
    EXPECT_FALSE(link.before->cameras[wrong].behind_robot) << "but behind what it reads before the robot";
    EXPECT_EQ(link.before->cameras[1 - wrong].state, ProximityState::occluded);
    EXPECT_TRUE(link.before->cameras[1 - wrong].behind_robot);
    const std::string text = to_string(found, cell.rig);
    EXPECT_THAT(text, HasSubstr(link.name + " decides, by camera '" + cell.rig.cameras[wrong].id + "'"));
    EXPECT_THAT(text, HasSubstr("'" + cell.rig.cameras[1 - wrong].id + "': hidden behind the robot"));
  }
}

TEST(LeastPadding, OfALinkBeforeAHoleIsNoneAndSaysWhy) {
  for (const std::size_t blinded : {0U, 1U}) {
    const Vector3d at(0, 0, 0.4);
    const test::PostCell cell = test::post_cell({{.T_world_camera = {}, .holes = {{blinded, at, 2}}}});
    const LeastPadding found = found_in(cell);
    const LinkPadding& post = test::of_link(found, "post");
    EXPECT_FALSE(post.least_m);
    ASSERT_TRUE(post.before);
    EXPECT_EQ(post.before->answer.nearest.state, ProximityState::occluded);  // one of the two says so
    EXPECT_EQ(post.before->cameras[blinded].state, ProximityState::unmeasured);
    EXPECT_EQ(post.before->cameras[blinded].unmeasured, Unmeasured::no_reading);
    EXPECT_TRUE(post.before->cameras[1 - blinded].behind_robot);
    EXPECT_FALSE(post.before->decides);
    // The other link is told all the same, and is what there is to use.
    EXPECT_EQ(found.padding_m, 0.01);
    const std::string text = to_string(found, cell.rig);
    EXPECT_THAT(text, HasSubstr("post is not clear up to"));
    EXPECT_THAT(text, HasSubstr("'" + cell.rig.cameras[blinded].id + "': space without a reading"));
  }
}

TEST(LeastPadding, CoversNothingThatStandsThere) {
  test::PostOptions options;
  options.nearer_m = {0.05, 0};
  options.things_world = {beside_post(0.125)};
  test::PostCell cell = test::post_cell({options});
  const LeastPadding found = found_in(cell);
  const LinkPadding& post = test::of_link(found, "post");
  EXPECT_FALSE(post.least_m) << "a layer that hides the ball is no remedy";
  ASSERT_TRUE(post.covers_from_m);
  EXPECT_LT(*post.covers_from_m, 0.125);
  ASSERT_TRUE(post.before);
  EXPECT_NEAR(post.before->answer.nearest.distance_m, 0.125, 0.03);  // pixels are 14 mm there
  EXPECT_LT(post.before->answer.nearest.nearest_world.y(), -0.1);
  EXPECT_THAT(to_string(found, cell.rig), HasSubstr("no part of the robot"));

  cell.settings.robot_within_m = 0.18;  // declared: it is
  const LinkPadding covered = test::of_link(found_in(cell), "post");
  ASSERT_TRUE(covered.least_m);
  EXPECT_GT(*covered.least_m, 0.09);
}

TEST(LeastPadding, IsNoneForAllWhereOneNeedsMoreThanAnotherBears) {
  test::PostOptions options;
  options.nearer_m = {0.07, 0};
  options.errs = {true, false};
  options.things_world = {Capsule::sphere({0, 0.8 + 0.05 + 0.17 + 0.05, 0.4}, 0.05)};
  test::PostCell cell = test::post_cell({options});
  const LeastPadding found = found_in(cell);
  const std::string text = to_string(found, cell.rig);
  const LinkPadding& post = test::of_link(found, "post");
  const LinkPadding& other = test::of_link(found, "other");
  ASSERT_TRUE(post.least_m) << text;
  EXPECT_EQ(other.least_m, 0.01) << text;
  EXPECT_LT(other.clear_to_m, *post.least_m) << text;
  EXPECT_FALSE(found.padding_m);
  ASSERT_TRUE(found.decides);
  EXPECT_EQ(found.links[*found.decides].name, "post");
  ASSERT_TRUE(other.after);
  EXPECT_GT(other.after->padding_m, other.clear_to_m);
  EXPECT_GT(other.after->answer.nearest.nearest_world.y(), 0.95) << "the ball";
  EXPECT_THAT(text, HasSubstr("No padding clears all links at once: post needs"));
  EXPECT_THAT(text, HasSubstr("other is clear up to"));
  // So clear is not monotone: the same link, asked with the larger padding alone, is not.
  cell.settings.paddings_m = {*post.least_m};
  EXPECT_FALSE(test::of_link(found_in(cell), "other").least_m);
}

TEST(LeastPadding, IsThatOfTheLoopsMemory) {
  const Vector3d at(0, 0, 0.4);
  std::vector<test::PostOptions> instants(6);
  instants.back().holes = {{0, at, 2}};  // a reading that was there until now
  test::PostCell cell = test::post_cell(instants);
  cell.settings.search.v_max_m_s = 0.1;
  EXPECT_FALSE(test::of_link(found_in(cell), "post").least_m);
  const auto& box = std::get<views::BoxSpace>(cell.settings.search.space);
  cell.settings.evaluator.memory =
      memory::MemorySettings{.low_world = box.low_world, .high_world = box.high_world, .start = memory::StartUnknown{}};
  cell.settings.warm_up = 5;
  const LeastPadding found = found_in(cell);
  EXPECT_TRUE(test::of_link(found, "post").least_m) << to_string(found, cell.rig);
}

TEST(LeastPadding, TellsWhatCannotBeAsked) {
  test::PostCell cell = test::post_cell({{}});
  const auto told = [&] { return thrown_message([&] { (void)found_in(cell); }); };
  EXPECT_EQ(told(), "");
  const LeastPaddingSettings good = cell.settings;
  cell.settings.search.rho_m = 0.1;
  EXPECT_THAT(told(), HasSubstr("rho_m must be at least"));
  cell.settings = good;
  cell.settings.robot_within_m = 0.02;
  EXPECT_THAT(told(), HasSubstr("test smaller ones, or state robot_within_m"));
  cell.settings = good;
  cell.settings.warm_up = 1;
  EXPECT_THAT(told(), HasSubstr("1 of 1 cells are for the warm-up"));
  cell.settings = good;
  cell.settings.paddings_m = {0.02, 0.13};
  EXPECT_THAT(told(), HasSubstr("the step from 0.02 to 0.13 m is more than the clearance"));
  cell.settings.paddings_m = {0.02, 0.02};
  EXPECT_THAT(told(), HasSubstr("ascend"));
  cell.settings = good;
  cell.settings.clearance_m = 0;
  EXPECT_THAT(told(), HasSubstr("clearance is 0 m"));
  cell.settings = good;
  cell.cells[0].seen.pop_back();
  EXPECT_THAT(told(), HasSubstr("cell 0 has 1 images"));
}

TEST(LeastPadding, ALinkOutsideOfTheSpaceOfInterestIsTold) {
  test::PostCell cell = test::post_cell({{}});
  cell.settings.search.space = views::BoxSpace{{5, 5, 5}, {6, 6, 6}};
  cell.settings.search.policies.outside = views::Policy::ignored;
  const std::string text = to_string(found_in(cell), cell.rig);
  EXPECT_THAT(text, HasSubstr("it reaches out of the space of interest"));
  EXPECT_THAT(text, ::testing::Not(HasSubstr("nan")));
}

TEST(RobotWithin, IsTheSumOfWhatIsDeclared) {
  const test::PostCell cell = test::post_cell({{}});
  constexpr double kReach_m = 2;
  views::Settings settings = cell.settings.search;
  const double half_pixel_m = std::sqrt(0.5) / 110 * kReach_m;  // the cameras' focal length
  EXPECT_NEAR(robot_within_m(cell.rig, settings, kReach_m), 0.02 + half_pixel_m, 1e-12);
  settings.v_max_m_s = 2;
  settings.margins[1] = {.sensor = {0.01, 0.002, 0.001, 2},
                         .translation_m = 0.003,
                         .rotation_rad = 0.001,
                         .half_exposure_s = 0.008,
                         .time_uncertainty_s = 0.002,
                         .smallest_obstacle_m = 0.05};
  EXPECT_NEAR(robot_within_m(cell.rig, settings, kReach_m),
              0.02 + 2 * (0.01 + 0.004 + 0.004) + 0.003 + 0.002 + 0.02 * 1.001 + 5 * half_pixel_m + 0.025, 1e-12);
  const double used_m = [&] {
    LeastPaddingSettings all = cell.settings;
    all.robot_within_m.reset();
    return least_padding(cell.rig, cell.model, cell.cells, all).robot_within_m;
  }();
  EXPECT_GT(used_m, 0.02 + half_pixel_m * 0.75);  // the posts are 1.5 to 1.8 m away
  EXPECT_LT(used_m, 0.02 + half_pixel_m);
}

TEST(PaddingLadder, HasBothEnds) {
  const std::vector<double> ladder = padding_ladder(0.01, 0.2, 0.005);
  ASSERT_EQ(ladder.size(), 39U);
  EXPECT_EQ(ladder.front(), 0.01);
  EXPECT_NEAR(ladder.back(), 0.2, 1e-9);
  EXPECT_THAT(thrown_message([] { (void)padding_ladder(0.1, 0.05, 0.01); }), HasSubstr("must ascend"));
}

}  // namespace
}  // namespace depthgrid::avoidance
