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
/// The clock is read once in so many cubes.
constexpr int kClockInterval = 64;

float rounded_down(double value) noexcept { return std::nextafter(static_cast<float>(value), -1e30F); }
float rounded_up(double value) noexcept { return std::nextafter(static_cast<float>(value), 1e30F); }

}  // namespace

void Descent::aim(const Primitive& primitive, double reach_m) noexcept {
  primitive_ = primitive;
  origin_world_ = 0.5 * (primitive.a_world + primitive.b_world);
  a_local_ = primitive.a_world - origin_world_;
  b_local_ = primitive.b_world - origin_world_;
  const Eigen::Vector3d along = b_local_ - a_local_;
  const double square = along.squaredNorm();
  for (int i = 0; i < 3; ++i) {
    query_.axis_a[i] = static_cast<float>(a_local_(i));
    query_.axis_along[i] = static_cast<float>(along(i));
  }
  query_.inverse_square = square > 1e-12 ? static_cast<float>(1 / square) : 0.0F;

  const double half_m = a_local_.cwiseAbs().maxCoeff() + reach_m;
  double largest_rate = 0;
  double least_reach_m = 1e30;
  query_.camera_count = snapshot_.camera_count();
  for (std::size_t k = 0; k < query_.camera_count; ++k) {
    make_local(snapshot_, k, origin_world_, half_m, query_.cameras[k]);
    largest_rate = std::max(largest_rate, query_.cameras[k].pose_margin.rotation_rad);
    const LocalCamera& camera = query_.cameras[k];
    least_reach_m = std::min(least_reach_m, camera.has_reach ? static_cast<double>(camera.reach_m) : 0.0);
  }
  // e_k varies by less than rate * diagonal within a cube.
  const double leaf_diagonal_m = (settings_.resolution_m - 2e-6) / (1 + largest_rate);
  double half = half_m;
  leaf_level_ = -1;
  last_level_ = -1;
  for (std::size_t level = 0; level < kLevels; ++level, half *= 0.5) {
    half_m_[level] = static_cast<float>(half);
    if (leaf_level_ < 0 && 2 * kSqrt3 * half <= leaf_diagonal_m) {
      leaf_level_ = static_cast<int>(level);
    }
    if (leaf_level_ >= 0 && last_level_ < 0 && 2 * kSqrt3 * half <= std::min(leaf_diagonal_m, kBorderResolution)) {
      last_level_ = static_cast<int>(level);
    }
  }
  exact_below_m_ = static_cast<float>(least_reach_m);

  query_.boxed = false;
  query_.principal = -1;
  query_.uncovered_ignored = settings_.policies.unobserved == Policy::ignored;
  if (const auto* box = std::get_if<BoxSpace>(&settings_.space)) {
    space_low_ = box->low_world - origin_world_;
    space_high_ = box->high_world - origin_world_;
    query_.boxed = (space_low_.array() > -half_m).any() || (space_high_.array() < half_m).any();
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

bool Descent::blocks(const LocalCamera& camera, const Eigen::Vector3d& x_local, double slack_m) const noexcept {
  const Eigen::Vector3d x = camera.to_camera(x_local);
  if (!(x.z() > camera.near_m)) {
    return true;
  }
  const DepthPoint pixel = project(camera.pinhole, x);
  if (!(pixel.x_px >= 0 && pixel.y_px >= 0 && pixel.x_px < camera.pinhole.width_px &&
        pixel.y_px < camera.pinhole.height_px)) {
    return true;
  }
  const auto u = static_cast<int>(pixel.x_px);
  const auto v = static_cast<int>(pixel.y_px);
  const auto free_m = static_cast<double>(camera.view->free_m().at(u, v));
  if (x.z() >= free_m) {
    // In the robot's island it is the robot.
    return !camera.has_islands || !(x.z() >= static_cast<double>(camera.view->island_near_m().at(u, v)) &&
                                    x.z() <= static_cast<double>(camera.view->island_far_m().at(u, v)));
  }
  // Along the ray the obstacle begins at free_m.
  const double slack_along_m = slack_m + (camera.has_reach ? camera.reach(x) : 0.0);
  const double gap_m = free_m - x.z();
  return gap_m < slack_along_m && gap_m * x.norm() <= slack_along_m * x.z();
}

bool Descent::in_space(const Eigen::Vector3d& x_local) const noexcept {
  if (query_.principal < 0) {
    return true;  // boxes are cut to W
  }
  const LocalCamera& camera = query_.cameras[static_cast<std::size_t>(query_.principal)];
  const auto& frustum = std::get<FrustumSpace>(settings_.space);
  const Eigen::Vector3d x = camera.to_camera(x_local);
  if (!(x.z() > 0 && x.z() >= frustum.d_min_m && x.z() <= frustum.d_max_m)) {
    return false;
  }
  const DepthPoint pixel = project(camera.pinhole, x);
  return pixel.x_px >= 0 && pixel.y_px >= 0 && pixel.x_px < camera.pinhole.width_px &&
         pixel.y_px < camera.pinhole.height_px;
}

bool Descent::is_blocked(const Eigen::Vector3d& x_local, double slack_m) noexcept {
  bool covered = !query_.uncovered_ignored;
  for (std::size_t n = 0; n < query_.camera_count; ++n) {
    const LocalCamera& camera = query_.cameras[query_.order[n]];
    if (!blocks(camera, x_local, slack_m)) {
      return false;
    }
    if (!covered) {
      const Eigen::Vector3d x = camera.to_camera(x_local);
      const DepthPoint pixel = project(camera.pinhole, x);
      covered = x.z() > camera.near_m && pixel.x_px >= 0 && pixel.y_px >= 0 &&
                pixel.x_px < camera.pinhole.width_px && pixel.y_px < camera.pinhole.height_px;
    }
  }
  return covered && in_space(x_local);
}

/// Some camera frees the ball around the box with all its reach; or what is covered of the ball is free everywhere.
bool Descent::is_free(const Box& box) noexcept {
  const Eigen::Vector3d centre = box.centre();
  const double half_diagonal_m = 0.5 * (box.high - box.low).norm() + 1e-9;
  bool uncovered = query_.uncovered_ignored;
  for (std::size_t n = 0; n < query_.camera_count; ++n) {
    const LocalCamera& camera = query_.cameras[query_.order[n]];
    const Eigen::Vector3d c = camera.to_camera(centre);
    const double reach_m =
        camera.has_reach ? camera.reach(c) + camera.pose_margin.rotation_rad * half_diagonal_m + 1e-9 : 0.0;
    ++count_.ball_tests;
    if (!meets_not_free(camera, camera.space, c, half_diagonal_m + reach_m)) {
      return true;
    }
    if (uncovered) {
      uncovered = camera.has_reach ? false : !meets_not_free(camera, camera.coverage, c, half_diagonal_m);
    }
  }
  return uncovered;
}

Descent::Verdict Descent::judge(const Cube& cube, const Box& box, const Eigen::Vector3d& nearest_local) noexcept {
  if (is_blocked(nearest_local, settings_.resolution_m - 1e-5)) {
    return Verdict::obstacle;
  }
  const bool leaf = cube.level >= leaf_level_;
  if (!leaf && !(half_side_m(cube.level) <= exact_below_m_)) {
    return Verdict::undecided;
  }
  if (is_free(box)) {
    return Verdict::free;
  }
  return leaf && (cube.level >= last_level_ || in_space(nearest_local)) ? Verdict::obstacle : Verdict::undecided;
}

Nearest Descent::find(double limit_m, Allowance& allowance) noexcept {
  Nearest result;
  result.distance_m = limit_m;
  frontier_.reset(static_cast<float>(limit_m));
  static_cast<void>(frontier_.push(root()));
  Cube cube{};
  Children children;
  int until_clock = kClockInterval;
  while (frontier_.pop(cube)) {
    if (static_cast<double>(cube.distance_m) >= result.distance_m) {
      continue;
    }
    const bool late = allowance.timed && --until_clock == 0 && std::chrono::steady_clock::now() >= allowance.deadline;
    if (late || allowance.nodes <= 0) {
      result.stopped = true;
      result.distance_m = std::min(result.distance_m, static_cast<double>(frontier_.lower_bound_m()));
      return result;
    }
    until_clock = until_clock == 0 ? kClockInterval : until_clock;
    --allowance.nodes;
    ++count_.nodes;
    const Box box = box_of(cube);
    const AxisToBox nearest_pair = nearest(a_local_, b_local_, box.low, box.high);
    const Verdict verdict = judge(cube, box, nearest_pair.in_box);
    if (verdict == Verdict::obstacle) {
      if (nearest_pair.distance_m < result.distance_m) {
        result = {nearest_pair.distance_m, true, false, nearest_pair.on_axis, nearest_pair.in_box};
        if (result.distance_m <= primitive_.radius_m) {
          return result;
        }
      }
      continue;
    }
    if (verdict == Verdict::free) {
      continue;
    }
    split(query_, cube, half_side_m(cube.level + 1), rounded_up(result.distance_m), children);
    for (int i = 0; i < children.count; ++i) {
      const Cube& child = children.cubes[static_cast<std::size_t>(i)];
      if (!frontier_.push(child)) {
        // No room: what is not looked at bounds the answer.
        result.stopped = true;
        result.distance_m = std::min(result.distance_m, static_cast<double>(child.distance_m));
      }
    }
  }
  return result;
}

}  // namespace depthgrid::search
