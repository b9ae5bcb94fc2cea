// The list of pixels of a cell against two twins that share no code with it: points sampled from the cell's volume must
// project into the list, and a pixel is in the list exactly if its square and the hull of the cell's projected corners
// are not separated by any axis.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "depthgrid/grid/map/cell_footprint.hpp"
#include "grid/map_rigs.hpp"
#include "support/random_run.hpp"

namespace depthgrid::grid {
namespace {

using Point = Eigen::Vector2d;

// Where a point of the principal camera's depth space appears in the secondary image, written out.
Eigen::Vector3d appears_at(const MapCalibration& rig, const SecondaryCamera& s, double x_px, double y_px,
                           double depth_m) {
  const Eigen::Vector4d p((x_px - rig.principal.cx_px) / rig.principal.fx_px * depth_m,
                          (y_px - rig.principal.cy_px) / rig.principal.fy_px * depth_m, depth_m, 1);
  const Eigen::Vector4d q = s.T_secondary_principal.matrix() * p;
  return {s.camera.cx_px + s.camera.fx_px * (q.x() / q.z()), s.camera.cy_px + s.camera.fy_px * (q.y() / q.z()), q.z()};
}

double cross(const Point& o, const Point& a, const Point& b) {
  return (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
}

// Convex hull by Andrew's monotone chain.
std::vector<Point> hull_of(std::vector<Point> points) {
  std::sort(points.begin(), points.end(),
            [](const Point& a, const Point& b) { return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y()); });
  std::vector<Point> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t begin = hull.size();
    for (const Point& p : points) {
      while (hull.size() >= begin + 2 && cross(hull[hull.size() - 2], hull.back(), p) <= 0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

// Largest gap between the hull and the pixel's square along any separating axis, in pixels; negative: they overlap.
double gap_px(const std::vector<Point>& hull, int u, int v) {
  const std::array<Point, 4> square{Point(u, v), Point(u + 1, v), Point(u + 1, v + 1), Point(u, v + 1)};
  std::vector<Point> axes{Point(1, 0), Point(0, 1)};
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Point edge = hull[(i + 1) % hull.size()] - hull[i];
    if (edge.norm() > 1e-12) {
      axes.push_back(Point(-edge.y(), edge.x()).normalized());
    }
  }
  double gap = -std::numeric_limits<double>::infinity();
  for (const Point& axis : axes) {
    std::array<double, 2> low{1e300, 1e300};
    std::array<double, 2> high{-1e300, -1e300};
    const auto extend = [&](std::size_t which, const Point& p) {
      low[which] = std::min(low[which], axis.dot(p));
      high[which] = std::max(high[which], axis.dot(p));
    };
    std::for_each(hull.begin(), hull.end(), [&](const Point& p) { extend(0, p); });
    std::for_each(square.begin(), square.end(), [&](const Point& p) { extend(1, p); });
    gap = std::max(gap, std::max(low[1] - high[0], low[0] - high[1]));
  }
  return gap;
}

bool contains(const CellFootprint& list, int u_px, int v_px) {
  const int row = v_px - list.v_first_px;
  return row >= 0 && row < static_cast<int>(list.rows.size()) &&
         u_px >= list.rows[static_cast<std::size_t>(row)].u_first_px &&
         u_px <= list.rows[static_cast<std::size_t>(row)].u_last_px;
}

struct Tally {
  std::int64_t samples = 0;
  std::int64_t inside = 0;
  std::int64_t outside = 0;
  std::int64_t behind = 0;
};

void check_cell(const MapCalibration& rig, const SecondaryCamera& s, int u, int v, double front_m, double back_m,
                const CellFootprint& list, bool involved, std::mt19937_64& random, Tally& tally) {
  std::vector<Point> corners;
  double nearest_m = 1e300;
  double largest_px = 0;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d q = appears_at(rig, s, u + (i & 1), v + ((i >> 1) & 1), (i & 4) == 0 ? front_m : back_m);
    corners.emplace_back(q.x(), q.y());
    nearest_m = std::min(nearest_m, q.z());
    largest_px = std::max({largest_px, std::abs(q.x()), std::abs(q.y())});
  }
  if (nearest_m < 2 * kNearestCornerM) {
    ++tally.behind;
    if (nearest_m < 0) {
      ASSERT_FALSE(involved);
    }
    return;  // between 0 and kNearestCornerM rounding decides
  }
  ASSERT_EQ(involved, !list.rows.empty());
  if (involved) {
    ASSERT_NEAR(list.d_start_m, nearest_m, 1e-6 * std::max(1.0, nearest_m));
  }

  for (int i = 0; i < 60; ++i) {
    // Half of the samples on the border, where rounding decides.
    const auto place = [&] {
      return random() % 2 == 0 ? static_cast<double>(random() % 2)
                               : std::uniform_real_distribution<double>(0, 1)(random);
    };
    const double share = place();
    const double depth_m = share == 1 ? back_m : front_m + share * (back_m - front_m);
    const Eigen::Vector3d q = appears_at(rig, s, u + place(), v + place(), depth_m);
    const int x = static_cast<int>(std::floor(std::clamp(q.x(), -1.0, 1e6)));
    const int y = static_cast<int>(std::floor(std::clamp(q.y(), -1.0, 1e6)));
    if (s.camera.contains(x, y)) {
      ++tally.samples;
      ASSERT_TRUE(contains(list, x, y)) << "sample in pixel (" << x << ", " << y << ")";
    }
  }

  const std::vector<Point> hull = hull_of(corners);
  const double tolerance_px = 1e-6 + 1e-12 * largest_px;  // ten times the outward slack of the list, both ways
  for (int y = 0; y < s.camera.height_px; ++y) {
    for (int x = 0; x < s.camera.width_px; ++x) {
      const double gap = gap_px(hull, x, y);
      if (gap > tolerance_px) {
        ++tally.outside;
        ASSERT_FALSE(contains(list, x, y)) << "pixel (" << x << ", " << y << ") is " << gap << " px from the cell";
      } else if (gap < -tolerance_px) {
        ++tally.inside;
        ASSERT_TRUE(contains(list, x, y)) << "pixel (" << x << ", " << y << ") overlaps the cell by " << -gap << " px";
      }
    }
  }
}

TEST(MapFootprint, HoldsExactlyThePixelsThatTheCellTouches) {
  const test::RandomRun run = test::random_run(4000);
  Tally tally;
  for (std::int64_t i = 0; i < run.count; ++i) {
    const std::uint64_t seed = run.seed * 1000003 + static_cast<std::uint64_t>(i);
    const MapCalibration rig = random_map_rig(seed);
    const DepthGrid grid = grid_of(rig);
    std::mt19937_64 random(seed);
    for (const SecondaryCamera& secondary : rig.secondaries) {
      CellProjector projector(rig.principal, secondary);
      CellFootprint list;
      const int u = static_cast<int>(random() % static_cast<unsigned>(rig.principal.width_px));
      const int v = static_cast<int>(random() % static_cast<unsigned>(rig.principal.height_px));
      projector.set_ray(u, v);
      const int first = static_cast<int>(random() % static_cast<unsigned>(grid.count()));
      // Two cells one after the other: the second reuses the face between them.
      for (int n = first; n < std::min(first + 2, grid.count()); ++n) {
        const bool involved = projector.project(grid.boundary_m(n), grid.boundary_m(n + 1), list);
        check_cell(rig, secondary, u, v, grid.boundary_m(n), grid.boundary_m(n + 1), list, involved, random, tally);
        ASSERT_FALSE(HasFatalFailure()) << "pixel (" << u << ", " << v << "), cell " << n << " of\n"
                                        << describe(rig) << "\n"
                                        << run.reproduce();
      }
    }
  }
  std::printf("samples in the image %lld, pixels inside %lld, outside %lld, cells behind %lld\n",
              static_cast<long long>(tally.samples), static_cast<long long>(tally.inside),
              static_cast<long long>(tally.outside), static_cast<long long>(tally.behind));
  if (run.count >= 1000) {
    EXPECT_GT(tally.samples, 10000);
    EXPECT_GT(tally.inside, 5000);
    EXPECT_GT(tally.behind, 100);
  }
}

TEST(MapFootprint, IncludeReachesBeyondTheRows) {
  CellFootprint list;
  list.include(5, 7);
  list.include(3, 5);
  list.include(9, 8);
  EXPECT_EQ(list.v_first_px, 5);
  ASSERT_EQ(list.rows.size(), 4U);
  EXPECT_TRUE(contains(list, 5, 7));
  EXPECT_TRUE(contains(list, 3, 5));
  EXPECT_TRUE(contains(list, 9, 8));
}

}  // namespace
}  // namespace depthgrid::grid
