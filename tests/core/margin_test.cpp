// The free depth against a twin that follows its definition pixel by pixel.
#include "depthgrid/core/margin.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>
#include <vector>

#include "support/random_run.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr float kInfinite = std::numeric_limits<float>::infinity();

/// The robot's interval in every pixel, with padded rows.
struct RobotImage {
  RobotImage(int width_px, int height_px, int padding_px)
      : stride_px(width_px + padding_px),
        near_m(static_cast<std::size_t>(stride_px * height_px), 0.0F),
        far_m(near_m.size(), 0.0F) {}

  [[nodiscard]] RobotView view() const { return {near_m.data(), far_m.data(), stride_px}; }
  [[nodiscard]] std::size_t index(int u, int v) const { return static_cast<std::size_t>(v * stride_px + u); }
  void set(int u, int v, float near, float far) {
    near_m[index(u, v)] = near;
    far_m[index(u, v)] = far;
  }

  int stride_px;
  std::vector<float> near_m, far_m;
};

/// D - m(D), or the robot's exit, of one pixel in extended precision; 0 outside the image.
long double reduced_twin(const DepthImage& measured, const RobotImage* robot, const SensorMargin& margin, int u,
                         int v) {
  if (u < 0 || v < 0 || u >= measured.width_px() || v >= measured.height_px() || measured.at(u, v) == 0.0F) {
    return 0.0L;
  }
  const long double depth_m = measured.at(u, v);
  const long double m = margin.constant_m + margin.linear * depth_m + margin.quadratic_per_m * depth_m * depth_m;
  if (robot != nullptr) {
    const float near_m = robot->near_m[robot->index(u, v)];
    const float far_m = robot->far_m[robot->index(u, v)];
    if (near_m > 0 && near_m <= depth_m - m && depth_m <= far_m && far_m < kInfinite) {
      return far_m;
    }
  }
  return std::max(0.0L, depth_m - m);
}

long double free_twin(const DepthImage& measured, const RobotImage* robot, const SensorMargin& margin, int u, int v) {
  long double smallest = reduced_twin(measured, robot, margin, u, v);
  for (int dv = -margin.lateral_px; dv <= margin.lateral_px; ++dv) {
    for (int du = -margin.lateral_px; du <= margin.lateral_px; ++du) {
      smallest = std::min(smallest, reduced_twin(measured, robot, margin, u + du, v + dv));
    }
  }
  return smallest;
}

struct Scene {
  DepthImage measured;
  RobotImage robot;
  SensorMargin margin;

  [[nodiscard]] std::string paste() const {
    std::ostringstream text;
    text.precision(9);
    text << measured.width_px() << " x " << measured.height_px() << ", margin {" << margin.constant_m << ", "
         << margin.linear << ", " << margin.quadratic_per_m << ", " << margin.lateral_px << "}, depth/near/far:";
    for (int v = 0; v < measured.height_px(); ++v) {
      for (int u = 0; u < measured.width_px(); ++u) {
        text << (u == 0 ? "\n" : " ") << measured.at(u, v) << '/' << robot.near_m[robot.index(u, v)] << '/'
             << robot.far_m[robot.index(u, v)];
      }
    }
    return text.str();
  }
};

Scene random_scene(std::mt19937_64& random) {
  const auto whole = [&random](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  const auto uniform = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const int width_px = whole(1, 21);
  const int height_px = whole(1, 11);
  Scene scene{DepthImage(width_px, height_px), RobotImage(width_px, height_px, whole(0, 3)), {}};
  const auto part = [&](double largest) { return whole(0, 2) == 0 ? 0.0 : uniform(0, largest); };
  scene.margin = {part(0.05), part(0.02), part(0.01), whole(0, 3)};
  const int valid_of_ten = whole(5, 10);
  for (int v = 0; v < height_px; ++v) {
    for (int u = 0; u < width_px; ++u) {
      const auto depth_m = static_cast<float>(uniform(0.001, whole(0, 9) == 0 ? 0.05 : 6.0));
      scene.measured.at(u, v) = whole(1, 10) <= valid_of_ten ? depth_m : 0.0F;
      if (whole(0, 1) == 0) {
        scene.robot.set(u, v, depth_m + static_cast<float>(uniform(-0.3, 0.1)),
                        whole(0, 30) == 0 ? kInfinite : depth_m + static_cast<float>(uniform(-0.1, 0.3)));
      }
    }
  }
  return scene;
}

TEST(FreeDepth, AgreesWithItsDefinition) {
  const test::RandomRun run = test::random_run(3000);
  std::mt19937_64 random(run.seed);
  for (std::int64_t n = 0; n < run.count; ++n) {
    const Scene scene = random_scene(random);
    FreeDepth free_depth(scene.measured.width_px(), scene.measured.height_px(), scene.margin);
    for (const RobotImage* robot : {static_cast<const RobotImage*>(nullptr), &scene.robot}) {
      free_depth.update(scene.measured, robot == nullptr ? RobotView{} : robot->view());
      for (int v = 0; v < scene.measured.height_px(); ++v) {
        for (int u = 0; u < scene.measured.width_px(); ++u) {
          const long double exact_m = free_twin(scene.measured, robot, scene.margin, u, v);
          const long double result_m = free_depth.image().at(u, v);
          // Never above, and at most one float step below.
          ASSERT_TRUE(result_m <= exact_m && result_m >= exact_m * (1.0L - 0x1p-22L) - 1e-30L && result_m >= 0)
              << "pixel (" << u << ", " << v << (robot != nullptr ? ") with" : ") without") << " robot is " << result_m
              << ", exactly " << exact_m << "\nimage " << n << " of " << run.reproduce() << ": " << scene.paste();
        }
      }
    }
  }
}

/// A single row in which only the pixel asked for has something special about it.
float free_of_pixel(float depth_m, float near_m, float far_m, const SensorMargin& margin) {
  DepthImage measured(1, 1);
  measured.at(0, 0) = depth_m;
  RobotImage robot(1, 1, 0);
  robot.set(0, 0, near_m, far_m);
  FreeDepth free_depth(1, 1, margin);
  free_depth.update(measured, robot.view());
  return free_depth.image().at(0, 0);
}

TEST(FreeDepth, RobotPixelsByHand) {
  const SensorMargin margin{0.25, 0.0, 0.0, 0};
  EXPECT_EQ(free_of_pixel(2.0F, 1.5F, 2.5F, margin), 2.5F) << "inside: the exit";
  EXPECT_EQ(free_of_pixel(2.0F, 1.75F, 2.0F, margin), 2.0F) << "both ends belong to the interval";
  EXPECT_NEAR(free_of_pixel(2.0F, 1.76F, 2.5F, margin), 1.75, 1e-6) << "the margin reaches out of the robot's front";
  EXPECT_NEAR(free_of_pixel(2.0F, 1.5F, 1.99F, margin), 1.75, 1e-6) << "measured behind the exit";
  EXPECT_NEAR(free_of_pixel(1.0F, 1.5F, 2.5F, margin), 0.75, 1e-6) << "something stands before the robot";
  EXPECT_NEAR(free_of_pixel(2.0F, 0.0F, 2.5F, margin), 1.75, 1e-6) << "near of 0: no robot";
  EXPECT_NEAR(free_of_pixel(2.0F, 1.5F, kInfinite, margin), 1.75, 1e-6) << "no exit";
  EXPECT_EQ(free_of_pixel(0.0F, 1.5F, 2.5F, margin), 0.0F) << "no measurement: the robot's mask frees nothing";
  EXPECT_EQ(free_of_pixel(0.1F, 0.0F, 0.0F, margin), 0.0F) << "margin larger than the depth";
}

TEST(FreeDepth, WithoutMarginIsTheDepthItself) {
  for (const float depth_m : {1.0F, 0.1F, 3.14159274F, 1e-3F, 65.534F}) {
    EXPECT_EQ(free_of_pixel(depth_m, 0, 0, {0, 0, 0, 0}), depth_m);
  }
}

TEST(FreeDepth, IsNotRoundedUpByTheDifferenceEither) {
  // 1 - (0.25 + 2^-54) lies half a step of double precision below 0.75 and rounds to it.
  EXPECT_LT(free_of_pixel(1.0F, 0, 0, {std::nextafter(0.25, 1.0), 0, 0, 0}), 0.75F);
}

TEST(FreeDepth, BordersAndHolesReachAsFarAsTheFilter) {
  for (const int radius_px : {1, 2, 3}) {
    constexpr int kSide = 15;
    DepthImage measured(kSide, kSide);
    std::fill_n(measured.data(), kSide * kSide, 2.0F);
    measured.at(7, 7) = 0.0F;
    FreeDepth free_depth(kSide, kSide, {0, 0, 0, radius_px});
    free_depth.update(measured, {});
    for (int v = 0; v < kSide; ++v) {
      for (int u = 0; u < kSide; ++u) {
        const bool border = std::min({u, v, kSide - 1 - u, kSide - 1 - v}) < radius_px;
        const bool hole = std::max(std::abs(u - 7), std::abs(v - 7)) <= radius_px;
        EXPECT_EQ(free_depth.image().at(u, v), border || hole ? 0.0F : 2.0F) << u << ", " << v << ", w " << radius_px;
      }
    }
  }
}

TEST(FreeDepth, FreesNothingBeforeTheFirstUpdateOrWithAnImageOfAnotherSize) {
  FreeDepth free_depth(4, 3, {0, 0, 0, 0});
  EXPECT_EQ(free_depth.image().at(2, 1), 0.0F);
  DepthImage measured(4, 3);
  std::fill_n(measured.data(), 12, 2.0F);
  free_depth.update(measured, {});
  EXPECT_EQ(free_depth.image().at(2, 1), 2.0F);
  free_depth.update(DepthImage(3, 4), {});
  EXPECT_EQ(free_depth.image().at(2, 1), 0.0F);
}

TEST(DepthMargin, IsThePolynomial) {
  EXPECT_DOUBLE_EQ(depth_margin_m({0.01, 0.02, 0.003, 1}, 2.0), 0.01 + 0.04 + 0.012);
}

TEST(BrokenMargin, NamesValueAndRule) {
  const auto message = [](const auto& margin) {
    return test::thrown_message([&margin] { validate(margin, "camera 'left'"); });
  };
  EXPECT_EQ(message(SensorMargin{}), "");
  EXPECT_EQ(message(PoseMargin{}), "");
  EXPECT_EQ(message(SensorMargin{-0.01, 0, 0, 1}),
            "camera 'left': constant is -0.01 m, must be a finite number that is not negative");
  EXPECT_EQ(message(SensorMargin{0, kNoNumber, 0, 1}),
            "camera 'left': linear is nan, must be a finite number that is not negative");
  EXPECT_EQ(message(SensorMargin{0, 0, kInfinite, 1}),
            "camera 'left': quadratic is inf 1/m, must be a finite number that is not negative");
  EXPECT_EQ(message(SensorMargin{0, 0, 0, 17}), "camera 'left': filter radius is 17 px, must be between 0 and 16");
  EXPECT_EQ(message(SensorMargin{0, 0, 0, -1}), "camera 'left': filter radius is -1 px, must be between 0 and 16");
  EXPECT_EQ(message(PoseMargin{-1, 0, 0}),
            "camera 'left': translation is -1 m, must be a finite number that is not negative");
  EXPECT_EQ(message(PoseMargin{0, kInfinite, 0}),
            "camera 'left': rotation is inf rad, must be a finite number that is not negative");
  EXPECT_EQ(message(PoseMargin{0, 0, kNoNumber}),
            "camera 'left': time is nan m, must be a finite number that is not negative");
  EXPECT_EQ(message(CameraMargins{}), "");
  EXPECT_EQ(message(CameraMargins{{0, 0, 0, 17}, 0, 0, 0, 0}),
            "camera 'left': filter radius is 17 px, must be between 0 and 16");
  EXPECT_EQ(message(CameraMargins{{}, -1, 0, 0, 0}),
            "camera 'left': translation is -1 m, must be a finite number that is not negative");
  EXPECT_EQ(message(CameraMargins{{}, 0, kNoNumber, 0, 0}),
            "camera 'left': rotation is nan rad, must be a finite number that is not negative");
  EXPECT_EQ(message(CameraMargins{{}, 0, 0, -0.1, 0}),
            "camera 'left': half exposure is -0.1 s, must be a finite number that is not negative");
  EXPECT_EQ(message(CameraMargins{{}, 0, 0, 0, kInfinite}),
            "camera 'left': time uncertainty is inf s, must be a finite number that is not negative");
  EXPECT_EQ(test::thrown_message([] {
              FreeDepth(4, 3, {0, 0, 0, 17});
            }),
            "sensor margin: filter radius is 17 px, must be between 0 and 16");
  EXPECT_EQ(test::thrown_message([] { FreeDepth(0, 3, {}); }),
            "depth image: size is 0 x 3 px, each side must be between 1 and 16384");
}

}  // namespace
}  // namespace depthgrid
