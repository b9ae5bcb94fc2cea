// The Kinect's preset against the noise model that it stands for.
#include "depthgrid/app/sensor_preset.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "depthgrid/app/usage_error.hpp"

namespace depthgrid::app {
namespace {

TEST(SensorPreset, KinectIsNeverBelowItsModelAndAtMost4Point3MillimetresAbove) {
  const SensorPreset& kinect = sensor_preset("kinect-v1");
  double largest_excess_m = 0;
  for (double z = 0.5; z <= 5.0; z += 0.001) {
    const double sigma_m = 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4);
    const double model_m = 3 * sigma_m + 0.5 * 2.9e-3 * z * z;
    const double margin_m = depth_margin_m(kinect.margin, z);
    ASSERT_GE(margin_m, model_m) << "z = " << z;
    largest_excess_m = std::max(largest_excess_m, margin_m - model_m);
  }
  EXPECT_LE(largest_excess_m, 0.0043);
  EXPECT_GE(largest_excess_m, 0.0040);
  EXPECT_EQ(kinect.near_m, 0.5);
  EXPECT_EQ(kinect.far_m, 5.0);
}

TEST(SensorPreset, UnknownNamesAreRefused) { EXPECT_THROW((void)sensor_preset("kinect"), UsageError); }

}  // namespace
}  // namespace depthgrid::app
