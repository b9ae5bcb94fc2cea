// Short versions of blind-layer and self-filter: what the pages say of a hand near a link.
#include "lab/experiments/blind_layer/blind_layer.hpp"

#include <gtest/gtest.h>

#include "depthgrid/simulation/arrangement.hpp"
#include "lab/experiments/blind_layer/layer_picture.hpp"
#include "lab/experiments/blind_layer/self_filter.hpp"
#include "lab/experiments/stage/rig_width.hpp"

namespace depthgrid::experiments {
namespace {

Options small() {
  Options options;
  options.quick = true;
  options.width_px = 160;
  options.frames = 3;
  return options;
}

TEST(BlindLayer, HidesAHandTheMoreTheThickerThePaddingAndSaysSo) {
  const std::vector<LayerReading> readings = measure_blind_layer(small(), nullptr);
  int hidden = 0;
  int outside = 0;
  double before_m = -1;
  for (const LayerReading& r : readings) {
    EXPECT_GE(r.blind_m, r.padding_m);
    EXPECT_LE(r.blind_m, r.padding_m + 0.12) << "pixels of 160 columns and the Kinect's filter radius";
    if (!r.gap_m) {
      continue;
    }
    // What is acted upon is never more than the hand leaves, whatever the padding.
    if (*r.gap_m > r.blind_m) {
      ++outside;
      EXPECT_LE(r.distance_m, *r.gap_m + 0.005) << r.sensor << ", padding " << r.padding_m;
    }
    hidden += r.distance_m > *r.gap_m + 0.02 ? 1 : 0;
    EXPECT_TRUE(r.distance_m <= *r.gap_m + 0.005 || *r.gap_m <= r.blind_m) << r.sensor << ", padding " << r.padding_m;
    if (r.sensor == "ideal" && *r.gap_m == 0.02) {
      EXPECT_GT(r.distance_m, before_m) << "grows with the padding";
      before_m = r.distance_m;
    }
  }
  EXPECT_GT(hidden, 5);
  EXPECT_GT(outside, 5);
}

TEST(SelfFilter, DeletesAHandWithoutSayingSo) {
  Options options = small();
  options.frames = 20;  // 2 cm apart
  const std::vector<FilterSweep> sweeps = measure_self_filter(options, nullptr);
  for (const FilterSweep& sweep : sweeps) {
    const FilterRule& rule = filter_rules()[sweep.rule];
    if (rule.filter == SelfFilter::removed) {
      EXPECT_FALSE(sweep.unsaid_to_m().has_value()) << rule.label;
    } else if (rule.filter == SelfFilter::deleted) {
      EXPECT_GE(sweep.unsaid_to_m().value_or(0), rule.distance_m - 0.04) << rule.label;
      // At contact all of the ball, 10 cm thick, is within the distance.
      EXPECT_EQ(sweep.gone_to_m().has_value(), rule.distance_m > 0.09) << rule.label;
    }
  }
  // A mask takes what stands before the robot, however far.
  const auto masked_before = std::find_if(sweeps.begin(), sweeps.end(), [](const FilterSweep& sweep) {
    const FilterRule& rule = filter_rules()[sweep.rule];
    return rule.filter == SelfFilter::masked && rule.distance_m == 0.10 && sweep.place == HandPlace::before;
  });
  ASSERT_NE(masked_before, sweeps.end());
  EXPECT_GT(masked_before->unsaid_to_m().value_or(0), 0.3);
}

TEST(BlindLayer, IsDrawn) {
  HandBeside scene(with_width(simulation::letter_arrangement("ideal").rig, 160), 1);
  EXPECT_GT(draw_blind_layer(scene, 12).width_px(), 800);
}

}  // namespace
}  // namespace depthgrid::experiments
