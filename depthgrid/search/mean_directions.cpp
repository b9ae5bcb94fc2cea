// The part of the octree search that looks at all obstacles within rho, not only at the nearest.
#include <algorithm>
#include <bit>
#include <cmath>

#include "depthgrid/search/octree_search.hpp"

namespace depthgrid::search {
namespace {

/// Half side over distance at which a cube counts as one piece of the mean direction.
constexpr double kFineness = 1.0 / 6;

}  // namespace

/// Adds a cube to the means of the primitives for which it is fine enough to count as its centre does. Returns these.
std::uint32_t OctreeSearch::add_piece(const Cube& cube, std::span<Eigen::Vector3d> means,
                                      std::array<double, kGroup>& total) const noexcept {
  const auto half_m = static_cast<double>(half_side_m(cube.level));
  const double least_half_m = settings_.rho_m / 32;
  const Box box = box_of(cube);
  const Eigen::Vector3d centre = 0.5 * (box.low + box.high);
  const bool counts = is_blocked(centre, 0);
  std::uint32_t fine = 0;
  for (std::uint32_t rest = cube.primitives; rest != 0; rest &= rest - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(rest));
    const AxisToBox pair = nearest(axes_[i].a, axes_[i].b, centre, centre);
    if (half_m > std::max(least_half_m, kFineness * pair.distance_m)) {
      continue;
    }
    fine |= 1U << i;
    const double distance_m = pair.distance_m - axes_[i].radius_m;
    if (counts && distance_m < settings_.rho_m && pair.distance_m > 0) {
      const double weight = (box.high - box.low).prod() /
                            inverse_repulsion(std::max(distance_m, 0.0), settings_.rho_m, settings_.repulsion_alpha);
      means[i] += weight / pair.distance_m * (centre - pair.on_axis);
      total[i] += weight;
    }
  }
  return fine;
}

void OctreeSearch::find_mean_directions(std::uint32_t wanted, std::span<Eigen::Vector3d> means,
                                        RemainingBudget& budget) noexcept {
  double largest_m = 0;
  std::array<double, kGroup> total{};
  for (std::size_t i = 0; i < axis_count_; ++i) {
    means[i].setZero();
    set_bound(i, settings_.rho_m + axes_[i].radius_m);
    largest_m = std::max(largest_m, settings_.rho_m + axes_[i].radius_m);
  }
  frontier_.reset(static_cast<float>(largest_m));
  root_.primitives = wanted;
  if (wanted != 0) {
    static_cast<void>(frontier_.push(root_));
  }
  Cube cube{};
  Children children;
  while (frontier_.pop(cube) && !budget.is_spent()) {
    budget.take(1);
    ++count_.nodes;
    split(query_, &cube, 1, half_side_m(cube.level + 1), children);
    for (int n = 0; n < children.count; ++n) {
      Cube child = children.cubes[static_cast<std::size_t>(n)];
      const std::uint32_t fine = add_piece(child, means, total);
      child.primitives &= ~fine;
      if (child.primitives != 0) {
        static_cast<void>(frontier_.push(child));  // without room the direction is only coarser
      }
    }
  }
  for (std::size_t i = 0; i < axis_count_; ++i) {
    means[i] /= total[i] > 0 ? total[i] : 1.0;
  }
}

}  // namespace depthgrid::search
