// The depth grid, equation (4), and the windows of equations (8)-(9).
#include "depthgrid/grid/depth_grid.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "depthgrid/core/error.hpp"
#include "depthgrid/grid/surveillance_window.hpp"
#include "reference/random_problem.hpp"
#include "support/random_run.hpp"

namespace depthgrid::grid {
namespace {

using ::testing::HasSubstr;

const PinholeCamera kCamera{640, 480, 525, 525, 320, 240};

TEST(DepthGrid, TheLettersOwnGrid) {
  const DepthGrid grid(kCamera, {0.2882, 0.01, 0.0, 343});
  EXPECT_EQ(grid.count(), 343);
  EXPECT_NEAR(grid.d_max_m(), 3.7182, 1e-12);
  EXPECT_EQ(grid.cell_of(0.2882), 0);
  EXPECT_EQ(grid.cell_of(0.2981), 0);
  EXPECT_EQ(grid.cell_of(0.2983), 1);
  EXPECT_EQ(grid.cell_of(0.2881), -1);
  EXPECT_GE(grid.cell_of(3.72), 343);
}

TEST(DepthGrid, EveryDepthLiesInItsCell) {
  reference::Random random(test::random_run(0).seed);
  for (std::int64_t i = 0; i < test::random_run(2000).count; ++i) {
    const DepthQuantisation q{random.uniform(0, 1), random.uniform(0.002, 0.1),
                              random.chance(0.5) ? 0.0 : random.uniform(0, 0.05), random.integer(1, 200)};
    const DepthGrid grid(kCamera, q);
    for (int j = 0; j < 20; ++j) {
      const int n = random.integer(0, q.count - 1);
      const double d = j < 10 ? random.uniform(q.d_min_m, grid.d_max_m()) : grid.boundary_m(n);
      const int cell = grid.cell_of(d);
      if (d >= grid.d_max_m()) {
        EXPECT_GE(cell, q.count);
        continue;
      }
      ASSERT_GE(cell, 0) << q.d_min_m << ' ' << q.step_m << ' ' << q.growth << ' ' << q.count << " d " << d;
      ASSERT_LT(cell, q.count);
      EXPECT_LE(grid.boundary_m(cell), d);
      EXPECT_GT(grid.boundary_m(cell + 1), d);
    }
  }
}

TEST(DepthGrid, CellsGrowLinearlyWithDepth) {
  const DepthGrid grid(kCamera, {0.5, 0.01, 0.02, 150});
  for (int n = 0; n < grid.count(); ++n) {
    const double expected = 0.01 + 0.02 * (grid.boundary_m(n) - 0.5);
    EXPECT_NEAR(grid.boundary_m(n + 1) - grid.boundary_m(n), expected, 1e-12) << n;
  }
}

TEST(DepthGrid, RefusesWhatMakesNoGrid) {
  const auto message = [](const DepthQuantisation& q) -> std::string {
    try {
      const DepthGrid grid(kCamera, q);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message({-0.1, 0.01, 0, 10}), HasSubstr("d_min is -0.1 m"));
  EXPECT_THAT(message({kNaN, 0.01, 0, 10}), HasSubstr("d_min is nan m"));
  EXPECT_THAT(message({0.1, 0.0, 0, 10}), HasSubstr("step is 0 m, must be positive"));
  EXPECT_THAT(message({0.1, 0.01, -1, 10}), HasSubstr("growth is -1, must be between 0"));
  EXPECT_THAT(message({0.1, 0.01, 0, 0}), HasSubstr("count is 0 cells"));
  EXPECT_THAT(message({0.1, 0.01, 0, 70000}), HasSubstr("count is 70000 cells"));
  EXPECT_THAT(message({0.1, 0.01, 1, 65535}), HasSubstr("the last of 65535 cells ends at"));
  EXPECT_THAT(message({0.1, 1e-9, 0, 10}), HasSubstr("vanishes in single precision"));
}

TEST(SurveillanceWindow, PrintedSizeIsHalfOfWhatTheSphereNeeds) {
  // d_p = 2 m, rho = 0.4 m: x_s = 0.4 * 525 / 1.6 = 131.25 px in all, 65.6 px to each side.
  const Eigen::Vector3d p_camera(0, 0, 2);
  const PixelWindow printed = printed_window(kCamera, project(kCamera, p_camera), 0.4);
  EXPECT_EQ(printed.u_begin, 254);
  EXPECT_EQ(printed.u_end, 386);
  const PixelWindow exact = sphere_window(kCamera, p_camera, 0.4);
  EXPECT_LE(exact.u_begin, 320 - 107);
  EXPECT_GE(exact.u_end, 320 + 107);
  // An obstacle at the same depth is missed from 65.6 px * 2 m / 525 px = 0.25 m outward.
  const DepthPoint beside = project(kCamera, {0.26, 0, 2});
  EXPECT_FALSE(printed.contains(static_cast<int>(beside.x_px), static_cast<int>(beside.y_px)));
  EXPECT_TRUE(exact.contains(static_cast<int>(beside.x_px), static_cast<int>(beside.y_px)));
}

TEST(SurveillanceWindow, UndefinedNearTheCameraMeansTheWholeImage) {
  const PixelWindow window = printed_window(kCamera, project(kCamera, {0, 0, 0.3}), 0.4);
  EXPECT_EQ(window.u_begin, 0);
  EXPECT_EQ(window.v_end, 480);
  EXPECT_TRUE(sphere_window(kCamera, {0, 0, -0.5}, 0.4).empty());
  EXPECT_EQ(sphere_window(kCamera, {0, 0, 0.1}, 0.4).u_end, 640);
}

TEST(SurveillanceWindow, CoversEveryPointOfTheSphereAndNotMuchMore) {
  reference::Random random(test::random_run(0).seed);
  for (std::int64_t i = 0; i < test::random_run(2000).count; ++i) {
    const double rho = random.uniform(0.05, 0.6);
    const Eigen::Vector3d p(random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5), random.uniform(-0.2, 3));
    const PixelWindow window = sphere_window(kCamera, p, rho);
    double lowest_u = 1e9;
    for (int j = 0; j < 200; ++j) {
      const Eigen::Vector3d x = p + random.uniform(0, rho) * random.direction();
      if (x.z() <= 0) {
        continue;
      }
      const DepthPoint q = project(kCamera, x);
      lowest_u = std::min(lowest_u, q.x_px);
      const bool in_image = q.x_px >= 0 && q.y_px >= 0 && q.x_px < 640 && q.y_px < 480;
      EXPECT_TRUE(!in_image || window.contains(static_cast<int>(q.x_px), static_cast<int>(q.y_px)))
          << p.transpose() << " rho " << rho;
    }
    // Tight: the tangent from the camera touches the sphere, so some point of it lies at the window's edge.
    if (p.z() > rho + 0.05 && window.u_begin > 0 && !window.empty()) {
      const double slope = (window.u_begin + 1 - kCamera.cx_px) / kCamera.fx_px;
      const double distance = std::abs(p.x() - slope * p.z()) / std::hypot(1.0, slope);
      EXPECT_LT(distance, rho + 1e-9) << p.transpose() << " rho " << rho;
    }
  }
}

}  // namespace
}  // namespace depthgrid::grid
