// The rule for shadow bands against its definition, pixel by pixel, and against worlds of balls that a projector
// lights.
#include "depthgrid/views/shadow_rule.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <random>
#include <vector>

#include "depthgrid/core/rounding.hpp"
#include "depthgrid/views/view.hpp"
#include "support/allocation_guard.hpp"
#include "support/random_run.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid::views {
namespace {

constexpr int kWidth = 72;
constexpr int kHeight = 40;

std::size_t pixel(int u, int v) { return static_cast<std::size_t>(v) * kWidth + static_cast<std::size_t>(u); }

double uniform(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// A camera, its rule and margins, and where its second view stands.
struct Sensor {
  PinholeCamera camera{kWidth, kHeight, 120, 120, kWidth / 2.0, kHeight / 2.0};
  MeasurementRule rule{.near_m = 0.5, .far_m = 6, .clamp_beyond_far = false, .invalid_units = {}};
  SensorMargin margin;
  double second_view_x_m = 0.075;
};

Sensor random_sensor(std::mt19937_64& random) {
  Sensor sensor;
  sensor.camera.fx_px = sensor.camera.fy_px = uniform(random, 80, 250);
  sensor.rule.near_m = uniform(random, 0.3, 0.8);
  sensor.margin = {uniform(random, 0, 0.004), uniform(random, 0, 0.01), uniform(random, 0, 0.006),
                   static_cast<int>(uniform(random, 0, 4))};
  // Never so far that the shadows of near things are wider than half of the image.
  sensor.second_view_x_m = uniform(random, 0.03, 0.5 * kWidth * sensor.rule.near_m / sensor.camera.fx_px);
  return sensor;
}

/// What a reading's place moves by at most.
float delta(const Sensor& s, float depth_m) {
  const auto z = static_cast<double>(depth_m);
  return rounded_up(s.camera.fx_px * std::abs(s.second_view_x_m) / (z - depth_margin_m(s.margin, z)));
}

/// The definition, for a second view on the right. 0: the hole says nothing.
double definition_m(const Sensor& s, const std::vector<float>& depth_m, int u, int v) {
  const auto at = [&](int column, int row) { return depth_m[pixel(column, row)]; };
  const auto hidden = [&](int column) {
    double most = -1e9;
    for (int row = std::max(0, v - s.margin.lateral_px); row <= std::min(kHeight - 1, v + s.margin.lateral_px); ++row) {
      for (int other = column + 1; other < kWidth; ++other) {
        if (at(other, row) > 0) {
          most = std::max(most, static_cast<double>(delta(s, at(other, row))) - (other - column));
        }
      }
    }
    return most;
  };
  const double most_px = s.camera.fx_px * std::abs(s.second_view_x_m) / s.rule.near_m;
  const auto is_band = [&](int column) {
    if (column >= kWidth || at(column, v) > 0 || column < most_px || hidden(column) <= 0) {
      return false;
    }
    double behind = 1e6;
    int readings = 0;
    for (int other = column - 1; other >= 0 && readings < 3; --other) {
      if (at(other, v) > 0) {
        ++readings;
        behind = std::min(behind, static_cast<double>(delta(s, at(other, v))));
      }
    }
    return behind <= hidden(column) + 1.5;
  };
  if (!is_band(u)) {
    return 0;
  }
  int further = 0;
  while (further < s.margin.lateral_px && is_band(u + further + 1)) {
    ++further;
  }
  const int edge_px = further == s.margin.lateral_px ? 1 : 1 + s.margin.lateral_px;
  const double disparity_px = std::max(hidden(u), most_px - (kWidth - u)) + edge_px;
  const double nearest_m = s.camera.fx_px * std::abs(s.second_view_x_m) / disparity_px;
  return nearest_m + depth_margin_m(s.margin, nearest_m);
}

/// Walls of several depths side by side, with holes between them.
std::vector<float> random_strips(std::mt19937_64& random) {
  std::vector<float> depth_m(std::size_t{kWidth} * kHeight);
  for (int v = 0; v < kHeight; ++v) {
    float wall_m = 0;
    int left = 0;
    bool hole = false;
    for (int u = 0; u < kWidth; ++u) {
      if (left-- == 0) {
        hole = !hole && uniform(random, 0, 1) < 0.6;
        wall_m = static_cast<float>(uniform(random, 0.8, 4));
        left = static_cast<int>(uniform(random, 0, hole ? 9 : 14));
      }
      const bool lone = uniform(random, 0, 1) < 0.05;
      depth_m[pixel(u, v)] = hole || lone ? 0.0F : wall_m;
    }
  }
  return depth_m;
}

std::vector<float> mirrored(const std::vector<float>& image) {
  std::vector<float> result(image.size());
  for (std::size_t i = 0; i < image.size(); ++i) {
    result[i / kWidth * kWidth + (kWidth - 1 - i % kWidth)] = image[i];
  }
  return result;
}

TEST(ShadowRule, IsItsDefinitionOnBothSides) {
  const test::RandomRun run = test::random_run(20);
  std::mt19937_64 random(run.seed);
  std::int64_t bands = 0;
  std::int64_t silent = 0;
  for (std::int64_t n = 0; n < run.count && !HasFailure(); ++n) {
    Sensor s = random_sensor(random);
    const std::vector<float> depth_m = random_strips(random);
    const std::vector<float> turned_m = mirrored(depth_m);
    ShadowRule right(s.camera, 0.001, s.rule, s.margin, s.second_view_x_m);
    ShadowRule left(s.camera, 0.001, s.rule, s.margin, -s.second_view_x_m);
    const DepthView by_right = right.fill(depth_view(depth_m, kWidth, kHeight));
    const DepthView by_left = left.fill(depth_view(turned_m, kWidth, kHeight));
    for (int v = 0; v < kHeight; ++v) {
      for (int u = 0; u < kWidth; ++u) {
        const float reading_m = depth_m[pixel(u, v)];
        const float says_m = measured_depth_m(by_right, s.rule, u, v).value_or(0.0F);
        ASSERT_EQ(measured_depth_m(by_left, s.rule, kWidth - 1 - u, v).value_or(0.0F), says_m) << run.reproduce();
        if (reading_m > 0) {
          ASSERT_EQ(says_m, reading_m) << run.reproduce();
          continue;
        }
        const double expected_m = definition_m(s, depth_m, u, v);
        const double written_m = expected_m < s.rule.near_m ? 0.0 : std::min(expected_m, s.rule.far_m);
        ASSERT_NEAR(static_cast<double>(says_m), written_m, 1e-6) << u << ", " << v << ' ' << run.reproduce();
        bands += says_m > 0 ? 1 : 0;
        silent += says_m > 0 ? 0 : 1;
      }
    }
  }
  EXPECT_GT(bands, 50 * run.count);
  EXPECT_GT(silent, 50 * run.count);
}

/// Balls before a wall, seen by the camera at the origin and lit from a point beside it.
struct World {
  struct Ball {
    Eigen::Vector3d centre;
    double radius_m;
  };
  std::vector<Ball> balls;
  double wall_m = 3;

  /// How far along from + t along the first ball is, infinite for none.
  [[nodiscard]] double first_ball(const Eigen::Vector3d& from, const Eigen::Vector3d& along) const {
    double first = std::numeric_limits<double>::infinity();
    for (const Ball& ball : balls) {
      const Eigen::Vector3d c = ball.centre - from;
      const double a = along.squaredNorm();
      const double b = along.dot(c);
      const double root = b * b - a * (c.squaredNorm() - ball.radius_m * ball.radius_m);
      first = root >= 0 && b > std::sqrt(root) ? std::min(first, (b - std::sqrt(root)) / a) : first;
    }
    return first;
  }
  [[nodiscard]] double depth_m(double x, double y) const {
    return std::min(wall_m, first_ball(Eigen::Vector3d::Zero(), {x, y, 1}));
  }
  [[nodiscard]] bool lit(const Eigen::Vector3d& place, const Eigen::Vector3d& light) const {
    return first_ball(light, place - light) > 1 - 1e-9;
  }
};

/// No ball is less than `least_radius_m`.
World random_world(const Sensor& s, std::mt19937_64& random, double least_radius_m = 0.02) {
  World world;
  world.wall_m = uniform(random, 1.2, 5);
  const int count = static_cast<int>(uniform(random, 1, 7));
  for (int i = 0; i < count; ++i) {
    const double radius_m = uniform(random, least_radius_m, 0.25);
    const double z = uniform(random, s.rule.near_m + radius_m, world.wall_m);
    // Some stand beside the image.
    world.balls.push_back({{uniform(random, -0.65, 0.65) * kWidth / s.camera.fx_px * z,
                            uniform(random, -0.5, 0.5) * kHeight / s.camera.fy_px * z, z},
                           radius_m});
  }
  return world;
}

struct Tally {
  std::int64_t dark = 0;
  std::int64_t says_something = 0;
  std::int64_t too_far = 0;
  double worst_m = 0;
};

/// The world as the sensor sees it, and what the view frees of it where `stated_x_m` is said of the second view. With a
/// smallest obstacle readings stand up to w pixels beside their place.
void look(const Sensor& s, const World& world, double stated_x_m, std::mt19937_64& random, Tally& tally,
          double smallest_m = 0) {
  const int beside_px = smallest_m > 0 ? s.margin.lateral_px : 0;
  const auto ray = [&](double u, double v) {
    return Eigen::Vector3d((u - s.camera.cx_px) / s.camera.fx_px, (v - s.camera.cy_px) / s.camera.fy_px, 1);
  };
  std::vector<float> depth_m;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const auto beside = [&] { return beside_px > 0 ? std::floor(uniform(random, -beside_px, beside_px + 1)) : 0.0; };
      const double beside_u = beside();
      const double beside_v = beside();
      const Eigen::Vector3d r = ray(u + 0.5 + beside_u, v + 0.5 + beside_v);
      const double z = world.depth_m(r.x(), r.y());
      const bool lit = world.lit(z * r, {s.second_view_x_m, 0, 0});
      // The true depth is never more than the margin before the reading.
      const double error_m = uniform(random, -0.9, 0.9) * depth_margin_m(s.margin, z);
      depth_m.push_back(lit ? rounded_down(z + error_m) : 0.0F);
    }
  }
  RigCamera camera{.id = "camera", .intrinsics = s.camera, .rule = s.rule};
  View view(camera, {.sensor = s.margin, .smallest_obstacle_m = smallest_m, .second_view_x_m = stated_x_m}, {});
  EXPECT_TRUE(view.update({depth_view(depth_m, kWidth, kHeight), {}, 0}, Pose::Identity()));
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const double free_m = static_cast<double>(view.free_m(u, v));
      if (depth_m[pixel(u, v)] > 0) {
        continue;
      }
      ++tally.dark;
      tally.says_something += free_m > 0 ? 1 : 0;
      // With a filter radius of 0 readings speak for their pixels' centres here.
      const double spread = s.margin.lateral_px > 0 ? 0.49 : 0.0;
      for (int sample = 0; sample < 9; ++sample) {
        const Eigen::Vector3d r = ray(u + 0.5 + spread * (sample % 3 - 1), v + 0.5 + spread * (sample / 3 - 1));
        const double over_m = free_m - world.depth_m(r.x(), r.y());
        tally.too_far += over_m > 1e-6 ? 1 : 0;
        tally.worst_m = std::max(tally.worst_m, over_m);
      }
    }
  }
}

TEST(ShadowRule, NothingIsNearerThanABandSays) {
  const test::RandomRun run = test::random_run(300);
  std::mt19937_64 random(run.seed);
  Tally right_side;
  Tally wrong_side;
  for (std::int64_t n = 0; n < run.count; ++n) {
    Sensor s = random_sensor(random);
    s.second_view_x_m *= n % 2 == 0 ? 1 : -1;
    const World world = random_world(s, random);
    look(s, world, s.second_view_x_m, random, right_side);
    look(s, world, -s.second_view_x_m, random, wrong_side);
  }
  EXPECT_EQ(right_side.too_far, 0) << "by up to " << right_side.worst_m << " m; " << run.reproduce();
  EXPECT_GT(right_side.says_something, right_side.dark / 10) << right_side.dark;
  EXPECT_TRUE(wrong_side.too_far > 0 || run.count < 300) << "the worlds would not tell the sides from each other";
  std::cout << "  " << right_side.dark << " pixels in shadow, " << right_side.says_something
            << " of them free space; with the wrong side " << wrong_side.too_far << " samples too far, by up to "
            << wrong_side.worst_m << " m\n";
}

// Beside their causes bands are small holes, too: then the larger of what the two rules say counts.
TEST(ShadowRule, NothingIsNearerThanABandAndSmallHolesSay) {
  const test::RandomRun run = test::random_run(300);
  std::mt19937_64 random(run.seed);
  Tally both;
  Tally bands;
  for (std::int64_t n = 0; n < run.count; ++n) {
    Sensor s = random_sensor(random);
    s.margin.lateral_px = static_cast<int>(n % 3);
    const double smallest_m = uniform(random, 0.05, 0.3);
    const World world = random_world(s, random, smallest_m / 2);
    look(s, world, s.second_view_x_m, random, both, smallest_m);
    look(s, world, s.second_view_x_m, random, bands, 1e-9);
  }
  EXPECT_EQ(both.too_far, 0) << "by up to " << both.worst_m << " m; " << run.reproduce();
  std::cout << "  " << both.dark << " pixels in shadow, " << both.says_something
            << " of them free space; with bands alone " << bands.says_something << " of " << bands.dark << ", "
            << bands.too_far << " samples too far by up to " << bands.worst_m << " m\n";
}

TEST(ShadowRule, UnitsAndMetresSayTheSame) {
  std::mt19937_64 random(5);
  const Sensor s;
  std::vector<float> depth_m = random_strips(random);
  std::vector<std::uint16_t> units;
  for (float& depth : depth_m) {
    units.push_back(static_cast<std::uint16_t>(depth * 4000.0F));
    depth = static_cast<float>(static_cast<double>(units.back()) * 0.00025);
  }
  ShadowRule metres(s.camera, 0.00025, s.rule, s.margin, s.second_view_x_m);
  ShadowRule integers(s.camera, 0.00025, s.rule, s.margin, s.second_view_x_m);
  const DepthView by_metres = metres.fill(depth_view(depth_m, kWidth, kHeight));
  const DepthView by_units = integers.fill(depth_view(units, kWidth, kHeight, 0.00025));
  int filled = 0;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const double a_m = static_cast<double>(measured_depth_m(by_metres, s.rule, u, v).value_or(0.0F));
      const double b_m = static_cast<double>(measured_depth_m(by_units, s.rule, u, v).value_or(0.0F));
      filled += a_m > 0 && depth_m[pixel(u, v)] == 0 ? 1 : 0;
      EXPECT_LE(b_m, a_m + 1e-6);
      EXPECT_TRUE(b_m >= a_m - 0.00026 - 1e-6 || a_m < s.rule.near_m + 0.00026) << a_m << ' ' << b_m;
    }
  }
  EXPECT_GT(filled, 50);
}

TEST(ShadowRule, AnImageTakesNoMemory) {
  DEPTHGRID_REQUIRE_ALLOCATION_COUNT();
  const Sensor s;
  ShadowRule rule(s.camera, 0.001, s.rule, s.margin, s.second_view_x_m);
  const std::vector<std::uint16_t> units(std::size_t{kWidth} * kHeight, 0);
  const test::AllocationGuard guard;
  (void)rule.fill({units.data(), DepthFormat::uint16_units, kWidth, kHeight, 2 * kWidth, 0.001});
  EXPECT_EQ(guard.allocations(), 0);
}

TEST(ShadowRule, NeedsTwoViewsAndANearestReading) {
  Sensor s;
  EXPECT_NE(test::thrown_message([&] { ShadowRule(s.camera, 0.001, s.rule, s.margin, 0.0); }), "");
  s.rule.near_m = 0;
  EXPECT_NE(test::thrown_message([&] {
              ShadowRule(s.camera, 0.001, s.rule, s.margin, 0.05);
            }).find("the nearest reading is at 0 m"),
            std::string::npos);
}

}  // namespace
}  // namespace depthgrid::views
