#include "depthgrid/search/octree_search.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "depthgrid/core/rounding.hpp"
#include "depthgrid/search/ball_query.hpp"
#include "depthgrid/search/blocking_point.hpp"

namespace depthgrid::search {
namespace {

constexpr double kSqrt3 = 1.7320508075688772;
/// How finely the border of a frustum W is resolved: the nearest point may lie this far outside of W.
constexpr double kBorderResolution = 0.5e-3;
/// Primitives this near to each other share an origin, metres. Single precision resolves a micrometre there.
constexpr double kSharedExtent = 4.0;
/// How the cameras' pose error grows with range, as far as leaves follow it.
constexpr double kLargestRate = 3.2;

}  // namespace

OctreeSearch::OctreeSearch(const views::Snapshot& snapshot, CubeQuery& query, Frontier& frontier, Count& count) noexcept
    : snapshot_(snapshot), settings_(snapshot.settings()), query_(query), frontier_(frontier), count_(count) {
  query_.camera_count = snapshot.camera_count();
  for (std::size_t k = 0; k < views::kMaxCameras; ++k) {
    query_.order[k] = static_cast<std::uint8_t>(k);
  }
  query_.uncovered_ignored = settings_.policies.unobserved == views::Policy::ignored;
  query_.slack_m = float_below(settings_.resolution_m - 1e-5);
  least_pose_error_m_ = 1e30;
  for (std::size_t k = 0; k < query_.camera_count; ++k) {
    const PoseMargin& e = snapshot.pose_margin(k);
    const double pose_error_m = e.translation_m + e.time_m;
    least_pose_error_m_ = std::min(least_pose_error_m_, pose_error_m);
    largest_rate_ = std::max(largest_rate_, e.rotation_rad);
  }
  // The last word on a leaf is a ball's: one that is known free to no camera has not known free space within its
  // diagonal and pose error of each of its points. e_k varies by less than rate * diagonal within a cube. With a rate
  // of half a turn and more a camera frees nothing anyway: no reason for ever smaller leaves.
  const double leaf_diagonal_m = (settings_.resolution_m - 2e-5) / (1 + std::min(largest_rate_, kLargestRate));
  leaf_half_m_ = leaf_diagonal_m / (2 * kSqrt3);
}

void OctreeSearch::set_origin(const Eigen::Vector3d& origin_world, double extent_m) noexcept {
  origin_world_ = origin_world;
  extent_m_ = extent_m;
  for (std::size_t k = 0; k < query_.camera_count; ++k) {
    make_local(snapshot_, k, origin_world, extent_m, query_.cameras[k]);
  }
}

void OctreeSearch::aim(const Eigen::Vector3d& middle_world, double extent_m) noexcept {
  // The root reaches at most four times the extent to one side.
  if (!((middle_world - origin_world_).cwiseAbs().maxCoeff() + 4 * extent_m <= extent_m_)) {
    set_origin(middle_world, kSharedExtent + 4 * extent_m);
  }
  axis_count_ = 0;
  // The root's side is the leaf's times a power of two. The middle lies at a third of it along each axis, and so at a
  // third or two thirds of every cube that holds it: never near the faces, where eight cubes of each level would meet.
  double root_half_m = leaf_half_m_;
  leaf_level_ = 0;
  while (2 * root_half_m < 3 * extent_m) {
    root_half_m *= 2;
    ++leaf_level_;
  }
  // The root has to hold everything of interest; leaves may be coarser.
  leaf_level_ = std::min(leaf_level_, static_cast<int>(kLevels) - 12);
  const Eigen::Vector3d root = middle_world - origin_world_ + Eigen::Vector3d::Constant(root_half_m / 3);
  root_ = {static_cast<float>(root.x()), static_cast<float>(root.y()), static_cast<float>(root.z()), 0.0F, 0, 0};
  double half_m = root_half_m;
  for (float& half : half_m_) {
    half = static_cast<float>(half_m);
    half_m *= 0.5;
  }
  last_level_ = leaf_level_;
  while (2 * kSqrt3 * static_cast<double>(half_side_m(last_level_)) > kBorderResolution &&
         last_level_ + 1 < static_cast<int>(kLevels)) {
    ++last_level_;
  }
  exact_level_ = leaf_level_;
  while (exact_level_ > 0 && static_cast<double>(half_side_m(exact_level_ - 1)) <= least_pose_error_m_) {
    --exact_level_;
  }

  query_.boxed = false;
  query_.principal = -1;
  if (const auto* box = std::get_if<views::BoxSpace>(&settings_.space)) {
    space_low_ = box->low_world - origin_world_;
    space_high_ = box->high_world - origin_world_;
    const Eigen::Vector3d middle = middle_world - origin_world_;
    query_.boxed =
        ((space_low_ - middle).array() > -extent_m).any() || ((space_high_ - middle).array() < extent_m).any();
    for (std::size_t i = 0; i < 3; ++i) {
      query_.box_low[i] = float_below(space_low_[static_cast<Eigen::Index>(i)]);
      query_.box_high[i] = float_above(space_high_[static_cast<Eigen::Index>(i)]);
    }
  } else {
    const auto& frustum = std::get<views::FrustumSpace>(settings_.space);
    query_.principal = static_cast<int>(frustum.principal);
    query_.d_min_m = float_below(frustum.d_min_m);
    query_.d_max_m = float_above(frustum.d_max_m);
  }
}

OctreeSearch::Box OctreeSearch::box_of(const Cube& cube) const noexcept {
  const Eigen::Vector3d centre(static_cast<double>(cube.x), static_cast<double>(cube.y), static_cast<double>(cube.z));
  const auto half_m = Eigen::Vector3d::Constant(static_cast<double>(half_side_m(cube.level)));
  Box box{centre - half_m, centre + half_m};
  if (query_.boxed) {
    box.low = box.low.cwiseMax(space_low_).cwiseMin(space_high_);
    box.high = box.high.cwiseMin(space_high_).cwiseMax(space_low_);
  }
  return box;
}

bool OctreeSearch::in_space(const Eigen::Vector3d& x_local) const noexcept {
  if (query_.principal < 0) {
    return true;  // boxes are cut to W
  }
  const LocalCamera& camera = query_.cameras[static_cast<std::size_t>(query_.principal)];
  const auto& frustum = std::get<views::FrustumSpace>(settings_.space);
  const Eigen::Vector3d x = camera.to_camera(x_local);
  return x.z() > 0 && x.z() >= frustum.d_min_m && x.z() <= frustum.d_max_m && projects_inside(camera.pinhole, x);
}

/// Every camera has x in its not known free set, or nearly so along the ray, and x counts.
bool OctreeSearch::is_blocked(const Eigen::Vector3d& x_local, double slack_m) const noexcept {
  bool covered = !query_.uncovered_ignored;
  for (std::size_t n = 0; n < query_.camera_count; ++n) {
    const LocalCamera& camera = query_.cameras[query_.order[n]];
    if (!blocks(camera, x_local, slack_m)) {
      return false;
    }
    if (!covered) {
      const Eigen::Vector3d x = camera.to_camera(x_local);
      covered = x.z() > camera.near_m && projects_inside(camera.pinhole, x);
    }
  }
  return covered && in_space(x_local);
}

/// The ball around the cube with all its pose error is known free to some camera; or all that is covered of it is.
bool OctreeSearch::is_free(const Cube& cube) noexcept {
  const Box box = box_of(cube);
  const Eigen::Vector3d centre = 0.5 * (box.low + box.high);
  const double half_diagonal_m = 0.5 * (box.high - box.low).norm() + 1e-7;
  bool uncovered = query_.uncovered_ignored;
  for (std::size_t n = 0; n < query_.camera_count; ++n) {
    const LocalCamera& camera = query_.cameras[query_.order[n]];
    const Eigen::Vector3d c = camera.to_camera(centre);
    const double pose_error_m = camera.has_pose_error ? camera.pose_error(c) + largest_rate_ * half_diagonal_m : 0.0;
    // Most balls that meet not known free space do so in one of the pixels nearest to their centre.
    if (camera.space.to_view || !blocks(camera, centre, half_diagonal_m)) {
      ++count_.ball_tests;
      if (!meets_not_known_free(camera, camera.space, c, half_diagonal_m + pose_error_m)) {
        return true;
      }
    }
    uncovered =
        uncovered && (camera.has_pose_error ? !covers_some(camera, c, half_diagonal_m)
                                            : !meets_not_known_free(camera, camera.coverage, c, half_diagonal_m));
  }
  return uncovered;
}

bool OctreeSearch::is_leaf(const Cube& cube, const LocalAxis& axis) const noexcept {
  if (cube.level < leaf_level_) {
    return false;
  }
  if (cube.level >= last_level_ || query_.principal < 0) {
    return true;
  }
  const Box box = box_of(cube);
  return in_space(nearest(axis.a, axis.b, box.low, box.high).in_box);
}

/// The cube's distance from the axis, and the point at that distance towards the cube's centre. Nothing in the cube is
/// nearer, so an answer may point there instead of to the cube's nearest corner, which is farther from what is in it.
AxisToBox OctreeSearch::towards_centre(const Cube& cube, const LocalAxis& axis) const noexcept {
  const Box box = box_of(cube);
  const double distance_m = nearest(axis.a, axis.b, box.low, box.high).distance_m;
  const Eigen::Vector3d centre = 0.5 * (box.low + box.high);
  AxisToBox result = nearest(axis.a, axis.b, centre, centre);
  const double share = result.distance_m > 0 ? distance_m / result.distance_m : 0.0;
  result.in_box = result.on_axis + share * (centre - result.on_axis);
  result.distance_m = distance_m;
  return result;
}

std::size_t OctreeSearch::add(const Capsule& primitive, double limit_m) noexcept {
  const std::size_t i = axis_count_++;
  axes_[i] = {primitive.a - origin_world_, primitive.b - origin_world_, primitive.radius_m};
  found_[i] = Nearest{};
  found_[i].limit_m = limit_m;
  found_[i].distance_m = limit_m;
  const Eigen::Vector3d along = axes_[i].b - axes_[i].a;
  const double square = along.squaredNorm();
  Axis& axis = query_.axes[i];
  for (std::size_t k = 0; k < 3; ++k) {
    axis.a[k] = static_cast<float>(axes_[i].a[static_cast<Eigen::Index>(k)]);
    axis.along[k] = static_cast<float>(along[static_cast<Eigen::Index>(k)]);
  }
  axis.inverse_square = square > 1e-12 ? static_cast<float>(1 / square) : 0.0F;
  set_bound(i, limit_m);
  return i;
}

/// Cubes have to be nearer than this, a little more because of single precision.
void OctreeSearch::set_bound(std::size_t i, double bound_m) noexcept {
  constexpr double kRoundings = 8 * 0x1p-24;
  query_.axes[i].bound_m = bound_m > 0 ? float_above(bound_m + 1e-6 + kRoundings * extent_m_) : 0.0F;
}

bool OctreeSearch::is_of_interest(const Cube& cube) const noexcept {
  for (std::uint32_t rest = cube.primitives; rest != 0; rest &= rest - 1) {
    if (cube.distance_m < query_.axes[static_cast<std::size_t>(std::countr_zero(rest))].bound_m) {
      return true;
    }
  }
  return false;
}

std::uint32_t OctreeSearch::all_primitives() const noexcept {
  return axis_count_ >= kGroup ? ~0U : (1U << axis_count_) - 1U;
}

/// A place becomes the answer of a primitive if it is nearer than what was found before.
void OctreeSearch::offer(const AxisToBox& pair, std::size_t i) noexcept {
  Nearest& best = found_[i];
  if (pair.distance_m < best.distance_m) {
    best = {best.limit_m, pair.distance_m, true, false, pair.on_axis, pair.in_box};
    set_bound(i, pair.distance_m <= axes_[i].radius_m ? 0.0 : pair.distance_m);
  }
}

/// What is not looked at bounds the answers.
void OctreeSearch::stop(std::uint32_t primitives, double at_m) noexcept {
  for (std::uint32_t rest = primitives; rest != 0; rest &= rest - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(rest));
    Nearest& best = found_[i];
    if (at_m < best.distance_m && query_.axes[i].bound_m > 0) {
      best.stopped = true;
      best.distance_m = at_m;
    }
  }
}

/// Opens what split() has left over, or makes it the answer.
void OctreeSearch::take(Children& children) noexcept {
  for (int n = 0; n < children.count; ++n) {
    Cube& child = children.cubes[static_cast<std::size_t>(n)];
    if (!is_of_interest(child)) {
      continue;
    }
    for (std::uint32_t rest = children.tight_witness[static_cast<std::size_t>(n)]; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(rest));
      const AxisToBox pair = towards_centre(child, axes_[i]);
      if (is_blocked(pair.in_box, settings_.resolution_m - 1e-5)) {
        offer(pair, i);
        child.primitives &= ~(1U << i);
      }
    }
    if (child.primitives == 0 || (child.level >= exact_level_ && is_free(child))) {
      continue;
    }
    if (child.level >= leaf_level_) {
      for (std::uint32_t rest = child.primitives; rest != 0; rest &= rest - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(rest));
        if (is_leaf(child, axes_[i])) {
          const Box box = box_of(child);
          offer(nearest(axes_[i].a, axes_[i].b, box.low, box.high), i);
          child.primitives &= ~(1U << i);
        }
      }
    }
    if (child.primitives != 0 && !frontier_.push(child)) {
      stop(child.primitives, std::max(0.0, static_cast<double>(child.distance_m) - 1e-6));
    }
  }
}

void OctreeSearch::find(RemainingBudget& budget) noexcept {
  double largest_m = 0;
  for (std::size_t i = 0; i < axis_count_; ++i) {
    largest_m = std::max(largest_m, found_[i].limit_m);
    const Eigen::Vector3d middle = 0.5 * (axes_[i].a + axes_[i].b);
    if (is_blocked(middle, settings_.resolution_m - 1e-5)) {
      offer({middle, middle, 0.0}, i);
    }
  }
  frontier_.reset(static_cast<float>(largest_m));
  root_.primitives = all_primitives();
  static_cast<void>(frontier_.push(root_));
  std::array<Cube, 2> pair{};
  Cube& cube = pair[0];
  Children children;
  while (frontier_.pop(cube)) {
    if (!is_of_interest(cube)) {
      continue;
    }
    if (budget.is_spent()) {
      stop(all_primitives(), std::max(0.0, static_cast<double>(frontier_.lower_bound_m()) - 1e-6));
      return;
    }
    const int count = budget.nodes() > 1 && frontier_.pop_like(cube.level, pair[1]) ? 2 : 1;
    budget.take(count);
    count_.nodes += count;
    split(query_, pair.data(), count, half_side_m(cube.level + 1), children);
    take(children);
  }
}

}  // namespace depthgrid::search
