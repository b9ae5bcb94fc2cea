// Views on the caller's buffers and the decision what is a measurement.
#include "depthgrid/core/depth_image.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "support/random_run.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid {
namespace {

using testing::HasSubstr;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

float decided(const DepthView& view, const MeasurementRule& rule) {
  DepthImage image(view.width_px, view.height_px);
  normalise(view, rule, image);
  EXPECT_EQ(measured_depth_m(view, rule, 0, 0).value_or(0.0F), image.at(0, 0)) << "the two places disagree";
  return image.at(0, 0);
}

float decided(std::uint16_t units, const MeasurementRule& rule = {}, double metres_per_unit = 0.001) {
  const std::vector<std::uint16_t> pixels{units};
  return decided(depth_view(pixels, 1, 1, metres_per_unit), rule);
}

float decided_float(float depth_m, const MeasurementRule& rule = {}) {
  const std::vector<float> pixels{depth_m};
  return decided(depth_view(pixels, 1, 1), rule);
}

TEST(Measurement, OfUnits) {
  EXPECT_FLOAT_EQ(decided(1), 0.001F);
  EXPECT_FLOAT_EQ(decided(1500), 1.5F);
  EXPECT_FLOAT_EQ(decided(65534), 65.534F);
  EXPECT_FLOAT_EQ(decided(5000, {}, 0.0002), 1.0F);
}

TEST(Measurement, NoneOfUnits) {
  EXPECT_EQ(decided(0), 0.0F);
  EXPECT_EQ(decided(65535), 0.0F);
  EXPECT_EQ(decided(65535, {0.0, 10.0, true, {}}), 0.0F) << "saturation is not `beyond far`";
}

TEST(Measurement, ListedUnitsAreNone) {
  MeasurementRule rule;
  rule.invalid_units = {2047, 4000};
  EXPECT_EQ(decided(2047, rule), 0.0F);
  EXPECT_EQ(decided(4000, rule), 0.0F);
  EXPECT_FLOAT_EQ(decided(2046, rule), 2.046F);
  rule.clamp_beyond_far = true;
  rule.far_m = 3.0;
  EXPECT_EQ(decided(4000, rule), 0.0F) << "listed wins over clamped";
}

TEST(Measurement, OfMetres) {
  EXPECT_EQ(decided_float(1.25F), 1.25F);
  EXPECT_EQ(decided_float(1e-3F), 1e-3F);
}

TEST(Measurement, NoneOfMetres) {
  for (const float depth_m : {0.0F, -0.0F, -1.0F, kNaN, -kNaN, kInf, -kInf}) {
    EXPECT_EQ(decided_float(depth_m), 0.0F) << depth_m;
    EXPECT_EQ(decided_float(depth_m, {0.0, 8.0, true, {}}), 0.0F) << depth_m << " with clamp";
    EXPECT_EQ(decided_float(depth_m, {0.5, 8.0, false, {}}), 0.0F) << depth_m << " with limits";
  }
}

TEST(Measurement, LimitsBelongToTheRange) {
  const MeasurementRule rule{0.5, 4.0, false, {}};
  EXPECT_EQ(decided_float(0.5F, rule), 0.5F);
  EXPECT_EQ(decided_float(std::nextafter(0.5F, 0.0F), rule), 0.0F);
  EXPECT_EQ(decided_float(4.0F, rule), 4.0F);
  EXPECT_EQ(decided_float(std::nextafter(4.0F, 5.0F), rule), 0.0F);
}

TEST(Measurement, ALimitInMetresMeetsItsUnit) {
  // 0.3 m is 300 units whatever the rounding: a reading at the limit must not fall on either side by chance.
  for (int units = 1; units < 65535; ++units) {
    const double limit_m = units * 0.001;
    const auto value = static_cast<std::uint16_t>(units);
    ASSERT_GT(decided(value, {0.0, limit_m, false, {}}), 0.0F) << units;
    ASSERT_GT(decided(value, {limit_m, 100.0, false, {}}), 0.0F) << units;
  }
}

TEST(Measurement, ClampsBeyondFarOnlyWhenTold) {
  EXPECT_EQ(decided(5000, {0.5, 4.0, false, {}}), 0.0F);
  EXPECT_EQ(decided(5000, {0.5, 4.0, true, {}}), 4.0F);
  EXPECT_EQ(decided_float(5.0F, {0.5, 4.0, true, {}}), 4.0F);
  EXPECT_EQ(decided_float(0.4F, {0.5, 4.0, true, {}}), 0.0F) << "nothing is clamped up to near";
}

TEST(DepthView, IsNoCopy) {
  std::vector<std::uint16_t> pixels(6, 1000);
  const DepthView view = depth_view(pixels, 3, 2, 0.001);
  EXPECT_EQ(view.data, pixels.data());
  EXPECT_EQ(view.stride_bytes, 6);
  pixels[4] = 2000;
  EXPECT_FLOAT_EQ(measured_depth_m(view, {}, 1, 1).value(), 2.0F);
}

TEST(DepthView, PaddedRows) {
  // 3 x 2 pixels, each row followed by padding that must not be read as depth; the last row needs none.
  const std::vector<std::uint16_t> pixels{1, 2, 3, 9999, 9999, 4, 5, 6};
  const DepthView view = depth_view(pixels, 3, 2, 0.001, 10);
  DepthImage image(3, 2);
  normalise(view, {}, image);
  EXPECT_EQ(std::vector<float>(image.data(), image.data() + 6),
            (std::vector<float>{0.001F, 0.002F, 0.003F, 0.004F, 0.005F, 0.006F}));
}

TEST(DepthView, SubImageOfALargerBuffer) {
  std::vector<float> pixels(8 * 6);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    pixels[i] = 1.0F + static_cast<float>(i);
  }
  // The 3 x 2 pixels from column 4, row 3 on.
  const std::span<const float> window = std::span<const float>(pixels).subspan(3 * 8 + 4);
  const DepthView view = depth_view(window, 3, 2, 8 * sizeof(float));
  DepthImage image(3, 2);
  normalise(view, {}, image);
  EXPECT_EQ(std::vector<float>(image.data(), image.data() + 6), (std::vector<float>{29, 30, 31, 37, 38, 39}));
  EXPECT_EQ(measured_depth_m(view, {}, 2, 1), 39.0F);
}

TEST(DepthView, NormaliseAgreesWithSinglePixels) {
  const test::RandomRun run = test::random_run(200);
  std::mt19937_64 random(run.seed);
  const auto whole = [&random](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  for (std::int64_t n = 0; n < run.count; ++n) {
    const int width_px = whole(1, 40);
    const int height_px = whole(1, 9);
    const int row = width_px + whole(0, 5);
    std::vector<std::uint16_t> units(static_cast<std::size_t>(row * height_px));
    std::vector<float> metres(units.size());
    for (std::size_t i = 0; i < units.size(); ++i) {
      units[i] = static_cast<std::uint16_t>(whole(0, 3) == 0 ? 65535 * whole(0, 1) : whole(0, 65535));
      metres[i] = whole(0, 5) == 0 ? kNaN : whole(0, 5) == 0 ? kInf : static_cast<float>(whole(-1000, 9000)) * 1e-3F;
    }
    MeasurementRule rule{whole(0, 1) * 0.5, whole(0, 1) == 0 ? 4.0 : 100.0, whole(0, 1) == 0, {}};
    if (whole(0, 1) == 0) {
      rule.invalid_units = {units[0], 2047};
    }
    for (const DepthView& view :
         {depth_view(units, width_px, height_px, 0.001, row * 2), depth_view(metres, width_px, height_px, row * 4)}) {
      DepthImage image(width_px, height_px);
      normalise(view, rule, image);
      for (int v = 0; v < height_px; ++v) {
        for (int u = 0; u < width_px; ++u) {
          ASSERT_EQ(image.at(u, v), measured_depth_m(view, rule, u, v).value_or(0.0F))
              << "pixel (" << u << ", " << v << "), image " << n << " of " << run.reproduce();
        }
      }
    }
  }
}

TEST(BrokenDepthView, NamesValueAndRule) {
  const std::vector<std::uint16_t> units(12);
  const std::vector<float> metres(12);
  const auto message = [&units](int width_px, int height_px, double scale, std::ptrdiff_t stride_bytes) {
    return test::thrown_message([&] { (void)depth_view(units, width_px, height_px, scale, stride_bytes); });
  };
  const auto kScaleOf = [](const std::string& value) {
    return "depth image: metres_per_unit is " + value +
           ", must be between 1e-06 and 0.01; did you mean 0.001 (images in millimetres)?";
  };
  EXPECT_EQ(message(4, 3, 0.001, 0), "");
  EXPECT_EQ(message(4, 4, 0.001, 0), "depth image: buffer has 24 bytes, 4 x 4 pixels with a stride of 8 bytes need 32");
  EXPECT_EQ(message(4, 3, 0.001, 10),
            "depth image: buffer has 24 bytes, 4 x 3 pixels with a stride of 10 bytes need 28");
  EXPECT_EQ(message(4, 2, 0.001, 9),
            "depth image: stride is 9 bytes, must be a multiple of 2 and at least 8 for 4 pixels");
  EXPECT_EQ(message(4, 2, 0.001, 6),
            "depth image: stride is 6 bytes, must be a multiple of 2 and at least 8 for 4 pixels");
  EXPECT_EQ(message(4, 2, 0.001, -8),
            "depth image: stride is -8 bytes, must be a multiple of 2 and at least 8 for 4 pixels");
  EXPECT_EQ(message(0, 3, 0.001, 0), "depth image: size is 0 x 3 px, each side must be between 1 and 16384");
  EXPECT_EQ(message(4, -3, 0.001, 0), "depth image: size is 4 x -3 px, each side must be between 1 and 16384");
  EXPECT_EQ(message(1 << 30, 1 << 30, 0.001, 0),
            "depth image: size is 1073741824 x 1073741824 px, each side must be between 1 and 16384");
  EXPECT_EQ(message(4, 3, 0.0, 0), kScaleOf("0"));
  EXPECT_EQ(message(4, 3, -0.001, 0), kScaleOf("-0.001"));
  EXPECT_EQ(message(4, 3, kNaN, 0), kScaleOf("nan"));
  EXPECT_EQ(message(4, 3, 1.0, 0), kScaleOf("1"));
  // What other tools call depth_scale or DepthMapFactor is the inverse.
  EXPECT_EQ(message(4, 3, 5000, 0),
            "depth image: metres_per_unit is 5000, must be between 1e-06 and 0.01; did you mean 0.0002 (metres of one "
            "unit, not units of one metre)?");
  EXPECT_EQ(message(4, 3, 0.01, 0), "");
  EXPECT_EQ(
      message(4, 3, 0.001, std::numeric_limits<std::ptrdiff_t>::max() - 1),
      "depth image: buffer has 24 bytes, 4 x 3 pixels with a stride of 9223372036854775806 bytes need 1.844674407e+19");
  EXPECT_EQ(test::thrown_message([&] { (void)depth_view(metres, 4, 2, 18); }),
            "depth image: stride is 18 bytes, must be a multiple of 4 and at least 16 for 4 pixels");
  EXPECT_EQ(test::thrown_message([&] { (void)depth_view(metres, 5, 3); }),
            "depth image: buffer has 48 bytes, 5 x 3 pixels with a stride of 20 bytes need 60");
  EXPECT_EQ(test::thrown_message([] { DepthImage(640, 0); }),
            "depth image: size is 640 x 0 px, each side must be between 1 and 16384");
}

TEST(BrokenMeasurementRule, NamesValueAndRule) {
  const auto message = [](double near_m, double far_m) {
    return test::thrown_message([&] { validate(MeasurementRule{near_m, far_m, false, {}}, "camera 'left'"); });
  };
  EXPECT_EQ(message(0, kInf), "");
  EXPECT_EQ(message(-0.1, 4), "camera 'left': near is -0.1 m, must be a finite number that is not negative");
  EXPECT_EQ(message(kNaN, 4), "camera 'left': near is nan m, must be a finite number that is not negative");
  EXPECT_EQ(message(4, 4), "camera 'left': far is 4 m, must be greater than near (4 m)");
  EXPECT_EQ(message(0.5, kNaN), "camera 'left': far is nan m, must be greater than near (0.5 m)");
}

}  // namespace
}  // namespace depthgrid
