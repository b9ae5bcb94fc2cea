// Lens distortion against OpenCV's answers (a committed table) and its removal against a sampled square.
#include "depthgrid/core/distortion.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "depthgrid/core/rectification.hpp"
#include "support/random_run.hpp"
#include "support/thrown_message.hpp"

namespace depthgrid {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::HasSubstr;

/// Relative to the repository's root, where the tests run; written by make_opencv_table.py beside it.
constexpr const char* kTable = "tests/core/data/opencv_distortion.txt";

struct Calibration {
  PinholeCamera camera;
  Distortion distortion;
  std::string line;
};

/// Calls on_project(calibration, point, u, v) and on_undistort(calibration, u, v, x, y) for the lines of the table.
template <class OnProject, class OnUndistort>
void read_table(const OnProject& on_project, const OnUndistort& on_undistort) {
  std::ifstream file(kTable);
  ASSERT_TRUE(file) << "cannot open " << kTable << "; run the test in the root of the repository";
  Calibration calibration;
  for (std::string line; std::getline(file, line);) {
    std::istringstream text(line);
    std::string kind;
    text >> kind;
    if (kind == "set") {
      std::string model;
      int width_px = 0;
      int height_px = 0;
      std::array<double, 12> n{};
      text >> model >> width_px >> height_px;
      for (double& value : n) {
        text >> value;
      }
      const bool rational = model == "rational";
      const std::vector<double> coefficients(n.begin() + 4, n.begin() + (rational ? 12 : 9));
      calibration = {
          from_opencv(width_px, height_px, n[0], n[1], n[2], n[3]),
          make_distortion(rational ? Distortion::Model::rational : Distortion::Model::plumb_bob, coefficients), line};
    } else if (kind == "project") {
      Vector3d p;
      double u = 0;
      double v = 0;
      text >> p.x() >> p.y() >> p.z() >> u >> v;
      on_project(calibration, p, u, v);
    } else if (kind == "undistort") {
      double u = 0;
      double v = 0;
      double x = 0;
      double y = 0;
      text >> u >> v >> x >> y;
      on_undistort(calibration, u, v, x, y);
    }
    ASSERT_TRUE(kind == "#" || !text.fail()) << line;
  }
}

/// Image coordinates between pixel edges of normalised coordinates.
Vector2d to_pixels(const PinholeCamera& camera, const Vector2d& n) {
  return {camera.fx_px * n.x() + camera.cx_px, camera.fy_px * n.y() + camera.cy_px};
}

TEST(OpencvTable, ForwardModelAndHalfPixelAgree) {
  int points = 0;
  read_table(
      [&points](const Calibration& c, const Vector3d& p, double u, double v) {
        const Vector2d ours = to_pixels(c.camera, distort(c.distortion, {p.x() / p.z(), p.y() / p.z()}));
        // OpenCV counts from the centre of the first pixel, we from its edge.
        EXPECT_NEAR(ours.x(), u + 0.5, 1e-9) << c.line << "\npoint " << p.transpose();
        EXPECT_NEAR(ours.y(), v + 0.5, 1e-9) << c.line << "\npoint " << p.transpose();
        ++points;
      },
      [](auto&&...) {});
  EXPECT_EQ(points, 8 * 24);
}

TEST(OpencvTable, ForwardModelInvertsUndistortPoints) {
  int points = 0;
  read_table([](auto&&...) {},
             [&points](const Calibration& c, double u, double v, double x, double y) {
               const Vector2d ours = to_pixels(c.camera, distort(c.distortion, {x, y}));
               EXPECT_NEAR(ours.x(), u + 0.5, 1e-9) << c.line;
               EXPECT_NEAR(ours.y(), v + 0.5, 1e-9) << c.line;
               ++points;
             });
  EXPECT_EQ(points, 8 * 24);
}

TEST(MakeDistortion, TakesTheCountsOfItsModels) {
  EXPECT_EQ(make_distortion(Distortion::Model::none, {}).model, Distortion::Model::none);
  EXPECT_EQ(make_distortion(Distortion::Model::none, std::array{0.0, 0.0, 0.0, 0.0, 0.0}).model,
            Distortion::Model::none);
  EXPECT_EQ(make_distortion(Distortion::Model::plumb_bob, std::array{0.1, 0.2, 0.3, 0.4}).coefficients,
            (std::array<double, 8>{0.1, 0.2, 0.3, 0.4, 0, 0, 0, 0}));
  EXPECT_EQ(make_distortion(Distortion::Model::rational, std::array{1., 2., 3., 4., 5., 6., 7., 8.}).coefficients[7],
            8.0);
}

TEST(BrokenDistortion, NamesValueAndRule) {
  const auto message = [](Distortion::Model model, const std::vector<double>& coefficients) {
    return test::thrown_message([&] { make_distortion(model, coefficients); });
  };
  EXPECT_EQ(message(Distortion::Model::none, {0, 0.1}),
            "distortion none: coefficient 1 is 0.1, must be 0; is the model plumb_bob, rational or equidistant?");
  EXPECT_EQ(message(Distortion::Model::plumb_bob, {}),
            "distortion plumb_bob: 0 coefficients given, must be 4 or 5 (k1 k2 p1 p2 k3)");
  EXPECT_EQ(message(Distortion::Model::plumb_bob, {1, 2, 3, 4, 5, 6, 7, 8}),
            "distortion plumb_bob: 8 coefficients given, must be 4 or 5 (k1 k2 p1 p2 k3)");
  EXPECT_EQ(message(Distortion::Model::rational, {1, 2, 3, 4, 5}),
            "distortion rational: 5 coefficients given, must be 8 (k1 k2 p1 p2 k3 k4 k5 k6)");
  EXPECT_EQ(message(Distortion::Model::rational, std::vector<double>(14, 0.0)),
            "distortion rational: 14 coefficients given, at most 8 are known (k1 k2 p1 p2 k3 k4 k5 k6)");
  EXPECT_EQ(message(Distortion::Model::plumb_bob, {0, 0, std::nan(""), 0}),
            "distortion plumb_bob: coefficient 2 is nan, must be a finite number");
  const PinholeCamera wide{64, 48, 20, 20, 32, 24};
  // The denominator 1 - r^2 vanishes on the circle r = 1, inside this image.
  EXPECT_THAT(test::thrown_message([&] {
                const std::array<double, 8> pole{0, 0, 0, 0, 0, -1, 0, 0};
                DepthUndistortion(wide, make_distortion(Distortion::Model::rational, pole), wide, 0);
              }),
              HasSubstr("distortion: the model is not finite at pixel ("));
  EXPECT_THAT(test::thrown_message([&] {
                const std::array<double, 4> huge{1e308, 1e308, 0, 0};
                DepthUndistortion(wide, make_distortion(Distortion::Model::plumb_bob, huge), wide, 0);
              }),
              HasSubstr("the model is not finite"));
  EXPECT_EQ(test::thrown_message([&] {
              DepthUndistortion({64, 48, 0, 20, 32, 24}, {}, wide, 0);
            }),
            "distorted camera: fx is 0 px, must be a positive finite number");
}

constexpr auto kEquidistant = Distortion::Model::equidistant;
/// The first is the plain projection theta f; the others are of the size that calibrations of wide lenses have.
constexpr std::array<std::array<double, 4>, 3> kFisheyes{
    {{0, 0, 0, 0}, {-0.008, 0.043, -0.04, 0.007}, {0.03, -0.02, 0.006, -0.001}}};

/// The angle at which a fisheye lens images a ray at `image` focal lengths from the middle: by halving, with nothing of
/// the library.
long double angle_of(const std::array<double, 4>& k, long double image) {
  long double low = 0;
  long double high = 1.57L;
  for (int step = 0; step < 200; ++step) {
    const long double t = (low + high) / 2;
    const long double t2 = t * t;
    const long double there =
        t + k[0] * t * t2 + k[1] * t * t2 * t2 + k[2] * t * t2 * t2 * t2 + k[3] * t * t2 * t2 * t2 * t2;
    (there < image ? low : high) = t;
  }
  return (low + high) / 2;
}

TEST(Equidistant, RoundTripThroughAnIndependentInverse) {
  const PinholeCamera camera{640, 480, 285.5, 286.25, 319.25, 243.5};
  int pixels = 0;
  for (const std::array<double, 4>& k : kFisheyes) {
    const Distortion lens = make_distortion(kEquidistant, k);
    for (int v = 0; v <= 480; v += 16) {
      for (int u = 0; u <= 640; u += 16) {
        const long double x = (u - 319.25L) / 285.5L;
        const long double y = (v - 243.5L) / 286.25L;
        const long double image = std::hypot(x, y);
        const long double theta = angle_of(k, image);
        if (theta > 1.5L) {
          continue;  // a ray beside the plane
        }
        const long double stretch = image > 0 ? std::tan(theta) / image : 1.0L;
        const Vector2d back =
            to_pixels(camera, distort(lens, {static_cast<double>(x * stretch), static_cast<double>(y * stretch)}));
        EXPECT_NEAR(back.x(), u, 1e-9);
        EXPECT_NEAR(back.y(), v, 1e-9);
        ++pixels;
      }
    }
  }
  EXPECT_GT(pixels, 3000);
}

TEST(Equidistant, CoefficientsThatFoldInsideTheImageAreRefused) {
  const PinholeCamera camera{640, 480, 300, 300, 320, 240};
  // theta (1 - 0.5 theta^2) turns back at theta = sqrt(2/3), 46.8 degrees, where it is 0.544: 163 px.
  EXPECT_EQ(test::thrown_message([&] {
              refuse_fold(camera, make_distortion(kEquidistant, std::array{-0.5, 0., 0., 0.}));
            }),
            "distortion equidistant: the coefficients fold back 46.79 degrees off the axis, 163 px from the principal "
            "point and inside the image, whose farthest corner is 400 px away; are they of another model (plumb_bob, "
            "rational), in another order, or for another image size?");
  // The same lens on a picture that ends before.
  refuse_fold({160, 120, 300, 300, 80, 60}, make_distortion(kEquidistant, std::array{-0.5, 0., 0., 0.}));
  for (const std::array<double, 4>& k : kFisheyes) {
    refuse_fold(camera, make_distortion(kEquidistant, k));
  }
  EXPECT_EQ(test::thrown_message([] {
              (void)make_distortion(kEquidistant, std::array{0.1, 0., 0.});
            }),
            "distortion equidistant: 3 coefficients given, must be 4 (k1 k2 k3 k4)");
}

TEST(Rectification, KeepsWhatAFisheyeAndAWideTimeOfFlightCameraSee) {
  // The coefficients of an Azure Kinect in wide mode, rounded; the lens sees 60 degrees to every side.
  const PinholeCamera wide{512, 512, 252, 252, 256.75, 258};
  const Distortion rational =
      make_distortion(Distortion::Model::rational, std::array{0.9, 0.12, 0.0004, -0.0003, 0.004, 1.23, 0.33, 0.018});
  const PinholeCamera fisheye{320, 240, 150, 151, 161.5, 118.25};
  const Distortion equidistant = make_distortion(kEquidistant, kFisheyes[1]);
  for (const auto& [camera, lens] : {std::pair(wide, rational), std::pair(fisheye, equidistant)}) {
    const PinholeCamera rectified = rectified_camera(camera, lens);
    EXPECT_EQ(rectified.fx_px, camera.fx_px);
    EXPECT_GT(rectified.width_px, camera.width_px * 5 / 4);
    EXPECT_LE(rectified.width_px, camera.width_px * 2);
    // A ray 58 degrees off the axis, which the plain intrinsics cut, is in both images.
    const double x = std::tan(58.0 / 180.0 * 3.14159265358979);
    const Vector2d source = to_pixels(camera, distort(lens, {x, 0}));
    ASSERT_TRUE(camera.contains(static_cast<int>(source.x()), static_cast<int>(source.y())));
    EXPECT_GT(x * camera.fx_px + camera.cx_px, camera.width_px);
    EXPECT_LT(x * rectified.fx_px + rectified.cx_px, rectified.width_px);
    DepthImage full(camera.width_px, camera.height_px);
    std::fill_n(full.data(), full.index(0, camera.height_px), 2.0F);
    DepthImage result(rectified.width_px, rectified.height_px);
    const DepthUndistortion undistortion(camera, lens, rectified, 0);
    undistortion.apply(full, result);
    EXPECT_EQ(result.at(static_cast<int>(x * rectified.fx_px + rectified.cx_px), static_cast<int>(rectified.cy_px)),
              2.0F);
    const auto used = [&](const PinholeCamera& target) {
      const std::vector<bool> read = DepthUndistortion(camera, lens, target, 0).pixels_read();
      return static_cast<double>(std::count(read.begin(), read.end(), true)) / static_cast<double>(read.size());
    };
    EXPECT_GT(used(rectified), used(camera) + 0.1);
  }
}

/// At the rim of a wide lens one source pixel is several of the result, so a filter of the result alone would pass over
/// a near surface one source pixel away.
TEST(Rectification, NearSurfacesBesideAReadingCountWhereThePixelsAreStretched) {
  const PinholeCamera camera{320, 240, 150, 151, 161.5, 118.25};
  const Distortion lens = make_distortion(kEquidistant, kFisheyes[0]);
  const PinholeCamera rectified = rectified_camera(camera, lens);
  DepthImage source(320, 240);
  std::fill_n(source.data(), source.index(0, 240), 4.0F);
  constexpr int kNear = 290;  // 49 degrees off the axis
  for (int v = 0; v < 240; ++v) {
    source.at(kNear, v) = 1.0F;
  }
  for (const int lateral_px : {0, 1, 2}) {
    DepthImage result(rectified.width_px, rectified.height_px);
    DepthUndistortion(camera, lens, rectified, lateral_px).apply(source, result);
    // Every pixel of the result whose middle lies in the source columns beside the near one.
    int far = 0;
    const int row = static_cast<int>(rectified.cy_px);
    for (int u = 0; u < rectified.width_px; ++u) {
      const double x = (u + 0.5 - rectified.cx_px) / rectified.fx_px;
      const int column = static_cast<int>(std::floor(to_pixels(camera, distort(lens, {x, 0.0})).x()));
      if (std::abs(column - kNear) <= lateral_px) {
        far += result.at(u, row) > 1.0F ? 1 : 0;
      }
    }
    EXPECT_EQ(far, 0) << lateral_px;
    EXPECT_EQ(result.at(static_cast<int>(rectified.cx_px), row), 4.0F);
  }
}

TEST(Rectification, ImagesWithoutALensKeepTheirSizeAndLongerSidesEnd) {
  const PinholeCamera camera{640, 480, 525, 525, 320, 240};
  EXPECT_EQ(rectified_camera(camera, {}).width_px, 640);
  const PinholeCamera pincushion =
      rectified_camera(camera, make_distortion(Distortion::Model::plumb_bob, std::array{0.1, 0., 0., 0.}));
  EXPECT_EQ(pincushion.width_px, 640);  // never smaller
  EXPECT_EQ(pincushion.height_px, 480);
  const PinholeCamera extreme =
      rectified_camera({640, 480, 240, 240, 320, 240}, make_distortion(kEquidistant, kFisheyes[0]));
  EXPECT_NEAR(extreme.width_px, 2 * 240 * std::tan(65.0 / 180.0 * 3.14159265358979), 6);  // what lies beyond is cut
  EXPECT_NEAR(extreme.cx_px, 0.5 * extreme.width_px, 3);
}

/// An image in which every pixel has its own depth, so that results tell which pixels were read.
DepthImage numbered(int width_px, int height_px) {
  DepthImage image(width_px, height_px);
  for (std::size_t i = 0; i < image.index(0, height_px); ++i) {
    image.data()[i] = 1.0F + static_cast<float>((i * 7919) % 100003) * 1e-4F;
  }
  return image;
}

TEST(DepthUndistortion, NoDistortionIsTheIdentity) {
  const PinholeCamera camera{640, 480, 525.3, 524.7, 318.21, 241.37};
  const DepthImage source = numbered(640, 480);
  for (const Distortion& lens :
       {Distortion{}, make_distortion(Distortion::Model::plumb_bob, std::array{0., 0., 0., 0., 0.}),
        make_distortion(Distortion::Model::rational, std::array{0., 0., 0., 0., 0., 0., 0., 0.}),
        // Coefficients without a model do not count.
        Distortion{Distortion::Model::none, {0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5}}}) {
    DepthImage result(640, 480);
    DepthUndistortion(camera, lens, camera, 0).apply(source, result);
    EXPECT_TRUE(std::equal(source.data(), source.data() + 640 * 480, result.data()));
  }
}

TEST(DepthUndistortion, HalvingTakesTheMinimumOfFourPixels) {
  const PinholeCamera camera{64, 48, 50, 50, 32, 24};
  const PinholeCamera half{32, 24, 25, 25, 16, 12};
  DepthImage source = numbered(64, 48);
  source.at(11, 7) = 0.0F;
  DepthImage result(32, 24);
  DepthUndistortion(camera, {}, half, 0).apply(source, result);
  for (int v = 0; v < 24; ++v) {
    for (int u = 0; u < 32; ++u) {
      EXPECT_EQ(result.at(u, v), std::min({source.at(2 * u, 2 * v), source.at(2 * u + 1, 2 * v),
                                           source.at(2 * u, 2 * v + 1), source.at(2 * u + 1, 2 * v + 1)}));
    }
  }
  EXPECT_EQ(result.at(5, 3), 0.0F) << "one source pixel without measurement";
}

TEST(DepthUndistortion, OutsideTheSourceIsNoMeasurement) {
  // Moved by three and a half pixels: the last three columns and the one that is cut see nothing.
  const PinholeCamera source_camera{64, 48, 50, 50, 32, 24};
  const PinholeCamera moved{64, 48, 50, 50, 28.5, 24};
  const DepthImage source = numbered(64, 48);
  DepthImage result(64, 48);
  DepthUndistortion(source_camera, {}, moved, 0).apply(source, result);
  for (int u = 0; u < 64; ++u) {
    const float expected = u < 60 ? std::min(source.at(u + 3, 5), source.at(u + 4, 5)) : 0.0F;
    EXPECT_EQ(result.at(u, 5), expected) << u;
  }
}

TEST(DepthUndistortion, FoldedSquaresAreNoMeasurement) {
  // r (1 - 0.3 r^2) turns back at r = 1.05 and maps r = 1.83 on the image's centre, which no lens images.
  const Distortion fold = make_distortion(Distortion::Model::plumb_bob, std::array{-0.3, 0., 0., 0.});
  const PinholeCamera narrow{64, 64, 50, 50, 32, 32};
  const PinholeCamera wide{256, 256, 50, 50, 128, 128};
  DepthImage source(64, 64);
  std::fill_n(source.data(), 64 * 64, 2.0F);
  DepthImage result(256, 256);
  DepthUndistortion(narrow, fold, wide, 0).apply(source, result);
  int measured = 0;
  for (int v = 0; v < 256; ++v) {
    for (int u = 0; u < 256; ++u) {
      const double radius = std::hypot(u + 0.5 - 128, v + 0.5 - 128) / 50;
      if (result.at(u, v) > 0) {
        ++measured;
        EXPECT_LT(radius, 1.055) << u << ", " << v;
      }
    }
  }
  EXPECT_GT(measured, 64 * 64);  // a barrel image, undistorted, is larger than its source
}

TEST(DepthUndistortion, ImagesOfAnotherSizeGiveNoMeasurement) {
  const PinholeCamera camera{4, 3, 5, 5, 2, 1.5};
  const DepthUndistortion undistortion(camera, {}, camera, 0);
  DepthImage result(4, 3);
  result.at(1, 1) = 1.0F;
  undistortion.apply(numbered(3, 4), result);
  EXPECT_EQ(result.at(1, 1), 0.0F);
}

/// What one pixel of the result may be: `upper` from the source pixels that samples of its square meet, `lower` from
/// those and all their neighbours.
struct Bounds {
  float lower, upper;
};

Bounds sampled(const Calibration& c, const DepthImage& source, int u, int v) {
  Bounds bounds{1e9F, 1e9F};
  const auto depth_m = [&](int x, int y) { return c.camera.contains(x, y) ? source.at(x, y) : 0.0F; };
  constexpr int kSteps = 6;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      // Just inside the square: its edges belong to it, but a pixel touched along a line only need not count.
      const double x_px = u + 1e-4 + (1 - 2e-4) * i / kSteps;
      const double y_px = v + 1e-4 + (1 - 2e-4) * j / kSteps;
      const Vector2d at = to_pixels(c.camera, distort(c.distortion, {(x_px - c.camera.cx_px) / c.camera.fx_px,
                                                                     (y_px - c.camera.cy_px) / c.camera.fy_px}));
      const int x = static_cast<int>(std::floor(at.x()));
      const int y = static_cast<int>(std::floor(at.y()));
      bounds.upper = std::min(bounds.upper, depth_m(x, y));
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          bounds.lower = std::min(bounds.lower, depth_m(x + dx, y + dy));
        }
      }
    }
  }
  return bounds;
}

TEST(DepthUndistortion, MissesNoTouchedPixelAndAddsOnlyNeighbours) {
  std::vector<Calibration> calibrations;
  read_table(
      [&calibrations](const Calibration& c, auto&&...) {
        if (calibrations.empty() || calibrations.back().line != c.line) {
          calibrations.push_back(c);
        }
      },
      [](auto&&...) {});
  ASSERT_EQ(calibrations.size(), 8U);
  for (const std::array<double, 4>& k : kFisheyes) {
    calibrations.push_back({{320, 240, 150, 151, 161.5, 118.25}, make_distortion(kEquidistant, k), "equidistant"});
  }
  const test::RandomRun run = test::random_run(20'000);
  for (const Calibration& c : calibrations) {
    std::mt19937_64 random(run.seed);
    std::uniform_int_distribution<int> column(0, c.camera.width_px - 1);
    std::uniform_int_distribution<int> row(0, c.camera.height_px - 1);
    DepthImage source = numbered(c.camera.width_px, c.camera.height_px);
    for (int hole = 0; hole < 50; ++hole) {
      source.at(column(random), row(random)) = 0.0F;
    }
    DepthImage result(c.camera.width_px, c.camera.height_px);
    DepthUndistortion(c.camera, c.distortion, c.camera, 0).apply(source, result);
    int measured = 0;
    int failures = 0;
    for (std::int64_t i = 0; i < run.count && failures < 3; ++i) {
      const int u = column(random);
      const int v = row(random);
      const Bounds bounds = sampled(c, source, u, v);
      const float depth_m = result.at(u, v);
      measured += depth_m > 0 ? 1 : 0;
      if (!(depth_m >= bounds.lower && depth_m <= bounds.upper)) {
        ++failures;
        ADD_FAILURE() << "pixel (" << u << ", " << v << ") is " << depth_m << ", samples say " << bounds.lower << " to "
                      << bounds.upper << "\n"
                      << c.line << "\n"
                      << run.reproduce();
      }
    }
    if (run.count >= 1000) {
      EXPECT_GT(measured, run.count / 2) << c.line;
    }
  }
}

}  // namespace
}  // namespace depthgrid
