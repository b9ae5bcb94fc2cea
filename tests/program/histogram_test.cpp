// Counts that outgrow 32 bits, depths that outgrow integers, and readings that are no surfaces.
#include "program/info/histogram.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "program/info/clamped_readings.hpp"
#include "program/info/depth_noise.hpp"
#include "program/info/info_report.hpp"

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

// A wall with noise before a hall that is too far away: where no surface was seen there is no noise either.
TEST(ClampedReadings, AreNoSurfaces) {
  MeasurementRule rule{0.5, 5.0, true, {}};
  std::vector<float> metres(64 * 48, 7.5F);
  for (std::size_t k = 0; k < metres.size() / 2; ++k) {
    metres[k] = 4.9F + 0.02F * static_cast<float>(k * k % 3);
  }
  metres[10] = 0.2F;
  const auto surveyed = [&](const MeasurementRule& by, std::int64_t& clamped) {
    DepthImage depth(64, 48);
    normalise(depth_view(metres, 64, 48), by, depth);
    clamped = remove_clamped(by, depth);
    return depth;
  };
  std::int64_t clamped = -1;
  const DepthImage depth = surveyed(rule, clamped);
  EXPECT_EQ(clamped, 64 * 24);
  rule.clamp_beyond_far = false;
  std::int64_t none = -1;
  const DepthImage same = surveyed(rule, none);
  EXPECT_EQ(none, 0);
  EXPECT_TRUE(std::equal(depth.data(), depth.data() + metres.size(), same.data()));
  CameraSurvey survey;
  survey.clamped = clamped;
  survey.add(depth);
  EXPECT_EQ(survey.invalid, 64 * 24 + 1);
  EXPECT_LT(survey.farthest_m, 4.95F);
  EXPECT_LT(survey.depths.median_m(), 4.95);
}

}  // namespace
}  // namespace depthgrid::program
