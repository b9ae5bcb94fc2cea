// Counts that outgrow 32 bits and depths that outgrow integers.
#include "program/info/histogram.hpp"

#include <gtest/gtest.h>

#include "program/info/depth_noise.hpp"

namespace depthgrid::program {
namespace {

TEST(Histogram, CountsMoreThan32Bits) {
  constexpr std::int64_t kMany = std::int64_t{3} << 30;  // more than a signed 32-bit number holds
  Histogram histogram;
  histogram.add(0.1, kMany);
  histogram.add(0.3, kMany / 2);
  EXPECT_EQ(histogram.count(), kMany + kMany / 2);
  EXPECT_NEAR(histogram.quantile_m(0.5), 0.1, 0.0005);
  EXPECT_NEAR(histogram.quantile_m(0.9), 0.3, 0.0005);
}

/// Noise of one percent, alternating in steps of the neighbours' distance, at `depth_m`.
SensorMargin margin_at(float depth_m) {
  DepthImage image(64, 48);
  for (int v = 0; v < image.height_px(); ++v) {
    for (int u = 0; u < image.width_px(); ++u) {
      image.at(u, v) = depth_m * ((u / 4 + v / 4) % 2 == 0 ? 1.0F : 1.01F);
    }
  }
  DepthNoise noise;
  noise.add(image);
  return noise.suggested_margin();
}

TEST(DepthNoise, LeavesOutDepthsBeyondItsSlices) {
  EXPECT_GT(depth_margin_m(margin_at(2.0F), 2.0), 0.015);
  for (const float depth_m : {20.0F, 1e10F, 1e20F, 1e30F}) {
    EXPECT_EQ(depth_margin_m(margin_at(depth_m), 2.0), 0.0) << depth_m;
  }
}

}  // namespace
}  // namespace depthgrid::program
