// The distance from a point to a pixel frustum against the certificate of a projection on a convex set.
//
// A failing random case is printed as a line that can be pasted into kRegressions.
#include "depthgrid/core/pixel_frustum.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "support/random_run.hpp"

namespace depthgrid {
namespace {

using Eigen::Vector3d;

constexpr double kInf = std::numeric_limits<double>::infinity();

struct Case {
  PixelFrustum frustum;
  std::array<double, 3> p_camera;
};

/// Cases that failed once, or that are easy to get wrong. Paste printed cases here.
const std::vector<Case> kRegressions = {
    {{0, 0, 0, 0, 0, 0}, {0, 0, 0}},                          // the apex alone
    {{-1, 1, -1, 1, 0, kInf}, {0.1, 0.2, -3}},                // behind the apex
    {{-1, 1, -1, 1, 0, kInf}, {3, -4, 0}},                    // beside the apex
    {{0.5, 0.5, -0.25, -0.25, 1, 1}, {0, 0, 0}},              // one point
    {{0.5, 0.5, -0.25, -0.25, 1, kInf}, {5, -7, 2}},          // a ray
    {{0, 0.1, 0, 0.1, 1, 1.01}, {-1, -1, 1.005}},             // slopes of zero
    {{-0.1, 0, -0.1, 0, 1, kInf}, {-0.05, 0.3, 0.2}},         //
    {{0.3, 0.302, -0.2, -0.198, 2, kInf}, {0.9, -0.2, 1.7}},  // crosses x = X on the way to the minimum
    {{0.3, 0.302, -0.2, -0.198, 2, 2.01}, {0.604, -0.4, 2}},  // on a vertex
    {{-2, 1.5, -0.5, 0.5, 0, 4}, {1, 0.2, 1}},                // inside
    {{-1, 1, -1, 1, 1, kInf}, {1e3, 0, 1}},                   // far aside
};

std::string number(double value) {
  if (std::isinf(value)) {
    return "kInf";
  }
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.17g", value);
  return text.data();
}

std::string paste(const Case& c) {
  const PixelFrustum& f = c.frustum;
  std::string line = "    {{";
  for (const double value : {f.a0, f.a1, f.b0, f.b1, f.d1_m}) {
    line += number(value) + ", ";
  }
  line += number(f.d2_m) + "}, {" + number(c.p_camera[0]) + ", " + number(c.p_camera[1]) + ", ";
  return line + number(c.p_camera[2]) + "}},";
}

/// The largest accepted misalignment of P - p* and the cell's normal cone at p*, in metres at coordinates of about 10
/// m. It is a backward error: p* is the exact nearest point of a point that lies about this far from P, and distances
/// change no faster than points move.
constexpr double kMisalignment_m = 1e-11;
/// Rounding of the vertices and of p* themselves, which matters where a vertex lies at p*.
constexpr double kVertexRounding_m = 2e-14;

/// Empty when `nearest` is the nearest point and distance, else what is wrong.
std::string check_answer(const Case& c, const NearestPoint& nearest) {
  const PixelFrustum& f = c.frustum;
  const Vector3d p(c.p_camera[0], c.p_camera[1], c.p_camera[2]);
  const Vector3d& q = nearest.point_camera;
  const double scale = std::max({1.0, p.cwiseAbs().maxCoeff() / 10.0, q.cwiseAbs().maxCoeff() / 10.0});

  // p* lies in the cell: exactly, because it is clipped to the same products.
  if (!(f.d1_m <= q.z() && q.z() <= f.d2_m && f.a0 * q.z() <= q.x() && q.x() <= f.a1 * q.z() && f.b0 * q.z() <= q.y() &&
        q.y() <= f.b1 * q.z())) {
    return "the nearest point lies outside the cell";
  }
  // (P - p*) . (w - p*) <= 0 for every vertex w, and along the edges where they have no end.
  const Vector3d to_point = p - q;
  for (const double a : {f.a0, f.a1}) {
    for (const double b : {f.b0, f.b1}) {
      const Vector3d edge(a, b, 1);
      for (const double d : {f.d1_m, f.d2_m}) {
        const bool endless = std::isinf(d);
        const Vector3d along = endless ? edge : Vector3d(edge * d - q);
        const double tolerance =
            scale * (kMisalignment_m * along.norm() + (endless ? 0.0 : kVertexRounding_m) * to_point.norm());
        if (!(to_point.dot(along) <= tolerance)) {
          return "certificate violated by " + number(to_point.dot(along)) + " at slopes " + number(a) + ", " +
                 number(b) + ", depth " + number(d);
        }
      }
    }
  }
  const double distance_m = to_point.norm();
  if (!(std::abs(nearest.distance_m - distance_m) <= 1e-15 * scale + 1e-14 * distance_m)) {
    return "distance " + number(nearest.distance_m) + " is not that of the nearest point, " + number(distance_m);
  }
  if (nearest.distance_m == 0.0 ? nearest.direction_camera != Vector3d::Zero()
                                : !((nearest.direction_camera * distance_m + to_point).norm() <= 1e-14 * scale &&
                                    std::abs(nearest.direction_camera.norm() - 1.0) <= 1e-14)) {
    return "wrong direction";
  }
  return {};
}

/// The same for both library calls.
std::string check(const Case& c) {
  const Vector3d p(c.p_camera[0], c.p_camera[1], c.p_camera[2]);
  const NearestPoint nearest = nearest_point(c.frustum, p);
  const double distance_m = std::sqrt(squared_distance(c.frustum, p));
  if (!(std::abs(distance_m - nearest.distance_m) <= 1e-15 + 1e-14 * nearest.distance_m)) {
    return "squared_distance is that of " + number(distance_m) + ", nearest_point's " + number(nearest.distance_m);
  }
  return check_answer(c, nearest);
}

class CaseMaker {
 public:
  explicit CaseMaker(std::uint64_t seed) : random_(seed) {}

  double uniform(double low, double high) { return low + (high - low) * unit_(random_); }
  int whole(int low, int high) { return static_cast<int>(std::floor(uniform(low, high + 1.0))); }

  Case make() {
    Case c;
    c.frustum = whole(0, 2) == 0 ? any_frustum() : pixel();
    c.p_camera = point(c.frustum);
    return c;
  }

  PinholeCamera camera() const { return {640, 480, 525, 525, 320, 240}; }

  PixelFrustum pixel() {
    // Pixels outside the image too; column 320 and row 240 have a slope of 0.
    const double d1_m = whole(0, 9) == 0 ? 0.0 : uniform(0.0, 5.0);
    return pixel_frustum(camera(), whole(0, 9) == 0 ? whole(319, 320) : whole(-50, 690),
                         whole(0, 9) == 0 ? whole(239, 240) : whole(-50, 530), d1_m, far_end(d1_m));
  }

  std::array<double, 3> point(const PixelFrustum& f) {
    switch (whole(0, 5)) {
      case 0:  // anywhere, behind the camera too
        return {uniform(-5, 5), uniform(-5, 5), uniform(-3, 7)};
      case 1: {  // inside or on the border
        const double z = f.d1_m + (whole(0, 2) == 0 ? 0.0 : uniform(0, 1)) * (std::min(f.d2_m, 9.0) - f.d1_m);
        return {between(f.a0, f.a1) * z, between(f.b0, f.b1) * z, z};
      }
      case 2: {  // on the plane of a face, where pieces of F' meet
        const double z = uniform(-1, 6);
        return {(whole(0, 1) == 0 ? f.a0 : f.a1) * z, uniform(-2, 2), z};
      }
      case 3: {  // a hair off a vertex
        const double hair_m = std::pow(10.0, uniform(-14, -2));
        return {f.a0 * f.d1_m + uniform(-1, 1) * hair_m, f.b1 * f.d1_m + uniform(-1, 1) * hair_m,
                f.d1_m + uniform(-1, 1) * hair_m};
      }
      default: {  // within reach of a robot's surveillance radius
        const double z = f.d1_m + uniform(0, 1) * (std::min(f.d2_m, f.d1_m + 1.0) - f.d1_m);
        return {f.a0 * z + uniform(-0.4, 0.4), f.b0 * z + uniform(-0.4, 0.4), z + uniform(-0.4, 0.4)};
      }
    }
  }

 private:
  double between(double low, double high) {
    const int kind = whole(0, 4);
    return kind == 0 ? low : kind == 1 ? high : std::min(high, low + uniform(0, 1) * (high - low));
  }

  double far_end(double d1_m) {
    constexpr std::array<double, 4> kDeep{0.0, 0.01, 1.0, kInf};
    const int kind = whole(0, 4);
    return kind == 4 ? d1_m + uniform(0, 5) : d1_m + kDeep[static_cast<std::size_t>(kind)];
  }

  std::array<double, 2> slopes() {
    double low = whole(0, 7) == 0 ? 0.0 : uniform(-2, 2);
    double high = whole(0, 7) == 0 ? low : whole(0, 7) == 0 ? 0.0 : low + std::pow(10.0, uniform(-4, 0.5));
    return {std::min(low, high), std::max(low, high)};
  }

  PixelFrustum any_frustum() {
    const auto a = slopes();
    const auto b = slopes();
    const double d1_m = whole(0, 4) == 0 ? 0.0 : uniform(0.0, 5.0);
    return {a[0], a[1], b[0], b[1], d1_m, far_end(d1_m)};
  }

  std::mt19937_64 random_;
  std::uniform_real_distribution<double> unit_{0.0, 1.0};
};

TEST(PixelFrustum, Regressions) {
  for (const Case& c : kRegressions) {
    EXPECT_EQ(check(c), "") << paste(c);
  }
}

TEST(PixelFrustum, RandomCasesSatisfyTheCertificate) {
  const test::RandomRun run = test::random_run(2'000'000);
  CaseMaker maker(run.seed);
  int failures = 0;
  for (std::int64_t i = 0; i < run.count && failures < 5; ++i) {
    const Case c = maker.make();
    if (const std::string wrong = check(c); !wrong.empty()) {
      ++failures;
      ADD_FAILURE() << wrong << "\ncase " << i << " of " << run.reproduce() << ", paste it into kRegressions:\n"
                    << paste(c);
    }
  }
}

TEST(PixelFrustum, CertificateRejectsWrongPoints) {
  // A point 1 mm from the nearest one, on the same edge of an endless frustum: every vertex and three edges accept it.
  const Case c{{0.3, 0.302, -0.2, -0.198, 2, kInf}, {1.0, 0.5, 2.0}};
  const Vector3d p(1.0, 0.5, 2.0);
  const NearestPoint right = nearest_point(c.frustum, p);
  EXPECT_EQ(check_answer(c, right), "");
  for (const double step_m : {-1e-3, 1e-3}) {
    const Vector3d moved = right.point_camera + Vector3d(0.302, -0.198, 1) * step_m;
    const double moved_m = (moved - p).norm();
    EXPECT_NE(check_answer(c, {moved, moved_m, (moved - p) / moved_m}), "");
  }
  EXPECT_NE(check_answer(c, {right.point_camera, right.distance_m + 1e-9, right.direction_camera}), "");
  EXPECT_NE(check_answer(c, {right.point_camera, right.distance_m, -right.direction_camera}), "");
}

TEST(PixelFrustum, AgreesWithSampling) {
  const PixelFrustum f{0.3, 0.302, -0.2, -0.198, 2, 2.01};
  const Vector3d p(1.0, 0.5, 2.0);
  const double exact_m = nearest_point(f, p).distance_m;
  double sampled_m = kInf;
  constexpr int kSteps = 40;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      for (int k = 0; k <= kSteps; ++k) {
        const double z = f.d1_m + (f.d2_m - f.d1_m) * k / kSteps;
        const double x = (f.a0 + (f.a1 - f.a0) * i / kSteps) * z;
        const double y = (f.b0 + (f.b1 - f.b0) * j / kSteps) * z;
        sampled_m = std::min(sampled_m, (Vector3d(x, y, z) - p).norm());
      }
    }
  }
  EXPECT_GE(sampled_m, exact_m - 1e-12);
  EXPECT_LE(sampled_m, exact_m + 3e-4);  // the pitch of the samples
}

TEST(PixelFrustum, PointInsideIsItsOwnNearestPoint) {
  const PixelFrustum f{0.1, 0.2, -0.3, -0.1, 1, kInf};
  const Vector3d p(0.3, -0.4, 2.0);
  const NearestPoint nearest = nearest_point(f, p);
  EXPECT_EQ(nearest.distance_m, 0.0);
  EXPECT_EQ(nearest.point_camera, p);
  EXPECT_EQ(nearest.direction_camera, Vector3d::Zero());
  EXPECT_EQ(squared_distance(f, p), 0.0);
}

TEST(PixelFrustum, OfPixelHasThePixelsEdges) {
  const PinholeCamera camera{640, 480, 500, 400, 320, 240};
  const PixelFrustum f = pixel_frustum(camera, 420, 140, 1.5, 2.5);
  EXPECT_DOUBLE_EQ(f.a0, 0.2);
  EXPECT_DOUBLE_EQ(f.a1, 0.202);
  EXPECT_DOUBLE_EQ(f.b0, -0.25);
  EXPECT_DOUBLE_EQ(f.b1, -0.2475);
  EXPECT_EQ(f.d1_m, 1.5);
  EXPECT_EQ(f.d2_m, 2.5);
}

/// f = 100 px and pixel (60, 50): x/z from 0.1 to 0.11, y/z from 0 to 0.01, depth 1 to 1.5 m. The three points of the
/// letter's Fig. 3, all at x = 0.3 m and y = 0: beside the cell, before it and beyond it.
struct Figure3 : testing::Test {
  PinholeCamera camera{200, 200, 100, 100, 50, 50};
  PixelFrustum cell = pixel_frustum(camera, 60, 50, 1.0, 1.5);

  [[nodiscard]] NearestPoint letter(const Vector3d& p) const {
    return nearest_point_letter(camera, 60, 50, 1.0, 1.5, project(camera, p));
  }
};

TEST_F(Figure3, WithinTheDepthOfTheCell) {
  // p = (75, 50, 1.2) clamps to (61, 50, 1.2), that is x = 11 * 1.2 / 100 = 0.132.
  const NearestPoint nearest = letter({0.3, 0, 1.2});
  EXPECT_NEAR(nearest.distance_m, 0.168, 1e-12);
  EXPECT_LT((nearest.point_camera - Vector3d(0.132, 0, 1.2)).norm(), 1e-12);
  EXPECT_LT((nearest.direction_camera - Vector3d(-1, 0, 0)).norm(), 1e-12);
  // Exactly: the plane x = 0.11 z, at 0.168 / sqrt(1 + 0.11^2).
  EXPECT_NEAR(nearest_point(cell, {0.3, 0, 1.2}).distance_m, 0.168 / std::sqrt(1.0121), 1e-12);
}

TEST_F(Figure3, BeforeTheCell) {
  // p = (87.5, 50, 0.8) clamps to (61, 50, 1), x = 0.11: v = (-0.19, 0, 0.2).
  const NearestPoint nearest = letter({0.3, 0, 0.8});
  EXPECT_NEAR(nearest.distance_m, std::hypot(0.19, 0.2), 1e-12);
  EXPECT_NEAR(nearest_point(cell, {0.3, 0, 0.8}).distance_m, std::hypot(0.19, 0.2), 1e-12);
}

TEST_F(Figure3, BeyondTheCell) {
  // p = (65, 50, 2) clamps to (61, 50, 1.5), x = 0.165: v = (-0.135, 0, -0.5).
  const NearestPoint nearest = letter({0.3, 0, 2.0});
  EXPECT_NEAR(nearest.distance_m, std::hypot(0.135, 0.5), 1e-12);
  EXPECT_NEAR(nearest_point(cell, {0.3, 0, 2.0}).distance_m, std::hypot(0.135, 0.5), 1e-12);
}

TEST_F(Figure3, InsideTheCell) {
  const NearestPoint nearest = letter({0.126, 0.006, 1.2});
  EXPECT_NEAR(nearest.distance_m, 0.0, 1e-15);
}

TEST(LetterDistance, NeverBelowTheExactDistance) {
  const test::RandomRun run = test::random_run(500'000);
  CaseMaker maker(run.seed);
  const PinholeCamera camera = maker.camera();
  int failures = 0;
  double largest_excess_m = 0;
  for (std::int64_t i = 0; i < run.count && failures < 5; ++i) {
    const int u = maker.whole(0, 639);
    const int v = maker.whole(0, 479);
    const double d1_m = maker.uniform(0.3, 4.0);
    const double d2_m = d1_m + (maker.whole(0, 3) == 0 ? 0.0 : 0.01);
    const PixelFrustum cell = pixel_frustum(camera, u, v, d1_m, d2_m);
    const auto point = maker.point(cell);
    const Vector3d p(point[0], point[1], std::max(point[2], 0.05));
    const double exact_m = nearest_point(cell, p).distance_m;
    const NearestPoint letter = nearest_point_letter(camera, u, v, d1_m, d2_m, project(camera, p));
    largest_excess_m = std::max(largest_excess_m, letter.distance_m - exact_m);
    // The way through pixels and back costs some rounding of p itself.
    if (!(letter.distance_m >= exact_m - 1e-13) || !(squared_distance(cell, letter.point_camera) <= 1e-26)) {
      ++failures;
      ADD_FAILURE() << "letter " << number(letter.distance_m) << " m, exact " << number(exact_m) << " m, pixel (" << u
                    << ", " << v << ")\ncase " << i << " of " << run.reproduce() << ", paste it into kRegressions:\n"
                    << paste({cell, {p.x(), p.y(), p.z()}});
    }
  }
  RecordProperty("largest_excess_mm", std::to_string(1e3 * largest_excess_m));
  if (run.count >= 1000) {
    EXPECT_GT(largest_excess_m, 1e-4)
        << "the clamps in pixel coordinates are no projection; equal answers are suspicious";
  }
}

TEST(LetterDistance, InfiniteFarEndBeforeTheCell) {
  const PinholeCamera camera{200, 200, 100, 100, 50, 50};
  const NearestPoint nearest = nearest_point_letter(camera, 60, 50, 1.0, kInf, project(camera, {0.3, 0, 0.8}));
  EXPECT_NEAR(nearest.distance_m, std::hypot(0.19, 0.2), 1e-12);
}

}  // namespace
}  // namespace depthgrid
