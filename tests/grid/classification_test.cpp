// What an answer says of its nearest point.
#include "depthgrid/grid/classification.hpp"

#include <gtest/gtest.h>

namespace depthgrid::grid {
namespace {

/// One camera at the origin that looks along z; 20x20 pixels, each 0.1 wide at z = 1.
struct OneCamera {
  DepthImage depth_m{20, 20};
  ViewingCamera view{{20, 20, 10, 10, 10, 10}, Pose::Identity(), 0.0, nullptr};
  SensorMargin margin{0.0, 0.0, 0.0, 1};

  [[nodiscard]] Classification at(const Eigen::Vector3d& p) {
    view.measured_m = &depth_m;
    return classify({&p, 1}, {&view, 1}, margin, 0.01);
  }
  void fill(float value_m) { std::fill_n(depth_m.data(), 400, value_m); }
};

TEST(Classification, SurfaceShadowHoleAndNothing) {
  OneCamera one;
  one.fill(2.0F);
  EXPECT_EQ(one.at({0.05, 0.05, 2.005}).state, ProximityState::measured);
  EXPECT_EQ(one.at({0.05, 0.05, 2.005}).camera, 0);
  EXPECT_EQ(one.at({0.05, 0.05, 2.5}).state, ProximityState::occluded);
  EXPECT_FALSE(one.at({0.05, 0.05, 2.5}).camera.has_value());
  EXPECT_EQ(one.at({5, 0, 1}).state, ProximityState::unobserved) << "beside the image";
  EXPECT_EQ(one.at({0, 0, -1}).state, ProximityState::unobserved) << "behind the camera";
  one.fill(0.0F);
  EXPECT_EQ(one.at({0.05, 0.05, 1.0}).state, ProximityState::unmeasured);
  EXPECT_EQ(one.at({0.05, 0.05, 1.0}).unmeasured, Unmeasured::no_reading);
  EXPECT_EQ(one.at({-0.95, 0.05, 1.0}).unmeasured, Unmeasured::no_reading)
      << "at the edge, too, but no reading comes first";
}

TEST(Classification, ANearerSurfaceWithinTheFilterRadiusIsMeasured) {
  OneCamera one;
  one.fill(2.0F);
  one.depth_m.at(11, 10) = 1.5F;
  // Seen through pixel (10, 10), whose own depth is 2 m; the filter takes its free depth from the neighbour.
  EXPECT_EQ(one.at({0.05, 0.05, 1.5}).state, ProximityState::measured);
  EXPECT_EQ(one.at({0.05, 0.05, 1.7}).state, ProximityState::occluded) << "the shadow edge is no surface";
  one.margin.lateral_px = 0;
  EXPECT_EQ(one.at({0.05, 0.05, 1.5}).state, ProximityState::unobserved) << "this pixel alone saw past it";
}

TEST(Classification, BesideTheImagesEdgeNothingIsMeasured) {
  OneCamera one;
  one.fill(2.0F);
  EXPECT_EQ(one.at({-0.95, 0.05, 1.0}).state, ProximityState::unmeasured);
  EXPECT_EQ(one.at({-0.95, 0.05, 1.0}).unmeasured, Unmeasured::image_edge);
  EXPECT_EQ(one.at({0.05, 0.95, 1.0}).state, ProximityState::unmeasured);
  one.margin.lateral_px = 0;
  EXPECT_EQ(one.at({-0.95, 0.05, 1.0}).state, ProximityState::unobserved);
}

TEST(Classification, TheBlindZoneIsUnmeasured) {
  OneCamera one;
  one.fill(2.0F);
  one.view.near_m = 0.5;
  EXPECT_EQ(one.at({0.01, 0.01, 0.4}).state, ProximityState::unmeasured);
  EXPECT_EQ(one.at({0.01, 0.01, 0.4}).unmeasured, Unmeasured::blind_zone);
  EXPECT_EQ(one.at({0.05, 0.05, 2.0}).unmeasured, Unmeasured::not_told);
}

}  // namespace
}  // namespace depthgrid::grid
