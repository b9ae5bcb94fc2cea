// The least padding in the letter's cell, seen by simulated sensors with their noise and their holes. Prints the table
// of docs/robot.md.
#include <gtest/gtest.h>

#include <ctime>
#include <iostream>

#include "avoidance/kinect_cell.hpp"
#include "avoidance/padding_twin.hpp"
#include "support/random_run.hpp"

namespace depthgrid::avoidance {
namespace {

LeastPadding found_in(const test::KinectCell& cell) {
  return least_padding(cell.rig, cell.model, cell.cells, cell.settings);
}

TEST(LeastPaddingWithAKinect, IsNoMoreThanTheExperimentsPadding) {
  const depthgrid::test::RandomRun run = depthgrid::test::random_run(2);
  for (std::int64_t i = 0; i < run.count; ++i) {
    const std::string what = "case " + std::to_string(i) + "; " + run.reproduce();
    const test::KinectCell cell = test::kinect_cell({.seed = run.seed + static_cast<std::uint64_t>(i)});
    const std::clock_t begin = std::clock();
    const LeastPadding found = found_in(cell);
    const double processor_s = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    ASSERT_TRUE(found.padding_m) << what << '\n' << to_string(found, cell.rig);
    std::cout << to_string(found, cell.rig) << processor_s << " s of processor time\n";
    EXPECT_LE(*found.padding_m, 0.05) << what;
    EXPECT_GT(*found.padding_m, cell.settings.paddings_m.front()) << what;
    // Looked at anew: the padding clears every link, and the one before it not the deciding one.
    LeastPaddingSettings settings = cell.settings;
    const LinkPadding& link = found.links[*found.decides];
    ASSERT_TRUE(link.before) << what;
    settings.paddings_m = {link.before->padding_m, *found.padding_m};
    const auto twins = test::twin_paddings(cell.rig, cell.model, cell.cells, settings, found.robot_within_m);
    ASSERT_EQ(twins.size(), found.links.size()) << what;
    for (std::size_t k = 0; k < twins.size(); ++k) {
      ASSERT_TRUE(twins[k].least_m) << what << ", " << found.links[k].name;
      EXPECT_EQ(twins[k].clear_to_m, *found.padding_m) << what << ", " << found.links[k].name;
    }
    EXPECT_EQ(twins[*found.decides].least_m, found.padding_m) << what;
    EXPECT_TRUE(link.before->decides) << what;
  }
}

TEST(LeastPaddingWithAKinect, IsMoreWithTheMarginInIt) {
  const LeastPadding in_test = found_in(test::kinect_cell({}));
  const test::KinectCell cell = test::kinect_cell({.margin_in_test = false});
  const LeastPadding found = found_in(cell);
  std::cout << to_string(found, cell.rig);
  ASSERT_TRUE(in_test.padding_m && found.padding_m);
  // It is in the padding twice: 2 m(D) at 2 m is 5.6 cm.
  EXPECT_GT(*found.padding_m, *in_test.padding_m + 0.02);
}

TEST(LeastPaddingWithStereo, IsNoneTwoMetresAwayAndSaysWhy) {
  const test::KinectCell cell = test::kinect_cell({.sensor = "realsense_d435"});
  const LeastPadding found = found_in(cell);
  std::cout << to_string(found, cell.rig);
  for (const LinkPadding& link : found.links) {
    EXPECT_FALSE(link.least_m) << link.name;
    ASSERT_TRUE(link.before) << link.name;
    ASSERT_EQ(link.before->cameras.size(), 2U) << link.name;
    EXPECT_EQ(link.before->answer.nearest.state, ProximityState::unmeasured) << link.name;
  }
}

TEST(LeastPaddingWithAKinect, OfHalfTheImageNeedsALargerSmallestObstacle) {
  test::KinectCell cell = test::kinect_cell({.width_px = 320});
  const LeastPadding none = found_in(cell);
  std::cout << to_string(none, cell.rig);
  EXPECT_FALSE(none.decides) << "holes of a pixel are as wide as what is declared";
  for (CameraMargins& margins : cell.settings.search.margins) {
    margins.smallest_obstacle_m = 0.1;
  }
  const LeastPadding found = found_in(cell);
  std::cout << to_string(found, cell.rig);
  EXPECT_TRUE(found.decides) << to_string(found, cell.rig);
}

}  // namespace
}  // namespace depthgrid::avoidance
