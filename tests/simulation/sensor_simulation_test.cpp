// The simulated sensors do what their formulas say: statistics over walls and edges.
#include "depthgrid/simulation/sensor_simulation.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "depthgrid/core/error.hpp"
#include "depthgrid/simulation/pixel_random.hpp"
#include "depthgrid/simulation/scene.hpp"
#include "depthgrid/simulation/second_view.hpp"
#include "depthgrid/simulation/surface_slant.hpp"

namespace depthgrid::simulation::testing {
namespace {

const PinholeCamera kCamera{320, 240, 525, 525, 160, 120};

DepthImage wall(double depth_m, const PinholeCamera& camera = kCamera) {
  DepthImage image(camera.width_px, camera.height_px);
  std::fill_n(image.data(), image.index(0, camera.height_px), static_cast<float>(depth_m));
  return image;
}

/// A screen that covers columns [from, to) at one depth before a wall.
DepthImage screen(int from, int to, double screen_m, double wall_m) {
  DepthImage image = wall(wall_m);
  for (int v = 0; v < image.height_px(); ++v) {
    std::fill(image.data() + image.index(from, v), image.data() + image.index(to, v), static_cast<float>(screen_m));
  }
  return image;
}

struct Statistics {
  long measured = 0;
  long pixels = 0;
  double mean_m = 0;
  double sigma_m = 0;
};

/// Of the errors over some frames.
Statistics errors(SimulatedSensor& sensor, const DepthImage& ideal, int frames) {
  Statistics result;
  double sum = 0;
  double squares = 0;
  DepthImage measured;
  for (int frame = 0; frame < frames; ++frame) {
    sensor.measure(ideal, static_cast<std::uint64_t>(frame), measured);
    for (std::size_t i = 0; i < measured.index(0, measured.height_px()); ++i) {
      ++result.pixels;
      if (measured.data()[i] > 0) {
        const double error = static_cast<double>(measured.data()[i]) - ideal.data()[i];
        ++result.measured;
        sum += error;
        squares += error * error;
      }
    }
  }
  result.mean_m = sum / static_cast<double>(result.measured);
  result.sigma_m = std::sqrt(squares / static_cast<double>(result.measured) - result.mean_m * result.mean_m);
  return result;
}

TEST(PixelRandom, IsTheKnownGeneratorAndNormal) {
  EXPECT_EQ(scrambled(0), 0xE220A8397B1DCDAFULL) << "first output of SplitMix64 with seed 0";
  double squares = 0;
  double fourths = 0;
  for (unsigned i = 0; i < 65536; ++i) {
    const double x = normal_of(static_cast<std::uint16_t>(i));
    ASSERT_EQ(-x, normal_of(static_cast<std::uint16_t>(65535 - i)));
    squares += x * x;
    fourths += x * x * x * x;
  }
  EXPECT_NEAR(squares / 65536, 1, 1e-3);
  EXPECT_NEAR(fourths / 65536, 3, 0.02);
  EXPECT_NEAR(normal_of(std::uint16_t{55139}), 1.0, 1e-3) << "84.13 % lie below one standard deviation";
}

TEST(SensorSimulation, IdealChangesNothing) {
  SimulatedSensor sensor(sensor_simulation("ideal", kCamera), kCamera, 7);
  const DepthImage ideal = screen(100, 200, 1, 2);
  DepthImage measured;
  sensor.measure(ideal, 3, measured);
  for (std::size_t i = 0; i < ideal.index(0, kCamera.height_px); ++i) {
    ASSERT_EQ(measured.data()[i], ideal.data()[i]);
  }
}

TEST(SensorSimulation, KinectNoiseIsThePublishedFormulaOnWallsThatFaceIt) {
  for (const double z : {0.8, 1.0, 2.0, 3.0, 4.0}) {
    SensorSimulation kinect = sensor_simulation("kinect_v1", kCamera);
    const double formula_m = 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4);
    ASSERT_NEAR(noise_sigma_m(kinect, z), formula_m, 1e-12);
    kinect.step_per_m = 0;
    SimulatedSensor smooth(kinect, kCamera, 1);
    const Statistics s = errors(smooth, wall(z), 3);
    EXPECT_NEAR(s.mean_m, 0, 0.02 * formula_m) << z;
    EXPECT_NEAR(s.sigma_m, formula_m, 0.01 * formula_m) << z;
    // Nothing but drop-outs and the band that the projector does not reach.
    const double band = std::round(525 * 0.075 / z) / kCamera.width_px;
    EXPECT_NEAR(static_cast<double>(s.measured) / static_cast<double>(s.pixels), (1 - band) * (1 - 0.002), 0.004) << z;

    SimulatedSensor stepped(sensor_simulation("kinect_v1", kCamera), kCamera, 1);
    const double step_m = z * z / (8 * 575 * 0.075);
    EXPECT_NEAR(errors(stepped, wall(z), 3).sigma_m, std::hypot(formula_m, step_m / std::sqrt(12.0)), 0.03 * formula_m);
  }
}

TEST(SensorSimulation, KinectNoiseGrowsWithTheSlant) {
  for (const double degrees : {0.0, 40.0, 60.0, 75.0}) {
    const double slant_rad = degrees * std::numbers::pi / 180;
    Scene scene;
    scene.add(Plane{{-std::sin(slant_rad), 0, -std::cos(slant_rad)}, -2 * std::cos(slant_rad)});  // through (0, 0, 2)
    const PinholeCamera narrow{64, 48, 8000, 8000, 32, 24};  // all rays nearly along the axis
    const DepthImage ideal = scene.render(narrow, Pose::Identity()).depth_m;
    std::vector<float> slants_rad;
    surface_slants(narrow, ideal, slants_rad);
    for (std::size_t i = 0; i < slants_rad.size(); i += 7) {
      ASSERT_NEAR(slants_rad[i], slant_rad, 5e-3) << degrees;
    }
    SensorSimulation kinect = sensor_simulation("kinect_v1", narrow);
    kinect.step_per_m = kinect.lateral_px = kinect.lateral_slant_px = kinect.baseline_m = kinect.flying_share = 0;
    SimulatedSensor sensor(kinect, narrow, 1);
    const double half_pi = std::numbers::pi / 2;
    const double formula_m =
        0.0012 + 0.0019 * 1.6 * 1.6 + 0.0001 / std::sqrt(2.0) * std::pow(slant_rad / (half_pi - slant_rad), 2);
    EXPECT_NEAR(errors(sensor, ideal, 20).sigma_m, formula_m, 0.03 * formula_m) << degrees;
  }
}

TEST(SensorSimulation, SlantIsTheAngleBetweenNormalAndRay) {
  Scene scene;
  scene.add(Plane{-Eigen::Vector3d::UnitY(), -1});  // a floor one metre below a level camera
  const DepthImage ideal = scene.render(kCamera, Pose::Identity()).depth_m;
  std::vector<float> slants_rad;
  surface_slants(kCamera, ideal, slants_rad);
  for (int v = 130; v < kCamera.height_px; v += 5) {
    for (int u = 0; u < kCamera.width_px; u += 9) {
      const Eigen::Vector3d ray((u + 0.5 - 160) / 525, (v + 0.5 - 120) / 525, 1);
      ASSERT_NEAR(slants_rad[ideal.index(u, v)], std::acos(ray.y() / ray.norm()), 1e-3) << u << " " << v;
    }
  }
}

TEST(SensorSimulation, DepthsComeInSteps) {
  for (const auto& [name, step_per_m] :
       {std::pair("kinect_v1", 1 / (8 * 575 * 0.075)), std::pair("realsense_d435", 1.0 / 32 / (525 * 0.050))}) {
    SimulatedSensor sensor(sensor_simulation(name, kCamera), kCamera, 1);
    DepthImage measured;
    sensor.measure(wall(2.3), 0, measured);
    std::vector<double> seen;
    for (std::size_t i = 0; i < measured.index(0, kCamera.height_px); ++i) {
      if (measured.data()[i] > 0) {
        const double steps = 1 / (measured.data()[i] * step_per_m);
        ASSERT_NEAR(steps, std::round(steps), 1e-4) << name;
        seen.push_back(measured.data()[i]);
      }
    }
    std::sort(seen.begin(), seen.end());
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    ASSERT_GT(seen.size(), 3U);
    const std::size_t middle = seen.size() / 2;
    const double z = seen[middle];
    EXPECT_NEAR(seen[middle + 1] - z, z * z * step_per_m, 0.02 * z * z * step_per_m) << name;
  }
}

TEST(SensorSimulation, LateralNoiseMovesEdgesByItsStandardDeviation) {
  SensorSimulation s;
  s.lateral_px = 0.8;
  SimulatedSensor sensor(s, kCamera, 1);
  const DepthImage ideal = screen(160, 320, 1, 2);
  DepthImage measured;
  std::array<long, 9> far{};  // of columns 156 ... 164
  constexpr int kFrames = 20;
  for (int frame = 0; frame < kFrames; ++frame) {
    sensor.measure(ideal, static_cast<std::uint64_t>(frame), measured);
    for (int v = 0; v < kCamera.height_px; ++v) {
      for (int u = 156; u <= 164; ++u) {
        far[static_cast<std::size_t>(u - 156)] += measured.at(u, v) > 1.5F ? 1 : 0;
      }
    }
  }
  for (int u = 156; u <= 164; ++u) {
    // The pixel shows the wall if round(u + offset) < 160.
    const double expected = 0.5 * std::erfc(-(159.5 - u) / 0.8 / std::numbers::sqrt2);
    EXPECT_NEAR(static_cast<double>(far[static_cast<std::size_t>(u - 156)]) / (kFrames * kCamera.height_px), expected,
                0.02);
  }
}

TEST(SensorSimulation, ShadowStripsHaveTheWidthOfTheParallax) {
  for (const auto& [near_m, far_m] : {std::pair(1.0, 2.0), std::pair(2.0, 3.0), std::pair(0.8, 3.5)}) {
    const double strip_px = 525 * 0.075 * (1 / near_m - 1 / far_m);
    const double band_px = 525 * 0.075 / far_m;
    const DepthImage ideal = screen(150, 250, near_m, far_m);
    std::vector<std::uint8_t> hidden(ideal.index(0, kCamera.height_px));
    mark_hidden_from_second_view(kCamera, ideal, 0.075, hidden);
    for (const int v : {0, 100, 239}) {
      int strip = 0;
      int band = 0;
      for (int u = 0; u < kCamera.width_px; ++u) {
        if (hidden[ideal.index(u, v)] != 0) {
          const bool in_band = u < 100;
          (in_band ? band : strip) += 1;
          EXPECT_TRUE(in_band ? u < band_px + 1 : u < 150 && u > 150 - strip_px - 2) << "column " << u;
        }
      }
      EXPECT_NEAR(strip, strip_px, 1.01);
      EXPECT_NEAR(band, band_px, 1.01);
    }
  }
}

TEST(SensorSimulation, ThinThingsCastThinShadowsAndSlopesNone) {
  const DepthImage thin = screen(150, 156, 0.8, 3.5);  // six pixels wide, a parallax of 38
  std::vector<std::uint8_t> hidden(thin.index(0, kCamera.height_px));
  mark_hidden_from_second_view(kCamera, thin, 0.075, hidden);
  int strip = 0;
  for (int u = 60; u < 150; ++u) {
    strip += hidden[thin.index(u, 10)];
  }
  EXPECT_NEAR(strip, 6, 1.01);

  Scene scene;
  scene.add(Plane{Eigen::Vector3d(-std::sin(1.2), 0, -std::cos(1.2)), -2 * std::cos(1.2)});
  const DepthImage slope = scene.render(kCamera, Pose::Identity()).depth_m;
  std::fill(hidden.begin(), hidden.end(), std::uint8_t{0});
  mark_hidden_from_second_view(kCamera, slope, 0.075, hidden);
  for (int u = 60; u < kCamera.width_px; ++u) {
    ASSERT_EQ(hidden[slope.index(u, 100)], 0) << "column " << u;
  }
}

TEST(SensorSimulation, FlyingPixelsLieBetweenTheDepthsOfTheirEdge) {
  SensorSimulation s;
  s.flying_share = 0.3;
  SimulatedSensor sensor(s, kCamera, 1);
  const DepthImage ideal = screen(160, 320, 1, 2);
  DepthImage measured;
  long at_edge = 0;
  long flying = 0;
  for (int frame = 0; frame < 20; ++frame) {
    sensor.measure(ideal, static_cast<std::uint64_t>(frame), measured);
    for (int v = 0; v < kCamera.height_px; ++v) {
      for (int u = 0; u < kCamera.width_px; ++u) {
        if (u != 159 && u != 160) {
          ASSERT_EQ(measured.at(u, v), ideal.at(u, v));
          continue;
        }
        ++at_edge;
        ASSERT_GE(measured.at(u, v), 1.0F);
        ASSERT_LE(measured.at(u, v), 2.0F);
        flying += measured.at(u, v) != ideal.at(u, v) ? 1 : 0;
      }
    }
  }
  EXPECT_NEAR(static_cast<double>(flying) / static_cast<double>(at_edge), 0.3, 0.02);
}

TEST(SensorSimulation, OutOfRangeThereIsNoMeasurement) {
  for (const auto& [name, near_m, far_m] :
       {std::tuple("kinect_v1", 0.5, 10.0), std::tuple("realsense_d435", 0.28, 10.0),
        std::tuple("azure_kinect_nfov", 0.5, 3.86)}) {
    SimulatedSensor sensor(sensor_simulation(name, kCamera), kCamera, 1);
    EXPECT_EQ(errors(sensor, wall(0.6 * near_m), 1).measured, 0) << name;
    EXPECT_EQ(errors(sensor, wall(1.5 * far_m), 1).measured, 0) << name;
    EXPECT_GT(errors(sensor, wall(0.5 * (near_m + far_m)), 1).measured, 60000) << name;
  }
}

TEST(SensorSimulation, StereoAndTimeOfFlightHaveTheStatedNoiseAndBias) {
  for (const double z : {1.0, 2.0, 3.0}) {
    SensorSimulation stereo = sensor_simulation("realsense_d435", kCamera);
    const double noise_m = z * z * 0.08 / (525 * 0.050);
    EXPECT_NEAR(noise_sigma_m(stereo, z), noise_m, 1e-12);
    stereo.bias_linear = stereo.step_per_m = 0;
    SimulatedSensor noisy(stereo, kCamera, 1);
    EXPECT_NEAR(errors(noisy, wall(z), 10).sigma_m, noise_m, 0.03 * noise_m);

    SensorSimulation flight = sensor_simulation("azure_kinect_nfov", kCamera);
    flight.bias_constant_m = flight.bias_linear = 0;
    SimulatedSensor time_of_flight(flight, kCamera, 1);
    EXPECT_NEAR(errors(time_of_flight, wall(z), 3).sigma_m, 0.017, 0.0002);

    // The bias alone: smooth, within what is stated, and nearly that much somewhere.
    flight = sensor_simulation("azure_kinect_nfov", kCamera);
    flight.noise_constant_m = flight.flying_share = flight.dropout_share = 0;
    double largest_m = 0;
    for (std::uint64_t unit = 1; unit <= 8; ++unit) {
      SimulatedSensor biased(flight, kCamera, unit);
      DepthImage measured;
      biased.measure(wall(z), 0, measured);
      for (int v = 0; v < kCamera.height_px; ++v) {
        for (int u = 0; u < kCamera.width_px; ++u) {
          largest_m = std::max(largest_m, std::abs(measured.at(u, v) - z));
          ASSERT_NEAR(measured.at(u, v), measured.at(std::max(0, u - 1), v), 3e-4);
        }
      }
    }
    EXPECT_LE(largest_m, 0.011 + 0.001 * z + 1e-6);
    EXPECT_GE(largest_m, 0.9 * (0.011 + 0.001 * z));
  }
}

TEST(SensorSimulation, VibrationShiftsTheWholeImage) {
  SensorSimulation s;
  s.vibration_px = 3;
  SimulatedSensor sensor(s, kCamera, 1);
  const DepthImage ideal = screen(160, 320, 1, 2);
  DepthImage measured;
  int moved = 0;
  for (int frame = 0; frame < 20; ++frame) {
    sensor.measure(ideal, static_cast<std::uint64_t>(frame), measured);
    int edge = 0;
    while (measured.at(edge, 0) > 1.5F) {
      ++edge;
    }
    EXPECT_LE(std::abs(edge - 160), 3);
    moved += edge != 160 ? 1 : 0;
    for (int v = 0; v < kCamera.height_px; ++v) {
      ASSERT_GT(measured.at(edge - 1, v), 1.5F);
      ASSERT_LT(measured.at(edge, v), 1.5F);
    }
  }
  EXPECT_GT(moved, 5);
}

TEST(SensorSimulation, SeedAndFrameDecideAlone) {
  const auto image = [](std::uint64_t seed, std::uint64_t frame, bool others_before) {
    SimulatedSensor sensor(sensor_simulation("kinect_v1", kCamera), kCamera, seed);
    DepthImage measured;
    if (others_before) {
      sensor.measure(wall(1.1), 99, measured);
      sensor.measure(wall(1.2), 2, measured);
    }
    sensor.measure(screen(100, 200, 1, 2), frame, measured);
    return std::vector<float>(measured.data(), measured.data() + measured.index(0, kCamera.height_px));
  };
  EXPECT_EQ(image(5, 3, false), image(5, 3, true));
  EXPECT_NE(image(5, 3, false), image(5, 4, false));
  EXPECT_NE(image(5, 3, false), image(6, 3, false));
}

TEST(SensorSimulation, UnitsAreRoundedAndOverflowIsNoMeasurement) {
  DepthImage image(4, 1);
  image.at(0, 0) = 1.2344F;
  image.at(1, 0) = 65.534F;
  image.at(2, 0) = 65.6F;
  EXPECT_EQ(in_units(image, 0.001), (std::vector<std::uint16_t>{1234, 65534, 0, 0}));
  EXPECT_THROW((void)in_units(image, 0), Error);
}

TEST(SensorSimulation, BrokenOnesAreRefused) {
  const auto refusal = [](const SensorSimulation& sensor) {
    try {
      SimulatedSensor(sensor, kCamera, 1);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  SensorSimulation s;
  EXPECT_EQ(refusal(s), "accepted");
  s.flying_share = 1.5;
  EXPECT_EQ(refusal(s), "simulation of sensor 'ideal': flying_share is 1.5, out of range");
  s = {};
  s.noise_constant_m = -1;
  EXPECT_EQ(refusal(s), "simulation of sensor 'ideal': noise_constant_m is -1, out of range");
  s = {};
  s.patch_px = 0;
  EXPECT_EQ(refusal(s), "simulation of sensor 'ideal': patch_px is 0, out of range");
  EXPECT_THROW((void)sensor_simulation("kinect_v9", kCamera), Error);
  SimulatedSensor sensor({}, kCamera, 1);
  DepthImage measured;
  EXPECT_THROW(sensor.measure(DepthImage(2, 2), 0, measured), Error);
}

}  // namespace
}  // namespace depthgrid::simulation::testing
