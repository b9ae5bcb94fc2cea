#include "depthgrid/search/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depthgrid::search {
namespace {

constexpr double kSqrt3 = 1.7320508075688772;
/// How finely the border of a frustum W is resolved: the nearest point may lie this far outside of W.
constexpr double kBorderResolution = 0.5e-3;
/// How the cameras' pose error grows with range, as far as leaves follow it.
constexpr double kLargestRate = 3.2;
/// Binary digits of a leaf's side. Centres up to 2^18 leaves from the origin are then exact in single precision.
constexpr double kSideDigits = 64;

/// Origins are multiples of this, metres: a rounding of W's bounds moves no cube.
constexpr double kOriginStep = 0x1p-10;

/// Bounds of W, world frame.
struct Extent {
  Eigen::Vector3d low;
  Eigen::Vector3d high;
};

Extent extent_of_space(const views::Snapshot& snapshot) noexcept {
  const views::Settings& settings = snapshot.settings();
  if (const auto* box = std::get_if<views::BoxSpace>(&settings.space)) {
    return {box->low_world, box->high_world};
  }
  const auto& frustum = std::get<views::FrustumSpace>(settings.space);
  const PinholeCamera& c = snapshot.camera(frustum.principal).intrinsics;
  Extent extent{Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()),
                Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity())};
  for (const double depth_m : {frustum.d_min_m, frustum.d_max_m}) {
    for (const double x_px : {0.0, static_cast<double>(c.width_px)}) {
      for (const double y_px : {0.0, static_cast<double>(c.height_px)}) {
        const Eigen::Vector3d corner((x_px - c.cx_px) / c.fx_px * depth_m, (y_px - c.cy_px) / c.fy_px * depth_m,
                                     depth_m);
        const Eigen::Vector3d corner_world = snapshot.T_world_camera(frustum.principal) * corner;
        extent = {extent.low.cwiseMin(corner_world), extent.high.cwiseMax(corner_world)};
      }
    }
  }
  return extent;
}

double few_digits(double value) noexcept {
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  return std::ldexp(std::floor(mantissa * kSideDigits) / kSideDigits, exponent);
}

}  // namespace

Lattice::Lattice(const views::Snapshot& snapshot) noexcept {
  const Extent space = extent_of_space(snapshot);
  origin_world = (0.5 / kOriginStep * (space.low + space.high)).array().round() * kOriginStep;
  double least_pose_error_m = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < snapshot.camera_count(); ++k) {
    const PoseMargin& e = snapshot.pose_margin(k);
    least_pose_error_m = std::min(least_pose_error_m, e.translation_m + e.time_m);
    largest_rate = std::max(largest_rate, e.rotation_rad);
  }
  // The last word on a leaf is a ball's: one that is known free to no camera has not known free space within its
  // diagonal and pose error of each of its points. e_k varies by less than rate * diagonal within a cube. With a rate
  // of half a turn and more a camera frees nothing anyway: no reason for ever smaller leaves.
  const double leaf_diagonal_m = (snapshot.settings().resolution_m - 2e-5) / (1 + std::min(largest_rate, kLargestRate));
  double root_half_m = few_digits(leaf_diagonal_m / (2 * kSqrt3));
  // A little more than W, for the roundings of its bounds and its middle.
  const double space_half_m = 0.5 * (space.high - space.low).maxCoeff() + 2 * kOriginStep;
  // The smallest levels are for the border and for directions.
  while (root_half_m < space_half_m && leaf_level < static_cast<int>(kLevels) - 10) {
    root_half_m *= 2;
    ++leaf_level;
  }
  extent_m = 1.8 * root_half_m;
  for (std::size_t level = 0; level < kLevels; ++level) {
    half_m[level] = static_cast<float>(std::ldexp(root_half_m, -static_cast<int>(level)));
  }
  last_level = leaf_level;
  while (2 * kSqrt3 * static_cast<double>(half_side_m(last_level)) > kBorderResolution &&
         last_level + 1 < static_cast<int>(kLevels)) {
    ++last_level;
  }
  exact_level = leaf_level;
  while (exact_level > 1 && static_cast<double>(half_side_m(exact_level - 1)) <= least_pose_error_m) {
    --exact_level;
  }
}

}  // namespace depthgrid::search
