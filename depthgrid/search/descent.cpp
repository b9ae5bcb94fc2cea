#include "depthgrid/search/descent.hpp"

#include <algorithm>
#include <cmath>

#include "depthgrid/search/axis_distance.hpp"
#include "depthgrid/search/ball_test.hpp"

namespace depthgrid::search {
namespace {

constexpr double kSqrt3 = 1.7320508075688772;
/// How finely the border of a frustum W is resolved: the nearest point may lie this far outside of W.
constexpr double kBorderResolution = 0.5e-3;
/// Half side over distance at which a cube counts as one piece of the mean direction.
constexpr double kFineness = 1.0 / 6;
/// The clock is read once in so many cubes.
constexpr int kClockInterval = 64;
/// Primitives this near to each other share an origin, metres. Single precision resolves a micrometre there.
constexpr double kSharedExtent = 4.0;

float rounded_down(double value) noexcept { return std::nextafter(static_cast<float>(value), -1e30F); }
float rounded_up(double value) noexcept { return std::nextafter(static_cast<float>(value), 1e30F); }

bool projects_inside(const PinholeCamera& camera, const Eigen::Vector3d& x_camera) noexcept {
  const DepthPoint pixel = project(camera, x_camera);
  return pixel.x_px >= 0 && pixel.y_px >= 0 && pixel.x_px < camera.width_px && pixel.y_px < camera.height_px;
}

/// x lies in the camera's not-free set, or one of the two by two pixels nearest to x has some of it within slack and
/// reach of x.
bool blocks(const LocalCamera& camera, const Eigen::Vector3d& x_local, double slack_m) noexcept {
  const Eigen::Vector3d x = camera.to_camera(x_local);
  if (!(x.z() > camera.near_m) || !projects_inside(camera.pinhole, x)) {
    return true;
  }
  // A point of the far face of a cube around x, whose half diagonal is slack and reach, is near enough.
  const double half_m = (slack_m + (camera.has_reach ? camera.reach(x) : 0.0)) / kSqrt3;
  const double z_m = x.z() + half_m;
  const PinholeCamera& c = camera.pinhole;
  const double side_px = std::min(0.5, half_m * std::min(c.fx_px, c.fy_px) / z_m);
  const double u_px = c.fx_px * x.x() / z_m + c.cx_px;
  const double v_px = c.fy_px * x.y() / z_m + c.cy_px;
  const auto column = [&](double px) { return static_cast<int>(std::clamp(px, 0.0, c.width_px - 1.0)); };
  const auto row = [&](double px) { return static_cast<int>(std::clamp(px, 0.0, c.height_px - 1.0)); };
  const View& view = *camera.view;
  for (const int v : {row(v_px - side_px), row(v_px + side_px)}) {
    for (const int u : {column(u_px - side_px), column(u_px + side_px)}) {
      if (z_m < static_cast<double>(view.free_m().at(u, v))) {
        continue;
      }
      // In the robot's island it is the robot.
      if (!camera.has_islands || !(z_m >= static_cast<double>(view.island_near_m().at(u, v)) &&
                                   z_m <= static_cast<double>(view.island_far_m().at(u, v)))) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace

Descent::Descent(const Snapshot& snapshot, CubeQuery& query, Frontier& frontier, Count& count) noexcept
    : snapshot_(snapshot), settings_(snapshot.settings()), query_(query), frontier_(frontier), count_(count) {
  query_.camera_count = snapshot.camera_count();
  query_.uncovered_ignored = settings_.policies.unobserved == Policy::ignored;
  query_.slack_m = rounded_down(settings_.resolution_m - 1e-5);
  least_reach_m_ = 1e30;
  for (std::size_t k = 0; k < query_.camera_count; ++k) {
    const PoseMargin& e = snapshot.pose_margin(k);
    const double reach_m = e.translation_m + e.time_m;
    has_reach_ = has_reach_ || reach_m > 0 || e.rotation_rad > 0;
    least_reach_m_ = std::min(least_reach_m_, reach_m);
    largest_rate_ = std::max(largest_rate_, e.rotation_rad);
  }
  // What keeps a camera from freeing a cube lies in the cube's bounds in that camera's frame, whose diagonal is at most
  // sqrt(3) times the cube's. With reach those bounds are grown to all sides, so the last word is a ball's; e_k varies by
  // less than rate * diagonal within a cube.
  const double leaf_diagonal_m =
      has_reach_ ? (settings_.resolution_m - 2e-5) / (1 + largest_rate_) : (settings_.resolution_m - 5e-5) / kSqrt3;
  leaf_half_m_ = leaf_diagonal_m / (2 * kSqrt3);
}

void Descent::set_origin(const Eigen::Vector3d& origin_world, double extent_m) noexcept {
  origin_world_ = origin_world;
  extent_m_ = extent_m;
  for (std::size_t k = 0; k < query_.camera_count; ++k) {
    make_local(snapshot_, k, origin_world, extent_m, query_.cameras[k]);
  }
}

void Descent::aim(const Primitive& primitive, double reach_m) noexcept {
  radius_m_ = primitive.radius_m;
  const Eigen::Vector3d middle_world = 0.5 * (primitive.a_world + primitive.b_world);
  const double around_m = 0.5 * (primitive.b_world - primitive.a_world).cwiseAbs().maxCoeff() + reach_m;
  if (!((middle_world - origin_world_).cwiseAbs().maxCoeff() + 8 * around_m <= extent_m_)) {
    set_origin(middle_world, kSharedExtent + 8 * around_m);
  }
  a_local_ = primitive.a_world - origin_world_;
  b_local_ = primitive.b_world - origin_world_;
  const Eigen::Vector3d along = b_local_ - a_local_;
  const double square = along.squaredNorm();
  for (int i = 0; i < 3; ++i) {
    query_.axis_a[i] = static_cast<float>(a_local_(i));
    query_.axis_along[i] = static_cast<float>(along(i));
  }
  query_.inverse_square = square > 1e-12 ? static_cast<float>(1 / square) : 0.0F;

  // The root's side is the leaf's times a power of two. The axis' middle lies at a third of it along each axis, and so at
  // a third or two thirds of every cube that holds it: never near the faces, where eight cubes of each level would meet.
  double root_half_m = leaf_half_m_;
  leaf_level_ = 0;
  while (2 * root_half_m < 3 * around_m && leaf_level_ + 12 < static_cast<int>(kLevels)) {
    root_half_m *= 2;
    ++leaf_level_;
  }
  const Eigen::Vector3d root = middle_world - origin_world_ + Eigen::Vector3d::Constant(root_half_m / 3);
  root_ = {static_cast<float>(root.x()), static_cast<float>(root.y()), static_cast<float>(root.z()), 0.0F, 0};
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
  while (exact_level_ > 0 && static_cast<double>(half_side_m(exact_level_ - 1)) <= least_reach_m_) {
    --exact_level_;
  }

  query_.boxed = false;
  query_.principal = -1;
  if (const auto* box = std::get_if<BoxSpace>(&settings_.space)) {
    space_low_ = box->low_world - origin_world_;
    space_high_ = box->high_world - origin_world_;
    const Eigen::Vector3d middle = middle_world - origin_world_;
    query_.boxed = ((space_low_ - middle).array() > -around_m).any() || ((space_high_ - middle).array() < around_m).any();
    for (int i = 0; i < 3; ++i) {
      query_.box_low[i] = rounded_down(space_low_(i));
      query_.box_high[i] = rounded_up(space_high_(i));
    }
  } else {
    const auto& frustum = std::get<FrustumSpace>(settings_.space);
    query_.principal = static_cast<int>(frustum.principal);
    query_.d_min_m = rounded_down(frustum.d_min_m);
    query_.d_max_m = rounded_up(frustum.d_max_m);
  }
}

Descent::Box Descent::box_of(const Cube& cube) const noexcept {
  const Eigen::Vector3d centre(static_cast<double>(cube.x), static_cast<double>(cube.y), static_cast<double>(cube.z));
  const auto half_m = Eigen::Vector3d::Constant(static_cast<double>(half_side_m(cube.level)));
  Box box{centre - half_m, centre + half_m};
  if (query_.boxed) {
    box.low = box.low.cwiseMax(space_low_).cwiseMin(space_high_);
    box.high = box.high.cwiseMin(space_high_).cwiseMax(space_low_);
  }
  return box;
}

bool Descent::in_space(const Eigen::Vector3d& x_local) const noexcept {
  if (query_.principal < 0) {
    return true;  // boxes are cut to W
  }
  const LocalCamera& camera = query_.cameras[static_cast<std::size_t>(query_.principal)];
  const auto& frustum = std::get<FrustumSpace>(settings_.space);
  const Eigen::Vector3d x = camera.to_camera(x_local);
  return x.z() > 0 && x.z() >= frustum.d_min_m && x.z() <= frustum.d_max_m && projects_inside(camera.pinhole, x);
}

/// Every camera has x in its not-free set, or nearly so along the ray, and x counts.
bool Descent::is_blocked(const Eigen::Vector3d& x_local, double slack_m) const noexcept {
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

/// Some camera frees the ball around the cube with all its reach; or all that is covered of the ball is free.
bool Descent::is_free(const Cube& cube) noexcept {
  const Box box = box_of(cube);
  const Eigen::Vector3d centre = 0.5 * (box.low + box.high);
  const double half_diagonal_m = 0.5 * (box.high - box.low).norm() + 1e-7;
  bool uncovered = query_.uncovered_ignored;
  for (std::size_t n = 0; n < query_.camera_count; ++n) {
    const LocalCamera& camera = query_.cameras[query_.order[n]];
    const Eigen::Vector3d c = camera.to_camera(centre);
    const double reach_m = camera.has_reach ? camera.reach(c) + largest_rate_ * half_diagonal_m : 0.0;
    ++count_.ball_tests;
    if (!meets_not_free(camera, camera.space, c, half_diagonal_m + reach_m)) {
      return true;
    }
    uncovered = uncovered && !camera.has_reach && !meets_not_free(camera, camera.coverage, c, half_diagonal_m);
  }
  return uncovered;
}

bool Descent::is_leaf(const Cube& cube) noexcept {
  if (cube.level < leaf_level_) {
    return false;
  }
  if (cube.level >= last_level_ || query_.principal < 0) {
    return true;
  }
  const Box box = box_of(cube);
  return in_space(nearest(a_local_, b_local_, box.low, box.high).in_box);
}

/// The nearest point of the cube becomes the answer if it is nearer than what was found before.
void Descent::offer(const Cube& cube, Nearest& best) noexcept {
  const Box box = box_of(cube);
  const AxisToBox pair = nearest(a_local_, b_local_, box.low, box.high);
  if (pair.distance_m < best.distance_m) {
    best = {pair.distance_m, true, false, pair.on_axis, pair.in_box};
  }
}

/// Opens what split() has left over, or makes it the answer.
void Descent::take(const Children& children, Nearest& best) noexcept {
  for (int i = 0; i < children.count; ++i) {
    const Cube& child = children.cubes[static_cast<std::size_t>(i)];
    if (static_cast<double>(child.distance_m) >= best.distance_m) {
      continue;
    }
    if (((children.touching >> i) & 1U) != 0) {
      const Box box = box_of(child);
      const AxisToBox pair = nearest(a_local_, b_local_, box.low, box.high);
      if (is_blocked(pair.in_box, settings_.resolution_m - 1e-5)) {
        offer(child, best);
        continue;
      }
    }
    if (has_reach_ && child.level >= exact_level_ && is_free(child)) {
      continue;
    }
    if (is_leaf(child)) {
      offer(child, best);
    } else if (!frontier_.push(child)) {
      // No room: what is not looked at bounds the answer.
      best.stopped = true;
      best.distance_m = std::min(best.distance_m, static_cast<double>(child.distance_m));
    }
  }
}

Nearest Descent::find(double limit_m, Allowance& allowance) noexcept {
  Nearest best;
  best.distance_m = limit_m;
  frontier_.reset(static_cast<float>(limit_m));
  const Eigen::Vector3d middle = 0.5 * (a_local_ + b_local_);
  if (is_blocked(middle, settings_.resolution_m - 1e-5)) {
    return {0.0, true, false, middle, middle};
  }
  static_cast<void>(frontier_.push(root_));
  Cube cube{};
  Children children;
  int until_clock = kClockInterval;
  while (frontier_.pop(cube)) {
    if (static_cast<double>(cube.distance_m) >= best.distance_m) {
      continue;
    }
    if (best.distance_m <= radius_m_ && best.found) {
      break;  // it touches the primitive
    }
    bool late = allowance.nodes <= 0;
    if (allowance.timed && --until_clock == 0) {
      until_clock = kClockInterval;
      late = late || std::chrono::steady_clock::now() >= allowance.deadline;
    }
    if (late) {
      best.stopped = true;
      best.distance_m = std::min(best.distance_m, static_cast<double>(frontier_.lower_bound_m()));
      break;
    }
    --allowance.nodes;
    ++count_.nodes;
    split(query_, cube, half_side_m(cube.level + 1), rounded_up(best.distance_m), children);
    take(children, best);
  }
  return best;
}

Eigen::Vector3d Descent::mean_direction(Allowance& allowance) noexcept {
  const double limit_m = settings_.rho_m + radius_m_;
  const double least_half_m = settings_.rho_m / 32;
  frontier_.reset(static_cast<float>(limit_m));
  static_cast<void>(frontier_.push(root_));
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double total = 0;
  Cube cube{};
  Children children;
  while (frontier_.pop(cube) && allowance.nodes > 0) {
    --allowance.nodes;
    ++count_.nodes;
    split(query_, cube, half_side_m(cube.level + 1), rounded_up(limit_m), children);
    for (int i = 0; i < children.count; ++i) {
      const Cube& child = children.cubes[static_cast<std::size_t>(i)];
      const double half_m = static_cast<double>(half_side_m(child.level));
      const Box box = box_of(child);
      const Eigen::Vector3d centre = 0.5 * (box.low + box.high);
      const AxisToBox pair = nearest(a_local_, b_local_, centre, centre);
      if (half_m > std::max(least_half_m, kFineness * pair.distance_m)) {
        static_cast<void>(frontier_.push(child));  // without room the direction is only coarser
        continue;
      }
      const double distance_m = pair.distance_m - radius_m_;
      if (distance_m >= settings_.rho_m || !(pair.distance_m > 0) || !is_blocked(centre, 0)) {
        continue;
      }
      const double repulsion =
          1 / (1 + std::exp((2 * std::max(distance_m, 0.0) / settings_.rho_m - 1) * settings_.repulsion_alpha));
      const double weight = repulsion * (box.high - box.low).prod();
      sum += weight / pair.distance_m * (centre - pair.on_axis);
      total += weight;
    }
  }
  return total > 0 ? (sum / total).eval() : Eigen::Vector3d::Zero();
}

}  // namespace depthgrid::search
