// The rule for holes against its definition, pixel by pixel, and against worlds of balls that are seen with holes.
#include "depthgrid/views/hole_rule.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>

#include "depthgrid/core/rounding.hpp"
#include "support/allocation_guard.hpp"
#include "support/random_run.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::views {
namespace {

/// A small image with readings, 0 for none.
struct Picture {
  int width_px;
  int height_px;
  std::vector<float> depth_m;

  [[nodiscard]] float at(int u, int v) const { return depth_m[static_cast<std::size_t>(v * width_px + u)]; }
  [[nodiscard]] bool inside(int u, int v) const { return u >= 0 && v >= 0 && u < width_px && v < height_px; }
  [[nodiscard]] bool missing(int u, int v) const { return inside(u, v) && !(at(u, v) > 0); }

  /// A disc around the place (x, y), pixel centres being whole numbers, that shows no reading.
  [[nodiscard]] bool empty_disc(double x, double y, double radius_px) const {
    for (int v = static_cast<int>(std::ceil(y - radius_px)); v <= y + radius_px; ++v) {
      for (int u = static_cast<int>(std::ceil(x - radius_px)); u <= x + radius_px; ++u) {
        if (std::hypot(u - x, v - y) <= radius_px && !missing(u, v)) {
          return false;
        }
      }
    }
    return true;
  }

  /// Whether some empty disc of this radius, its centre a multiple of 1/4 px, touches pixel (u, v) or comes as near as
  /// `gap_px` to touching it.
  [[nodiscard]] bool touched(int u, int v, double radius_px, double gap_px = 0) const {
    const double reach = radius_px + std::sqrt(0.5) + gap_px;
    const int steps = static_cast<int>(std::ceil(reach * 4));
    for (int b = -steps; b <= steps; ++b) {
      for (int a = -steps; a <= steps; ++a) {
        if (std::hypot(a, b) <= 4 * reach && empty_disc(u + a / 4.0, v + b / 4.0, radius_px)) {
          return true;
        }
      }
    }
    return false;
  }
};

PinholeCamera small_camera(int width_px, int height_px, double focal_px) {
  return {width_px, height_px, focal_px, focal_px * 1.05, width_px / 2.0, height_px / 2.0};
}

double uniform(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// Blobs, lines and single pixels without reading.
void make_holes(Picture& picture, std::mt19937_64& random) {
  const double lone = std::pow(uniform(random, 0, 0.8), 2);
  for (float& depth : picture.depth_m) {
    depth = uniform(random, 0, 1) < lone ? 0.0F : depth;
  }
  const int blobs = static_cast<int>(uniform(random, 0, 5));
  for (int n = 0; n < blobs; ++n) {
    const double x = uniform(random, 0, picture.width_px);
    const double y = uniform(random, 0, picture.height_px);
    const double a = uniform(random, 0.5, 9);
    const double b = uniform(random, 0.5, 9);
    for (int v = 0; v < picture.height_px; ++v) {
      for (int u = 0; u < picture.width_px; ++u) {
        if (std::hypot((u - x) / a, (v - y) / b) <= 1) {
          picture.depth_m[static_cast<std::size_t>(v * picture.width_px + u)] = 0.0F;
        }
      }
    }
  }
}

Picture random_picture(int width_px, int height_px, std::mt19937_64& random) {
  Picture picture{width_px, height_px, {}};
  for (int i = 0; i < width_px * height_px; ++i) {
    picture.depth_m.push_back(static_cast<float>(uniform(random, 0.4, 4)));
  }
  make_holes(picture, random);
  return picture;
}

std::string description(const Picture& picture) {
  std::ostringstream text;
  for (int v = 0; v < picture.height_px; ++v) {
    for (int u = 0; u < picture.width_px; ++u) {
      text << (picture.missing(u, v) ? '.' : '#');
    }
    text << '\n';
  }
  return text.str();
}

TEST(HoleRule, NoEmptyDiscOfItsWidthTouchesThePixel) {
  const test::RandomRun run = test::random_run(40);
  std::mt19937_64 random(run.seed);
  std::int64_t asked = 0;
  std::int64_t too_wide = 0;
  double most = 0;
  for (std::int64_t n = 0; n < run.count && !HasFailure(); ++n) {
    const Picture picture = random_picture(30 + static_cast<int>(n % 40), 24, random);
    HoleRule rule(small_camera(picture.width_px, 24, 300), 0.001, {}, {}, 0.02);
    (void)rule.fill(depth_view(picture.depth_m, picture.width_px, 24));
    for (int v = 0; v < 24 && !HasFailure(); ++v) {
      for (int u = 0; u < picture.width_px && !HasFailure(); ++u) {
        const double width_px = rule.width_px(u, v);
        ASSERT_EQ(width_px > 0, picture.missing(u, v));
        if (width_px == 0) {
          continue;
        }
        ++asked;
        if (std::isfinite(width_px)) {
          EXPECT_FALSE(picture.touched(u, v, width_px / 2 + 1e-9))
              << "pixel " << u << ", " << v << " W " << width_px << '\n'
              << description(picture) << run.reproduce();
        } else {
          ++too_wide;
        }
        // Not much wider than need be: near by, a disc a step of the grid and a level smaller is empty.
        const double level = width_px > 9.5 ? 1.15 : std::sqrt(2.0);
        const double least = std::isfinite(width_px) ? (width_px / 2 - 0.7072) / level - 0.01 : 0.0;
        if (least > 0.6) {
          EXPECT_TRUE(picture.touched(u, v, least, 1.4143)) << "pixel " << u << ", " << v << " W " << width_px << '\n'
                                                            << description(picture) << run.reproduce();
        }
        most = std::max(most, std::isfinite(width_px) ? width_px : 0.0);
      }
    }
  }
  EXPECT_GT(asked, 100 * run.count);
  EXPECT_GT(too_wide + 1, 0);
  EXPECT_GT(most, 8);
}

/// Balls before a wall, seen through the centres of pixels.
struct World {
  struct Ball {
    double x, y, z, radius_m;
  };
  std::vector<Ball> balls;
  double wall_m;

  /// Depth of the first surface along the ray (x, y, 1).
  [[nodiscard]] double depth_m(double x, double y) const {
    double nearest = wall_m;
    for (const Ball& ball : balls) {
      const double a = x * x + y * y + 1;
      const double b = x * ball.x + y * ball.y + ball.z;
      const double c = ball.x * ball.x + ball.y * ball.y + ball.z * ball.z - ball.radius_m * ball.radius_m;
      const double root = b * b - a * c;
      nearest = root >= 0 ? std::min(nearest, (b - std::sqrt(root)) / a) : nearest;
    }
    return nearest;
  }
};

/// Readings beside their place, at the worst: every pixel reads the farthest that stands so near. The filter of w
/// pixels covers half a pixel's diagonal less: what only touches a pixel is read at a centre farther on.
void stand_beside(Picture& picture, int w) {
  const Picture before = picture;
  for (int v = 0; v < picture.height_px; ++v) {
    for (int u = 0; u < picture.width_px; ++u) {
      float& value = picture.depth_m[static_cast<std::size_t>(v * picture.width_px + u)];
      for (int dv = -w; dv <= w; ++dv) {
        for (int du = -w; du <= w; ++du) {
          const bool near = std::hypot(du, dv) <= std::max(0.0, w - 0.7071) && before.inside(u + du, v + dv);
          value = near ? std::max(value, before.at(u + du, v + dv)) : value;
        }
      }
    }
  }
}

TEST(HoleRule, NothingIsNearerThanAHoleSays) {
  const test::RandomRun run = test::random_run(400);
  std::mt19937_64 random(run.seed);
  std::int64_t filled_pixels = 0;
  std::int64_t holes = 0;
  double closest_m = 1;
  for (std::int64_t n = 0; n < run.count && !HasFailure(); ++n) {
    const double size_m = uniform(random, 0.01, 0.08);
    // Wide cameras, too: away from the axis a ball's image is an ellipse with narrow tips.
    const PinholeCamera camera =
        small_camera(56, 40, uniform(random, 0, 1) < 0.5 ? uniform(random, 15, 60) : uniform(random, 60, 400));
    const SensorMargin margin{0, 0, 0, static_cast<int>(uniform(random, 0, 3))};
    const int w = margin.lateral_px;
    World world{{}, uniform(random, 0.6, 5)};
    const int balls = static_cast<int>(uniform(random, 1, 8));
    for (int i = 0; i < balls; ++i) {
      const double radius_m = size_m / 2 * uniform(random, 1, 2) * (uniform(random, 0, 1) < 0.3 ? 4 : 1);
      const double z = uniform(random, 0.3 + radius_m, world.wall_m);
      world.balls.push_back({uniform(random, -0.5, 0.5) * 56 / camera.fx_px * z,
                             uniform(random, -0.5, 0.5) * 40 / camera.fy_px * z, z, radius_m});
    }
    Picture picture{56, 40, {}};
    const bool units = n % 2 == 0;
    const double step_m = 0.00025;
    const auto ray = [&](double u, double v) {
      return std::pair((u - camera.cx_px) / camera.fx_px, (v - camera.cy_px) / camera.fy_px);
    };
    // Some balls give no reading at all, whatever stands behind them.
    const std::size_t black = static_cast<std::size_t>(uniform(random, 0, balls + 1));
    for (int v = 0; v < 40; ++v) {
      for (int u = 0; u < 56; ++u) {
        const auto [x, y] = ray(u + 0.5, v + 0.5);
        const double depth = world.depth_m(x, y);
        const World dark{{world.balls.begin(), world.balls.begin() + static_cast<std::ptrdiff_t>(black)}, 100};
        picture.depth_m.push_back(dark.depth_m(x, y) <= depth ? 0.0F
                                  : units                     ? static_cast<float>(std::floor(depth / step_m))
                                                              : rounded_down(depth));
      }
    }
    stand_beside(picture, w);
    make_holes(picture, random);
    HoleRule rule(camera, step_m, {}, margin, size_m);
    const std::vector<std::uint16_t> codes(picture.depth_m.begin(), picture.depth_m.end());
    const DepthView filled = rule.fill(units ? depth_view(codes, 56, 40, step_m) : depth_view(picture.depth_m, 56, 40));
    for (int v = 0; v < 40; ++v) {
      for (int u = 0; u < 56; ++u) {
        const double says_m = static_cast<double>(measured_depth_m(filled, {}, u, v).value_or(0.0F));
        if (!picture.missing(u, v)) {
          const double reading_m = static_cast<double>(picture.at(u, v)) * (units ? step_m : 1);
          EXPECT_NEAR(says_m, reading_m, 1e-6);
          continue;
        }
        ++holes;
        filled_pixels += says_m > 0 ? 1 : 0;
        // As the minimum filter has it; beside the image there is nothing free.
        double least_m = says_m;
        for (int dv = -w; dv <= w; ++dv) {
          for (int du = -w; du <= w; ++du) {
            least_m =
                std::min(least_m, picture.inside(u + du, v + dv)
                                      ? static_cast<double>(measured_depth_m(filled, {}, u + du, v + dv).value_or(0.0F))
                                      : 0.0);
          }
        }
        for (int sample = 0; sample < 9; ++sample) {
          const auto [x, y] = ray(u + 0.01 + 0.49 * (sample % 3), v + 0.01 + 0.49 * (sample / 3));
          const double truth_m = world.depth_m(x, y);
          EXPECT_LE(least_m, truth_m + 1e-6)
              << "pixel " << u << ", " << v << " of world " << n << ", W " << rule.width_px(u, v) << ", w " << w
              << ", s " << size_m << ", f " << camera.fx_px << '\n'
              << description(picture) << run.reproduce();
          closest_m = least_m > 0 ? std::min(closest_m, truth_m - least_m) : closest_m;
        }
      }
    }
  }
  EXPECT_GT(filled_pixels, holes / 10) << holes;
  EXPECT_LT(closest_m, 0.01) << "the rule could say more";
}

/// One black ball of the declared size before a far wall: how far beyond its front a filtered pixel of its image says
/// that nothing is, at most.
double too_far_m(const PinholeCamera& camera, const World& world, double size_m, int w) {
  Picture picture{camera.width_px, camera.height_px, {}};
  const auto ray = [&](double u, double v) {
    return std::pair((u - camera.cx_px) / camera.fx_px, (v - camera.cy_px) / camera.fy_px);
  };
  for (int v = 0; v < picture.height_px; ++v) {
    for (int u = 0; u < picture.width_px; ++u) {
      const auto [x, y] = ray(u + 0.5, v + 0.5);
      const double depth = world.depth_m(x, y);
      picture.depth_m.push_back(depth < world.wall_m ? 0.0F : rounded_down(depth));
    }
  }
  stand_beside(picture, w);
  HoleRule rule(camera, 0.001, {}, SensorMargin{0, 0, 0, w}, size_m);
  const DepthView filled = rule.fill(depth_view(picture.depth_m, picture.width_px, picture.height_px));
  double worst_m = -1;
  for (int v = w; v + w < picture.height_px; ++v) {
    for (int u = w; u + w < picture.width_px; ++u) {
      const auto [x, y] = ray(u + 0.5, v + 0.5);
      const double truth_m = world.depth_m(x, y);
      if (truth_m == world.wall_m) {
        continue;
      }
      double least_m = truth_m + 100;
      for (int dv = -w; dv <= w; ++dv) {
        for (int du = -w; du <= w; ++du) {
          least_m = std::min(least_m, static_cast<double>(measured_depth_m(filled, {}, u + du, v + dv).value_or(0.0F)));
        }
      }
      worst_m = std::max(worst_m, least_m - truth_m);
    }
  }
  return worst_m;
}

TEST(HoleRule, ReadingsBesideABlackBallDoNotMakeItFar) {
  for (int w = 1; w <= 3; ++w) {
    for (double z = 0.6; z < 3.2; z += 0.013) {
      const PinholeCamera camera{64, 64, 525, 525, 32, 32};
      EXPECT_LE(too_far_m(camera, {{{0, 0, z, 0.025}}, 4}, 0.05, w), 1e-6) << "w " << w << ", z " << z;
    }
  }
}

TEST(HoleRule, ABlackBallInTheCornerOfAWideImageIsNotFar) {
  const PinholeCamera camera{1024, 1024, 500, 500, 512, 512};
  for (double size = 0.96; size < 1.05; size += 0.02) {
    EXPECT_LE(too_far_m(camera, {{{0.44 * size, 0.44 * size, 0.524 * size, 0.025}}, 8}, 0.05, 0), 1e-6) << size;
    EXPECT_LE(too_far_m(camera, {{{0.49 * size, 0.49 * size, 0.584 * size, 0.025}}, 8}, 0.05, 1), 1e-6) << size;
  }
}

TEST(HoleRule, WhatItSubtractsIsEnoughForTheMargin) {
  const SensorMargin margin{0.001, 0.02, 0.05, 1};
  const PinholeCamera camera = small_camera(20, 20, 400);
  HoleRule rule(camera, 0.001, {}, margin, 0.02);
  std::vector<float> depth_m(400, 1.5F);
  depth_m[10 * 20 + 10] = 0;
  const DepthView filled = rule.fill(depth_view(depth_m, 20, 20));
  const double says_m = static_cast<double>(measured_depth_m(filled, {}, 10, 10).value_or(0.0F));
  const double promised_m = 1.5 - depth_margin_m(margin, 1.5) - 0.01;
  EXPECT_LE(says_m - depth_margin_m(margin, says_m), promised_m);
  EXPECT_GT(says_m - depth_margin_m(margin, says_m), promised_m - 0.002);
}

TEST(HoleRule, LargeHolesAndTheBorderSayNothing) {
  HoleRule rule(small_camera(64, 48, 240), 0.001, {}, SensorMargin{0, 0, 0, 0}, 0.02);
  std::vector<std::uint16_t> units(64 * 48, 2000);
  units[0] = 0;
  units[24 * 64 + 32] = 0;
  for (int v = 5; v < 20; ++v) {
    std::fill_n(units.begin() + v * 64 + 5, 15, std::uint16_t{0});
  }
  const DepthView filled = rule.fill(depth_view(units, 64, 48, 0.001));
  const auto says = [&](int u, int v) { return measured_depth_m(filled, {}, u, v).value_or(0.0F); };
  EXPECT_EQ(says(0, 0), 0.0F);
  EXPECT_NEAR(static_cast<double>(says(32, 24)), 1.99, 1.1e-3);  // a unit
  EXPECT_EQ(rule.width_px(32, 24), 2.0);
  EXPECT_LT(says(12, 12), 0.28F);
  EXPECT_EQ(says(40, 40), 2.0F);
}

TEST(HoleRule, ReadsAndWritesByTheMeasurementRule) {
  MeasurementRule rule{.near_m = 0.5, .far_m = 3.0, .clamp_beyond_far = true, .invalid_units = {}};
  rule.invalid_units = {1989, 1988};
  HoleRule holes(small_camera(64, 48, 400), 0.001, rule, SensorMargin{0, 0, 0, 0}, 0.02);
  const auto lone_hole = [&](std::uint16_t around) {
    std::vector<std::uint16_t> units(64 * 48, around);
    units[24 * 64 + 32] = 0;
    const DepthView filled = holes.fill(depth_view(units, 64, 48, 0.001));
    return static_cast<double>(measured_depth_m(filled, rule, 32, 24).value_or(0.0F));
  };
  EXPECT_NEAR(lone_hole(2000), 1.987, 1e-6) << "1.99 less a unit, and the values below it stand for no reading";
  EXPECT_NEAR(lone_hole(5000), 2.99, 1.1e-3) << "beyond the far limit counts as the limit";
  EXPECT_EQ(lone_hole(505), 0.0) << "nearer than the near limit there is no reading";
  EXPECT_GT(lone_hole(515), 0.5);

  HoleRule metres(small_camera(64, 48, 400), 0.001, rule, SensorMargin{0, 0, 0, 0}, 0.02);
  const auto lone_hole_m = [&](float around_m) {
    std::vector<float> depth_m(64 * 48, around_m);
    depth_m[24 * 64 + 32] = 0.0F;
    const DepthView filled = metres.fill(depth_view(depth_m, 64, 48));
    return static_cast<double>(measured_depth_m(filled, rule, 32, 24).value_or(0.0F));
  };
  EXPECT_NEAR(lone_hole_m(2.0F), 1.99, 1e-3);
  EXPECT_NEAR(lone_hole_m(5.0F), 2.99, 1e-3);
  EXPECT_EQ(lone_hole_m(0.505F), 0.0);
}

// Whatever the hole says; with least above most, which nobody states, it would be least.
TEST(HoleRule, APixelsBoundsHold) {
  HoleRule rule(small_camera(64, 48, 400), 0.001, {}, SensorMargin{0, 0, 0, 0}, 0.02);
  constexpr std::size_t kPixel = 24 * 64 + 32;
  std::vector<float> depth_m(64 * 48, 2.0F);
  depth_m[kPixel] = 0.0F;
  const auto says_m = [&](const HoleBounds& bounds) {
    return *measured_depth_m(rule.fill(depth_view(depth_m, 64, 48), {&bounds, 1}), {}, 32, 24);
  };
  EXPECT_NEAR(says_m({kPixel, 0.5F, 4.0F}), 1.99, 1e-3) << "what the hole says";
  EXPECT_EQ(says_m({kPixel, 0.5F, 1.25F}), 1.25F);
  EXPECT_EQ(says_m({kPixel, 3.0F, 4.0F}), 3.0F);
  std::vector<std::uint16_t> units(64 * 48, 2000);
  units[kPixel] = 0;
  const auto says_units = [&](const HoleBounds& bounds) {
    return static_cast<const std::uint16_t*>(rule.fill(depth_view(units, 64, 48, 0.001), {&bounds, 1}).data)[kPixel];
  };
  EXPECT_NEAR(says_units({kPixel, 500, 65535}), 1990, 1) << "what the hole says";
  EXPECT_EQ(says_units({kPixel, 500, 1250}), 1250);
  EXPECT_EQ(says_units({kPixel, 3000, 65535}), 3000);
}

TEST(HoleRule, AnImageTakesNoMemory) {
  DEPTHGRID_REQUIRE_ALLOCATION_COUNT();
  HoleRule rule(small_camera(64, 48, 200), 0.001, {}, {}, 0.02);
  const std::vector<std::uint16_t> units(64 * 48, 0);
  const test::AllocationGuard guard;
  (void)rule.fill({units.data(), DepthFormat::uint16_units, 64, 48, 128, 0.001});
  EXPECT_EQ(guard.allocations(), 0);
}

TEST(HoleRule, TheSizeIsPositive) {
  EXPECT_NE(
      test::thrown_message([] { HoleRule(small_camera(8, 8, 8), 0.001, {}, {}, 0.0); }).find("smallest obstacle is 0"),
      std::string::npos);
}

}  // namespace
}  // namespace depthgrid::views
