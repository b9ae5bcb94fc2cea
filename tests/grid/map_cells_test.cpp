// The storages of the depth grid map against each other, cell by cell.
//
// Where they must agree: one pixel a cell and the closed form, bit for bit, everywhere. The full list and the closed
// form wherever the cell's centre projects into the image from in front of the camera: the list then holds that pixel,
// its d_start is the same but for rounding, and it confirms whatever the closed form confirms.
// Where they need not: a cell whose centre projects outside the image but a part of it inside has a list and no pixel.
// A cell that reaches behind the camera has neither. Both kinds must occur here, or the test proves little.
#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

#include "depthgrid/grid/map/map_builder.hpp"
#include "grid/map_rigs.hpp"
#include "support/random_run.hpp"

namespace depthgrid::grid {
namespace {

struct Tally {
  std::int64_t cells = 0;
  std::int64_t both = 0;
  std::int64_t list_only = 0;
  std::int64_t behind = 0;
  std::int64_t confirmed_by_list_only = 0;
};

bool contains(const PixelListMap::List& list, int u_px, int v_px) {
  const int row = v_px - list.v_first_px;
  if (row < 0 || row >= static_cast<int>(list.rows.size())) {
    return false;
  }
  const PixelListMap::RowSpan& span = list.rows[static_cast<std::size_t>(row)];
  return u_px >= span.u_first_px && u_px <= span.u_last_px;
}

bool same_bits(const CellPixel& a, const CellPixel& b) {
  return a.u_px == b.u_px && a.v_px == b.v_px && std::memcmp(&a.d_start_m, &b.d_start_m, sizeof(float)) == 0;
}

// Smallest depth of the cell's corners in camera k, by the definition and nothing else.
double nearest_corner_m(const MapCalibration& rig, std::size_t k, int u, int v, int n) {
  const DepthGrid grid = grid_of(rig);
  double nearest_m = std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < 8; ++corner) {
    const double depth_m = grid.boundary_m(n + (corner >> 2));
    const Eigen::Vector3d p_principal((u + (corner & 1) - rig.principal.cx_px) * depth_m / rig.principal.fx_px,
                                      (v + ((corner >> 1) & 1) - rig.principal.cy_px) * depth_m / rig.principal.fy_px,
                                      depth_m);
    nearest_m = std::min(nearest_m, (rig.secondaries[k].T_secondary_principal * p_principal).z());
  }
  return nearest_m;
}

// Four units in the last place of the largest number that enters a depth in single precision.
double rounding_m(const MapCalibration& rig, std::size_t k, int n) {
  const double slopes =
      1 + rig.principal.width_px / rig.principal.fx_px + rig.principal.height_px / rig.principal.fy_px;
  return 4 * static_cast<double>(std::numeric_limits<float>::epsilon()) *
         (slopes * grid_of(rig).boundary_m(n + 1) + rig.secondaries[k].T_secondary_principal.translation().norm());
}

void compare_cell(const MapCalibration& rig, std::size_t k, int u, int v, int n, const ClosedFormMap::Ray& closed_form,
                  const OnePixelMap::Ray& one_pixel, const PixelListMap::Ray& lists, const float* depth_m,
                  Tally& tally) {
  CellPixel computed;
  CellPixel stored;
  PixelListMap::List list;
  const bool has_pixel = closed_form.pixel(n, computed);
  const bool has_list = lists.pixels(n, list);
  ++tally.cells;

  ASSERT_EQ(one_pixel.pixel(n, stored), has_pixel);
  if (has_pixel) {
    ASSERT_TRUE(same_bits(computed, stored)) << stored.u_px << " " << stored.v_px << " " << stored.d_start_m;
  }
  ASSERT_EQ(one_pixel.confirm(n, depth_m), closed_form.confirm(n, depth_m));

  const double nearest_m = nearest_corner_m(rig, k, u, v, n);
  const double rounding = rounding_m(rig, k, n);
  if (has_pixel) {
    ++tally.both;
    ASSERT_TRUE(has_list);
    ASSERT_TRUE(contains(list, computed.u_px, computed.v_px)) << computed.u_px << " " << computed.v_px;
    ASSERT_GE(list.d_start_m, computed.d_start_m);
    ASSERT_NEAR(computed.d_start_m, nearest_m, rounding);
    if (closed_form.confirm(n, depth_m) == Confirmation::confirmed) {
      ASSERT_EQ(lists.confirm(n, depth_m), Confirmation::confirmed);
    } else if (lists.confirm(n, depth_m) == Confirmation::confirmed) {
      ++tally.confirmed_by_list_only;
    }
  }
  if (has_list) {
    tally.list_only += has_pixel ? 0 : 1;
    ASSERT_NEAR(list.d_start_m, nearest_m, rounding);
  } else {
    ASSERT_EQ(lists.confirm(n, depth_m), Confirmation::not_involved);
  }
  if (nearest_m < -rounding) {
    ++tally.behind;
    ASSERT_FALSE(has_pixel);
    ASSERT_FALSE(has_list);
  }
}

TEST(MapCells, StoragesAgreeCellByCell) {
  const test::RandomRun run = test::random_run(300);
  Tally tally;
  for (std::int64_t i = 0; i < run.count; ++i) {
    const std::uint64_t seed = run.seed * 1000003 + static_cast<std::uint64_t>(i);
    const MapCalibration rig = random_map_rig(seed);
    const DepthGrid grid = grid_of(rig);
    const ClosedFormMap closed_form(grid, rig.secondaries);
    const OnePixelMap one_pixel = build_one_pixel_map(grid, rig.secondaries);
    const PixelListMap lists = build_pixel_list_map(grid, rig.secondaries);
    std::mt19937_64 random(seed);
    for (std::size_t k = 0; k < rig.secondaries.size(); ++k) {
      const PinholeCamera& camera = rig.secondaries[k].camera;
      std::vector<float> depth_m(static_cast<std::size_t>(camera.width_px * camera.height_px));
      for (float& d : depth_m) {
        d = random() % 8 == 0 ? 0.0F : std::uniform_real_distribution<float>(0.1F, 4.0F)(random);
      }
      for (int v = 0; v < rig.principal.height_px; ++v) {
        for (int u = 0; u < rig.principal.width_px; ++u) {
          for (int n = 0; n < grid.count(); ++n) {
            compare_cell(rig, k, u, v, n, closed_form.ray(u, v, k), one_pixel.ray(u, v, k), lists.ray(u, v, k),
                         depth_m.data(), tally);
            ASSERT_FALSE(HasFatalFailure())
                << "camera " << k << ", pixel (" << u << ", " << v << "), cell " << n << " of\n"
                << describe(rig) << "\n"
                << run.reproduce();
          }
        }
      }
    }
  }
  RecordProperty("cells", std::to_string(tally.cells));
  std::printf("cells %lld: pixel and list %lld, list only %lld, behind %lld, confirmed by the list only %lld\n",
              static_cast<long long>(tally.cells), static_cast<long long>(tally.both),
              static_cast<long long>(tally.list_only), static_cast<long long>(tally.behind),
              static_cast<long long>(tally.confirmed_by_list_only));
  if (run.count >= 100) {
    EXPECT_GT(tally.both, tally.cells / 20);
    EXPECT_GT(tally.list_only, 100);
    EXPECT_GT(tally.behind, 100);
    EXPECT_GT(tally.confirmed_by_list_only, 100);
  }
}

TEST(MapCells, CentreOutsidePartInside) {
  // A secondary camera in the principal's place whose image ends just before the middle of the cell.
  const PinholeCamera principal{3, 1, 3, 3, 1.5, 0.5};
  const DepthGrid grid(principal, {1.0, 0.5, 0.0, 2});
  PinholeCamera narrow = principal;
  narrow.cx_px = 0.1;
  narrow.width_px = 1;  // the middle pixel's centre projects to 0.1 exactly, its left part below 0
  const std::vector<SecondaryCamera> secondaries{{narrow, Pose::Identity()}};
  CellPixel pixel;
  PixelListMap::List list;
  const ClosedFormMap closed_form(grid, secondaries);
  const PixelListMap lists = build_pixel_list_map(grid, secondaries);
  EXPECT_TRUE(closed_form.ray(1, 0, 0).pixel(0, pixel));
  EXPECT_TRUE(lists.ray(1, 0, 0).pixels(0, list));
  EXPECT_FALSE(closed_form.ray(2, 0, 0).pixel(0, pixel)) << "the centre projects to 1.1, outside";
  EXPECT_TRUE(lists.ray(2, 0, 0).pixels(0, list)) << "0.6 to 1.6: a part is inside";
  EXPECT_FALSE(lists.ray(0, 0, 0).pixels(0, list)) << "-1.4 to -0.4";
}

}  // namespace
}  // namespace depthgrid::grid
