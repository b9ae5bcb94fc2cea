// The layer around a removed robot: what states it, what errors add to it, and what is left of a distance outside of
// it.
#include "depthgrid/core/blind_layer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "depthgrid/core/answer.hpp"
#include "depthgrid/core/usable_frame.hpp"

namespace depthgrid {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr PinholeCamera kCamera{8, 6, 10, 10, 4, 3};
const double kHalfPixel = std::sqrt(0.5) / 10;

struct Robot {
  std::vector<float> near_m = std::vector<float>(48, 0.0F);
  std::vector<float> far_m = std::vector<float>(48, 0.0F);
  [[nodiscard]] RobotView view() const { return {near_m.data(), far_m.data(), 0}; }
};

TEST(BlindLayer, OfRenderedIntervalsIsThePaddingAndHalfAPixelAtTheirDeepest) {
  Robot robot;
  robot.near_m[20] = 1.0F;
  robot.far_m[20] = 1.5F;
  robot.near_m[21] = 1.0F;
  robot.far_m[21] = std::numeric_limits<float>::infinity();  // is no robot
  const RobotView view = with_layer(robot.view(), kCamera, 0.05);
  EXPECT_NEAR(view.blind_m, 0.05 + 1.5 * kHalfPixel, 1e-9);
  EXPECT_NEAR(view.reach_m, 1.5 * std::hypot(0.4, 0.3, 1.0), 1e-9) << "in the corner";
  EXPECT_EQ(view.near_m, robot.near_m.data());
}

TEST(BlindLayer, IsNoneWhereTheRobotIsInNoPixel) {
  const Robot robot;
  EXPECT_EQ(with_layer(robot.view(), kCamera, 0.05).blind_m, 0);
  EXPECT_EQ(blind_layer_m(with_layer(robot.view(), kCamera, 0.05), kCamera, {0.1, 0, 0, 3}, {0.1, 0.1, 0.1}), 0);
  EXPECT_EQ(blind_layer_m({}, kCamera, {}, {}), 0);
}

TEST(BlindLayer, IsUnknownUnlessStated) {
  const Robot robot;
  EXPECT_TRUE(std::isnan(robot.view().blind_m));
  EXPECT_TRUE(std::isnan(blind_layer_m(robot.view(), kCamera, {}, {})));
  EXPECT_TRUE(std::isnan(with_layer(robot.view(), kCamera, -0.01).blind_m));
  EXPECT_TRUE(std::isnan(with_layer(robot.view(), kCamera, kNaN).blind_m));
  EXPECT_EQ(thicker(0.1, 0.2), 0.2);
  EXPECT_EQ(thicker(0.2, 0.1), 0.2);
  EXPECT_TRUE(std::isnan(thicker(0.1, kNaN)));
  EXPECT_TRUE(std::isnan(thicker(kNaN, 0.1)));
}

TEST(BlindLayer, GrowsByReadingsBesideTheirPlaceAndByCalibrationButNotByTime) {
  RobotView view = Robot().view();
  view.blind_m = 0.05;
  view.reach_m = 2;
  EXPECT_EQ(blind_layer_m(view, kCamera, {0.01, 0.01, 0.01, 0}, {0, 0, 5}), 0.05);
  EXPECT_NEAR(blind_layer_m(view, kCamera, {0, 0, 0, 3}, {}), 0.05 + 6 * kHalfPixel * 2, 1e-12);
  EXPECT_NEAR(blind_layer_m(view, kCamera, {0, 0, 0, 0}, {0.02, 0.001, 0}), 0.05 + 0.02 + 0.002, 1e-12);
}

TEST(BlindLayer, ThatIsNoThicknessMakesAFrameUnusable) {
  const std::vector<float> depth_m(48, 2.0F);
  const Robot robot;
  RigCamera camera;
  camera.intrinsics = kCamera;
  Frame frame{depth_view(depth_m, 8, 6), robot.view(), 0};
  EXPECT_EQ(why_unusable(frame, camera), nullptr) << "not stated is no fault of the image";
  for (const double bad : {-0.01, std::numeric_limits<double>::infinity()}) {
    frame.robot = robot.view();
    frame.robot.blind_m = bad;
    EXPECT_NE(why_unusable(frame, camera), nullptr);
    frame.robot = robot.view();
    frame.robot.reach_m = bad;
    EXPECT_NE(why_unusable(frame, camera), nullptr);
  }
}

TEST(ClearOfLayer, IsWhatIsLeftOfTheDistance) {
  const auto clear_m = [](double distance_now_m, double blind_m) {
    Answer answer;
    answer.distance_now_m = distance_now_m;
    answer.blind_m = blind_m;
    return clear_of_layer_m(answer);
  };
  EXPECT_EQ(clear_m(0.3, 0), 0.3);
  EXPECT_NEAR(clear_m(0.3, 0.1), 0.2, 1e-15);
  EXPECT_EQ(clear_m(0.1, 0.1), 0);
  EXPECT_EQ(clear_m(0.05, 0.1), 0);
  EXPECT_TRUE(std::isnan(clear_m(kNaN, 0.1)));
  EXPECT_TRUE(std::isnan(clear_m(0.3, kNaN)));
  EXPECT_TRUE(std::isnan(clear_of_layer_m(Answer{}))) << "nothing was evaluated";
}

}  // namespace
}  // namespace depthgrid
