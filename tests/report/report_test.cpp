// Pictures read back pixel by pixel, and everything that must not spoil them.
#include <cairo.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "depthgrid/core/error.hpp"
#include "report/canvas.hpp"
#include "report/depth_picture.hpp"
#include "report/plot.hpp"

namespace depthgrid::report {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class Report : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("depthgrid_report_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// 0xrrggbb of every pixel.
  std::vector<std::uint32_t> saved(const Canvas& canvas) const {
    canvas.save_png(folder_ / "picture.png");
    cairo_surface_t* const image = cairo_image_surface_create_from_png((folder_ / "picture.png").c_str());
    EXPECT_EQ(cairo_surface_status(image), CAIRO_STATUS_SUCCESS);
    EXPECT_EQ(cairo_image_surface_get_width(image), canvas.width_px());
    EXPECT_EQ(cairo_image_surface_get_height(image), canvas.height_px());
    std::vector<std::uint32_t> pixels;
    for (int v = 0; v < canvas.height_px(); ++v) {
      const auto* const row = reinterpret_cast<const std::uint32_t*>(cairo_image_surface_get_data(image) +
                                                                     v * cairo_image_surface_get_stride(image));
      for (int u = 0; u < canvas.width_px(); ++u) {
        pixels.push_back(row[u] & 0xFFFFFFU);
      }
    }
    cairo_surface_destroy(image);
    return pixels;
  }
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder_), std::filesystem::directory_iterator()));
  }

  std::filesystem::path folder_;
};

double lightness(const Colour& c) {
  const auto linear = [](double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); };
  return 0.2126 * linear(c.red) + 0.7152 * linear(c.green) + 0.0722 * linear(c.blue);
}

TEST_F(Report, DepthColoursDarkenStrictlyAndDifferFromNoMeasurement) {
  double before = 2;
  for (int i = 0; i <= 100; ++i) {
    const Colour c = depth_colour(i / 100.0);
    EXPECT_LT(lightness(c), before) << "at share " << i / 100.0;
    before = lightness(c);
    EXPECT_GT(std::hypot(c.red - kNoMeasurement.red, c.green - kNoMeasurement.green, c.blue - kNoMeasurement.blue), 0.4)
        << "at share " << i / 100.0;
  }
  EXPECT_EQ(depth_colour(-3).red, depth_colour(0).red);
  EXPECT_EQ(depth_colour(7).red, depth_colour(1).red);
  EXPECT_EQ(depth_colour(kNaN).red, kNoMeasurement.red);
}

TEST_F(Report, ShapesLandWhereTheyWereDrawn) {
  Canvas canvas(20, 10);
  canvas.fill({2, 3, 4, 5}, {1, 0, 0});
  canvas.line({10, 5.5}, {18, 5.5}, {{0, 0, 1}, 1});
  const auto pixels = saved(canvas);
  EXPECT_EQ(pixels[0], 0xFFFFFFU);
  EXPECT_EQ(pixels[3 * 20 + 2], 0xFF0000U);
  EXPECT_EQ(pixels[7 * 20 + 5], 0xFF0000U);
  EXPECT_EQ(pixels[8 * 20 + 5], 0xFFFFFFU);
  EXPECT_EQ(pixels[5 * 20 + 14], 0x0000FFU);
  EXPECT_EQ(pixels[6 * 20 + 14], 0xFFFFFFU);
  EXPECT_EQ(files(), 1U) << "a temporary file was left behind";
}

TEST_F(Report, ClippedDrawingStaysInside) {
  Canvas canvas(20, 10);
  canvas.clip({0, 0, 10, 10});
  canvas.fill({0, 0, 20, 10}, {1, 0, 0});
  canvas.unclip();
  canvas.fill({19, 0, 1, 1}, {0, 1, 0});
  const auto pixels = saved(canvas);
  EXPECT_EQ(pixels[9], 0xFF0000U);
  EXPECT_EQ(pixels[10], 0xFFFFFFU);
  EXPECT_EQ(pixels[19], 0x00FF00U);
}

TEST_F(Report, BrokenCoordinatesAndTextDoNotSpoilWhatFollows) {
  Canvas canvas(20, 10);
  canvas.line({kNaN, 0}, {5, 5}, {});
  canvas.fill({0, 0, std::numeric_limits<double>::infinity(), 3}, {1, 0, 0});
  canvas.disc({3, 3}, kNaN, {1, 0, 0});
  canvas.text({1, kNaN}, "text", 10);
  canvas.text({30, 30}, "\xff\xfe broken \xe2\x82", 10);
  canvas.text({30, 30}, "\xed\xa0\x80", 10);
  canvas.text({30, 30}, "good \xc2\xb5 \xe2\x89\xa4", 10);
  canvas.polyline({}, {});
  canvas.fill({5, 5, 1, 1}, {0, 1, 0});
  const auto pixels = saved(canvas);
  EXPECT_EQ(pixels[5 * 20 + 5], 0x00FF00U);
  EXPECT_EQ(std::count(pixels.begin(), pixels.end(), 0xFFFFFFU), 199);
}

TEST_F(Report, DepthImagesKeepTheirPixels) {
  DepthImage depth_m(2, 2);
  depth_m.at(0, 0) = 1.0F;
  depth_m.at(1, 0) = 3.0F;
  depth_m.at(0, 1) = 9.0F;
  EXPECT_EQ(depth_range(depth_m).near_m, 1.0);
  EXPECT_EQ(depth_range(depth_m).far_m, 9.0);
  EXPECT_EQ(depth_range(DepthImage(2, 2)).far_m, DepthRange{}.far_m);
  Canvas canvas(20, 20);
  draw_depth(canvas, {0, 0, 20, 20}, depth_m, {1, 3});
  const auto pixels = saved(canvas);
  Raster expected(3, 1);
  expected.set(0, 0, depth_colour(0));
  expected.set(1, 0, depth_colour(1));
  expected.set(2, 0, kNoMeasurement);
  const auto colour = [&expected](std::size_t u) {
    return static_cast<std::uint32_t>((expected.rgb[3 * u] << 16) | (expected.rgb[3 * u + 1] << 8) |
                                      expected.rgb[3 * u + 2]);
  };
  EXPECT_EQ(pixels[9 * 20 + 9], colour(0));  // not blended with its neighbours
  EXPECT_EQ(pixels[9 * 20 + 10], colour(1));
  EXPECT_EQ(pixels[10 * 20 + 9], colour(1));
  EXPECT_EQ(pixels[10 * 20 + 10], colour(2));
}

TEST_F(Report, FilesThatCannotBeWrittenAreNamed) {
  const Canvas canvas(4, 4);
  try {
    canvas.save_png(folder_ / "absent" / "picture.png");
    FAIL() << "written into a folder that does not exist";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("absent/picture.png"));
  }
  EXPECT_THROW(canvas.save_svg(folder_ / "absent" / "picture.svg"), Error);
  EXPECT_THROW(Canvas(0, 4), Error);
  EXPECT_THROW(Canvas(4, 100000), Error);
  EXPECT_THROW(Raster(0, 1), Error);
}

TEST_F(Report, TicksAreRoundAndCoverTheRange) {
  EXPECT_THAT(ticks(0, 1, 5, false), ::testing::ElementsAre(0, 0.2, 0.4, ::testing::DoubleNear(0.6, 1e-12), 0.8, 1));
  EXPECT_THAT(ticks(-3, 7, 4, false), ::testing::ElementsAre(0, 5));
  EXPECT_THAT(ticks(1, 8, 8, false), ::testing::ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
  EXPECT_THAT(ticks(1, 10, 8, true), ::testing::ElementsAre(1, 2, 5, 10));
  EXPECT_THAT(ticks(0.5, 20000, 8, true), ::testing::ElementsAre(1, 10, 100, 1000, 10000));
  EXPECT_TRUE(ticks(1, 1, 5, false).empty());
  EXPECT_TRUE(ticks(0, 10, 5, true).empty());
  EXPECT_TRUE(ticks(kNaN, 10, 5, false).empty());
}

TEST_F(Report, PlotsAreWrittenAsPngAndSvg) {
  Plot plot;
  plot.title = "evaluations a second";
  plot.x_label = "cameras";
  plot.y_label = "rate (1/s)";
  plot.log_y = true;
  plot.series = {{"letter", {1, 2, 4, 8}, {800, 400, 0, 120}}, {"corrected", {1, 2, 4, 8}, {500, kNaN, 150, 80}}};
  Canvas canvas(640, 400);
  draw_plot(canvas, {0, 0, 640, 400}, plot);
  const auto pixels = saved(canvas);
  const Colour wanted = series_colour(0);
  const auto is_wanted = [&wanted](std::uint32_t rgb) {
    return std::abs((rgb >> 16U) - 255 * wanted.red) < 2 && std::abs(((rgb >> 8U) & 0xFFU) - 255 * wanted.green) < 2 &&
           std::abs((rgb & 0xFFU) - 255 * wanted.blue) < 2;
  };
  EXPECT_GT(std::count_if(pixels.begin(), pixels.end(), is_wanted), 200);
  canvas.save_svg(folder_ / "plot.svg");
  std::ifstream file(folder_ / "plot.svg");
  std::ostringstream text;
  text << file.rdbuf();
  EXPECT_THAT(text.str(), ::testing::StartsWith("<?xml"));
  EXPECT_THAT(text.str(), ::testing::HasSubstr("</svg>"));
}

TEST_F(Report, PlotsOfNothingAndOfBrokenSeries) {
  Canvas canvas(320, 200);
  draw_plot(canvas, {0, 0, 320, 200}, {});
  Plot plot;
  plot.log_x = true;
  plot.series = {{"none of it positive", {0, -1}, {1, 2}}, {"one point", {}, {}}};
  draw_plot(canvas, {0, 0, 320, 200}, plot);
  draw_plot(canvas, {0, 0, 10, 10}, plot);
  (void)saved(canvas);
  plot.series = {{"uneven", {1, 2}, {1}}};
  EXPECT_THROW(draw_plot(canvas, {0, 0, 320, 200}, plot), Error);
}

}  // namespace
}  // namespace depthgrid::report
