// What the experiments are made of: figures, truth, images.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "lab/experiments/cameras/camera_count.hpp"
#include "lab/experiments/experiment.hpp"
#include "lab/experiments/stage/camera_images.hpp"
#include "lab/experiments/stage/deviation.hpp"
#include "lab/experiments/stage/point_truth.hpp"
#include "lab/experiments/stage/rig_width.hpp"
#include "lab/experiments/stage/two_views.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::experiments {
namespace {

using ::testing::HasSubstr;

Proximity answer(double distance_m, double known_to_m = Proximity::kNaN) {
  Proximity proximity;
  proximity.distance_m = distance_m;
  proximity.known_to_m = known_to_m;
  proximity.state = ProximityState::measured;
  return proximity;
}

TEST(Registry, NamesAreDistinctAndUnknownOnesListTheRest) {
  std::set<std::string_view> names;
  for (const Experiment& experiment : experiments()) {
    EXPECT_TRUE(names.insert(experiment.name).second) << experiment.name;
    EXPECT_FALSE(experiment.summary.empty()) << experiment.name;
    EXPECT_EQ(&depthgrid::experiments::experiment(experiment.name), &experiment);
  }
  const std::string message = test::thrown_message([] { (void)experiment("shado"); });
  EXPECT_THAT(message, HasSubstr("'shado'"));
  EXPECT_THAT(message, HasSubstr("shadow, hidden-hand, blind-layer, self-filter, interference, cameras"));
}

TEST(Registry, OptionsOutOfRangeAreRefused) {
  Options options;
  options.frames = 0;
  EXPECT_THAT(test::thrown_message([&] { validate(options); }), HasSubstr("frames is 0"));
  options.frames = 1;
  options.width_px = 30;
  EXPECT_THAT(test::thrown_message([&] { validate(options); }), HasSubstr("width is 30 px"));
  options.width_px = 64;
  EXPECT_EQ(test::thrown_message([&] { validate(options); }), "");
}

TEST(Deviation, CountsTooNearAndTooFarUpToRho) {
  Deviation deviation(0.4);
  deviation.add(answer(0.1), 0.9);    // 0.3 too near: the truth counts as 0.4
  deviation.add(answer(0.35), 0.4);   // 0.05 too near
  deviation.add(answer(0.325), 0.3);  // 0.025 too far
  deviation.add(answer(0.4), 0.5);    // both at rho
  EXPECT_EQ(deviation.compared(), 4U);
  EXPECT_DOUBLE_EQ(deviation.false_obstacles(), 0.25);
  EXPECT_DOUBLE_EQ(deviation.overestimates(), 0.25);
  EXPECT_NEAR(deviation.largest_overestimate_m(), 0.025, 1e-12);
  EXPECT_NEAR(deviation.shortfall_m(1), 0.3, 1e-12);
}

TEST(Deviation, DoesNotCompareWhereTheSpaceEndsBeforeTheTruth) {
  Deviation deviation(0.4);
  deviation.add(answer(0.4, 0.2), 0.3);  // the obstacle may be outside
  deviation.add({}, 0.3);                // no answer
  deviation.add(answer(0.3, 0.5), 0.3);
  EXPECT_EQ(deviation.not_compared(), 2U);
  EXPECT_EQ(deviation.compared(), 1U);
}

TEST(PointTruth, IsTheDistanceOfTheAnalyticScene) {
  StagedCell stage(simulation::Motion::reach, stage_around_the_wrist(), 3);
  PointTruth truth(stage.cell(), kControlPoints);
  bool person_nearest = false;
  for (int i = 0; i < 20; ++i) {
    stage.move_to(stage.person().duration_s() * i / 20);
    const auto found = truth.distances(stage.cell(), stage.arm().points_world());
    const simulation::Scene scene = simulation::scene_of(stage.cell());
    for (std::size_t p = 0; p < kControlPoints; ++p) {
      EXPECT_NEAR(found[p].distance_m, scene.distance(stage.arm().points_world()[p]).distance_m, 2e-5) << i << " " << p;
      person_nearest |= found[p].to == simulation::BodyKind::person;
    }
  }
  EXPECT_TRUE(person_nearest) << "nobody reached for the arm";
}

TEST(ArmAtWork, ControlPointsLieOnTheAxisInsideTheCapsules) {
  ArmAtWork arm;
  for (const double time_s : {0.0, 3.0, 7.5}) {
    arm.move_to(time_s);
    for (const Eigen::Vector3d& p_world : arm.points_world()) {
      EXPECT_TRUE(std::any_of(arm.capsules_world().begin(), arm.capsules_world().end(), [&](const Capsule& link) {
        return simulation::contains(link, p_world);
      })) << p_world.transpose();
    }
  }
}

TEST(CameraImages, RobotIsInTheIntervalOrReplacedByTheRoom) {
  const Rig rig = with_width(two_views("ideal").rig, 96);
  StagedCell stage(simulation::Motion::reach, stage_around_the_wrist(), 1);
  CameraImages unknown(rig, stage, RobotPixels::behind_unknown, {});
  CameraImages background(rig, stage, RobotPixels::background, {});
  unknown.take(stage, 0);
  background.take(stage, 0);
  for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
    const RobotView& robot = unknown.frames()[k].robot;
    ASSERT_NE(robot.near_m, nullptr);
    EXPECT_EQ(background.frames()[k].robot.near_m, nullptr);
    int replaced = 0;
    for (int v = 0; v < 72; ++v) {
      for (int u = 0; u < 96; ++u) {
        const float with = unknown.depth_m(k).at(u, v);
        const float without = background.depth_m(k).at(u, v);
        if (with != without) {  // the robot's pixels and no others
          ++replaced;
          const std::ptrdiff_t i = v * robot.stride_px + u;
          EXPECT_LT(with, without);
          EXPECT_LE(robot.near_m[i], with);
          EXPECT_GE(robot.far_m[i], with);
        }
      }
    }
    EXPECT_GT(replaced, 50) << "camera " << k << " does not see the robot";
  }
}

TEST(TwoViews, BothSecondCamerasStandFourMetresFromTheFirst) {
  const Rig rig = two_views("ideal").rig;
  for (const std::size_t second : {kOppositeCamera, kAsideCamera}) {
    EXPECT_NEAR(
        (rig.cameras[second].T_world_camera.translation() - rig.cameras[kFirstCamera].T_world_camera.translation())
            .norm(),
        4.0, 0.05);
  }
}

TEST(TwoViews, SecondCamerasStandOppositeAndAThirdAroundTheRobot) {
  const Rig rig = two_views("ideal").rig;
  const auto around_deg = [&](std::size_t second) {
    const Eigen::Vector2d a = rig.cameras[kFirstCamera].T_world_camera.translation().head<2>().normalized();
    const Eigen::Vector2d b = rig.cameras[second].T_world_camera.translation().head<2>().normalized();
    return std::acos(std::clamp(a.dot(b), -1.0, 1.0)) * 180 / std::numbers::pi;
  };
  EXPECT_NEAR(around_deg(kOppositeCamera), 180, 1e-3);
  EXPECT_NEAR(around_deg(kAsideCamera), 123, 0.5);
  // The opposite ones face each other.
  const auto axis = [&](std::size_t k) -> Eigen::Vector3d { return rig.cameras[k].T_world_camera.linear().col(2); };
  EXPECT_NEAR(axis(kFirstCamera).dot(axis(kOppositeCamera)), -1, 1e-9);
}

TEST(LinearFit, FindsALineFromTwoCamerasOn) {
  std::vector<CameraCount> counts;
  for (int cameras = 1; cameras <= 5; ++cameras) {
    CameraCount& count = counts.emplace_back();
    count.cameras = cameras;
    count.methods.push_back({"a", cameras == 1 ? 100.0 : 2.0 + 3.0 * cameras, 0, Deviation(0.4), 0, 0});
  }
  const LinearFit fit = linear_fit(counts, 0);
  EXPECT_NEAR(fit.offset_s, 2, 1e-9);
  EXPECT_NEAR(fit.slope_s, 3, 1e-9);
  EXPECT_NEAR(fit.r_squared, 1, 1e-9);
}

}  // namespace
}  // namespace depthgrid::experiments
