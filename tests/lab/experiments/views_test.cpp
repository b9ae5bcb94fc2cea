// Short versions of shadow, hidden-hand, interference and cameras: what the letter claims, and that the search is never
// too far.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "lab/experiments/cameras/camera_count.hpp"
#include "lab/experiments/hidden_hand/hidden_hand.hpp"
#include "lab/experiments/interference/interference.hpp"
#include "lab/experiments/real_sensors/scene_play.hpp"
#include "lab/experiments/shadow/shadow.hpp"
#include "lab/experiments/stage/distance_method.hpp"

namespace depthgrid::experiments {
namespace {

/// Images cast through pixel centres are exact to micrometres, the truth to 1e-5 m.
constexpr double kExact = 1e-4;

Options small(int frames) {
  Options options;
  options.quick = true;
  options.frames = frames;
  options.width_px = 160;
  return options;
}

const Deviation& row(const std::vector<LabelledDeviation>& rows, const std::string& label) {
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const auto& r) { return r.label == label; });
  EXPECT_NE(found, rows.end()) << label;
  return found->deviation;
}

/// Rows that take the space behind the robot for unknown: a lower bound is promised.
void expect_never_too_far(const std::vector<LabelledDeviation>& rows) {
  for (const auto& [label, deviation] : rows) {
    const bool sound = label.rfind("letter", 0) != 0 && label.find("background") == std::string::npos;
    if (sound && deviation.compared() > 0) {
      EXPECT_LE(deviation.largest_overestimate_m(), kExact) << label;
    }
  }
}

TEST(Shadow, OneCameraReportsFalseObstaclesAndTwoDoNot) {
  const GroupedDeviations figures = measure_shadow(small(14), nullptr);
  EXPECT_GT(figures.person_to_arm_m, DistanceMethod::kRho) << "the person came near: the shadow is not false";
  for (const std::string method : {"letter", "corrected", "search"}) {
    const Deviation& one = row(figures.chosen, method + ", 1 camera, robot = background");
    const Deviation& two = row(figures.chosen, method + ", 2 cameras, robot = background");
    EXPECT_GE(one.compared(), 20U);
    EXPECT_GT(one.false_obstacles(), 0.5) << method;
    EXPECT_LT(two.false_obstacles(), 0.05) << method;
  }
  expect_never_too_far(figures.chosen);
  expect_never_too_far(figures.otherwise);
}

TEST(Shadow, SearchIsNeverTooFarInFullSizeImagesEither) {
  Options options = small(4);
  options.width_px = 640;
  const GroupedDeviations figures = measure_shadow(options, nullptr);
  EXPECT_GT(figures.chosen.back().deviation.compared(), 0U);
  expect_never_too_far(figures.chosen);
  expect_never_too_far(figures.otherwise);
}

TEST(Shadow, SameSeedSameFigures) {
  const auto figures = [](std::uint64_t seed) {
    Options options = small(3);
    options.seed = seed;
    const GroupedDeviations found = measure_shadow(options, nullptr);
    return deviation_figures(found.chosen).dump() + deviation_figures(found.otherwise).dump();
  };
  EXPECT_EQ(figures(2), figures(2));
  EXPECT_NE(figures(2), figures(3));
}

TEST(HiddenHand, OneCameraMissesItAndASecondFindsIt) {
  const GroupedDeviations figures = measure_hidden_hand(small(24), nullptr);
  EXPECT_LT(figures.person_to_arm_m, 0.12);
  const Deviation& blind = row(figures.chosen, "letter, 1 camera, robot = background");
  EXPECT_GE(blind.compared(), 9U);
  EXPECT_GT(blind.overestimates(), 0.5);
  EXPECT_GT(blind.largest_overestimate_m(), 0.05);
  EXPECT_LT(row(figures.chosen, "letter, 2 cameras").overestimates(), 0.5 * blind.overestimates());
  // No number of cameras helps where one of them claims to have seen through the robot.
  EXPECT_GT(row(figures.chosen, "search, 2 cameras, robot = background").largest_overestimate_m(), 0.05);
  expect_never_too_far(figures.chosen);
  expect_never_too_far(figures.otherwise);
  // The price of one camera: the robot's own shadow counts when nobody is near, too.
  EXPECT_GT(row(figures.otherwise, "search, 1 camera").false_obstacles(), 0.9);
  EXPECT_LT(row(figures.otherwise, "search, 2 cameras").false_obstacles(), 0.5);
}

TEST(HiddenHand, WithASensorTheMemoryIsShownToo) {
  Options options = small(3);
  options.sensor = "kinect_v1";
  options.width_px = 64;
  const Deviation memory = row(measure_hidden_hand(options, nullptr).otherwise, "search with memory, 2 cameras");
  EXPECT_GT(memory.compared(), 0U);
  EXPECT_EQ(memory.overestimates(), 0);
}

// In small images a hole says nothing, whatever is declared.
TEST(RealSensors, WhatIsDeclaredLetsAnArmBeClearThatNeverWas) {
  ScenePlay scene{.sensor = "kinect_v1", .duration_s = 0.2};
  const SceneFigures before = play(scene);
  EXPECT_GT(before.false_obstacles, 0.9);
  EXPECT_EQ(before.every_link_clear, 0);
  scene.declared = true;
  const SceneFigures declared = play(scene);
  EXPECT_GT(declared.answers, 0U);
  EXPECT_LT(declared.false_obstacles, 0.1);
  EXPECT_EQ(declared.every_link_clear, 1);
  EXPECT_EQ(declared.largest_overestimate_m, 0);
}

TEST(Interference, ASecondKinectTakesMeasurementsAndVibrationGivesThemBack) {
  const std::vector<InterferenceCase> cases = measure_interference(small(5), nullptr);
  ASSERT_EQ(cases.size(), 3U);
  for (std::size_t camera = 0; camera < 2; ++camera) {
    const double alone = cases[0].invalid_share[camera];
    const double both = cases[1].invalid_share[camera];
    const double vibrating = cases[2].invalid_share[camera];
    EXPECT_GT(both, alone + 0.005) << camera;
    EXPECT_LT(vibrating, both - 0.005) << camera;
    EXPECT_GT(cases[1].blocked_share[camera], cases[0].blocked_share[camera]) << camera;
    EXPECT_LT(cases[2].blocked_share[camera], cases[1].blocked_share[camera]) << camera;
  }
  EXPECT_GT(row(cases[1].methods, "letter").shortfall_m(0.5), row(cases[0].methods, "letter").shortfall_m(0.5));
  EXPECT_LT(row(cases[2].methods, "letter").shortfall_m(0.5), row(cases[1].methods, "letter").shortfall_m(0.5));
  for (const InterferenceCase& c : cases) {
    EXPECT_LE(row(c.methods, "search").largest_overestimate_m(), kExact) << c.label;
  }
}

TEST(Cameras, EveryOneOfThemFreesMoreAndNoneMakesTheSearchTooFar) {
  const std::vector<CameraCount> counts = measure_camera_counts(small(2));
  ASSERT_EQ(counts.size(), 8U);
  EXPECT_GT(counts[0].gray.share(), 2 * counts[1].gray.share());
  EXPECT_GT(counts[1].gray.share(), 2 * counts[7].gray.share());
  EXPECT_GT(counts[0].gray.empty_near, 100U);
  for (const CameraCount& count : counts) {
    const CountedMethod& search = count.methods.back();
    EXPECT_EQ(search.label, "search");
    EXPECT_GT(search.evaluation_s, 0) << count.cameras;
    EXPECT_GT(search.far, 10U);
    EXPECT_LE(search.deviation.largest_overestimate_m(), kExact) << count.cameras;
  }
  const auto pockets = [&](std::size_t i) { return counts[i].methods.back().pockets; };
  EXPECT_GT(2 * pockets(0), counts[0].methods.back().far) << "one camera: most of the robot touches its own shadow";
  EXPECT_LT(4 * pockets(7), pockets(0));
}

}  // namespace
}  // namespace depthgrid::experiments
