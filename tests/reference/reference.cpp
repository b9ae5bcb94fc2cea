#include "reference/reference.hpp"

#include <algorithm>
#include <limits>
#include <queue>

namespace depthgrid::reference {
namespace {

/// The bisection for the axis' nearest point errs by less.
constexpr double kAnswerRoundingM = 1e-9;

struct OpenBox {
  double distance_m;  ///< from the axis to O in the box: nothing in it is nearer
  bool examined;      ///< distance_m is all that the cameras can prove; else only that from the axis to the box
  WorldBox box;
};

struct Farther {
  bool operator()(const OpenBox& a, const OpenBox& b) const { return a.distance_m > b.distance_m; }
};

}  // namespace

Reference::Reference(const Problem& problem)
    : space_(problem.space), outside_(problem.outside), uncovered_(problem.uncovered), rho_m_(problem.rho_m) {
  for (const CameraInput& input : problem.cameras) {
    cameras_.emplace_back(input);
  }
}

bool Reference::in_space(const Eigen::Vector3d& p_world) const {
  if (const auto* frustum = std::get_if<FrustumSpace>(&space_)) {
    return cameras_[frustum->principal].in_view(p_world, {frustum->d_min_m, frustum->d_max_m});
  }
  const auto& box = std::get<WorldBox>(space_);
  return (p_world.array() >= box.low.array()).all() && (p_world.array() <= box.high.array()).all();
}

bool Reference::covered(const Eigen::Vector3d& p_world) const {
  return std::any_of(cameras_.begin(), cameras_.end(),
                     [&](const CameraSpace& camera) { return camera.covers(p_world); });
}

bool Reference::is_obstacle(const Eigen::Vector3d& p_world) const {
  if (!in_space(p_world)) {
    return outside_ == Policy::obstacle;
  }
  const bool blocked =
      std::all_of(cameras_.begin(), cameras_.end(), [&](const CameraSpace& camera) { return camera.blocks(p_world); });
  return blocked && (uncovered_ == Policy::obstacle || covered(p_world));
}

double Reference::nearest_possible_m(const WorldBox& box, double known_m, double enough_m,
                                     std::vector<Nearness>& cameras,
                                     std::optional<Eigen::Vector3d>& suspect_world) const {
  const auto* frustum = std::get_if<FrustumSpace>(&space_);
  suspect_world.reset();
  // What O holds of the box every single camera blocks.
  double result_m = known_m;
  for (std::size_t k = 0; k < cameras.size() && result_m < enough_m; ++k) {
    std::optional<ViewLimits> limits;
    if (frustum != nullptr && frustum->principal == k) {
      limits = ViewLimits{frustum->d_min_m, frustum->d_max_m};
    }
    const double blocked_m = cameras[k].of_blocked_m(box, limits, result_m);
    if (blocked_m > result_m) {
      result_m = blocked_m;
      suspect_world = cameras[k].suspect_world();
    }
  }
  if (result_m >= enough_m) {
    return result_m;
  }
  // Of the outside only the border counts, and that is looked at once, in distance().
  if (frustum != nullptr && cameras_[frustum->principal].outside_view(box, {frustum->d_min_m, frustum->d_max_m})) {
    return std::numeric_limits<double>::infinity();
  }
  if (uncovered_ == Policy::ignored) {
    // What counts lies in the view of some camera, and that camera blocks it.
    double covered_m = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < cameras.size() && covered_m > result_m; ++k) {
      if (!cameras_[k].covers_nothing_of(box)) {
        covered_m = std::min(covered_m, cameras[k].of_blocked_m(box, cameras_[k].view_limits(), result_m));
      }
    }
    result_m = std::max(result_m, covered_m);
  }
  return result_m;
}

Eigen::Vector3d Reference::nearest_border_point(const Eigen::Vector3d& p_world) const {
  if (const auto* frustum = std::get_if<FrustumSpace>(&space_)) {
    return cameras_[frustum->principal].nearest_border_point(p_world, {frustum->d_min_m, frustum->d_max_m});
  }
  const auto& box = std::get<WorldBox>(space_);
  Eigen::Vector3d nearest = p_world;
  double smallest_m = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    for (const double border : {box.low[axis] - 1e-12, box.high[axis] + 1e-12}) {
      if (std::abs(border - p_world[axis]) < smallest_m) {
        smallest_m = std::abs(border - p_world[axis]);
        nearest = p_world;
        nearest[axis] = border;
      }
    }
  }
  return nearest;
}

Eigen::Vector3d Reference::nearest_border_point(const Primitive& primitive) const {
  const Eigen::Vector3d at_a = nearest_border_point(primitive.a_world);
  const Eigen::Vector3d at_b = nearest_border_point(primitive.b_world);
  return (at_a - primitive.a_world).norm() <= (at_b - primitive.b_world).norm() ? at_a : at_b;
}

double Reference::distance_to_border_m(const Primitive& primitive) const {
  return std::max(0.0, axis_distance_m(primitive, nearest_border_point(primitive)) - primitive.radius_m);
}

double Reference::outside_by_m(const Eigen::Vector3d& p_world) const {
  if (const auto* box = std::get_if<WorldBox>(&space_)) {
    return std::max((box->low - p_world).maxCoeff(), (p_world - box->high).maxCoeff());
  }
  const auto& frustum = std::get<FrustumSpace>(space_);
  const CameraSpace& camera = cameras_[frustum.principal];
  const Eigen::Vector3d p = camera.to_camera(p_world);
  const auto inside_m = camera.inside_m(p);
  return std::max(
      {-*std::min_element(inside_m.begin(), inside_m.end()), frustum.d_min_m - p.z(), p.z() - frustum.d_max_m});
}

Interval Reference::distance(const Primitive& primitive, const SearchSettings& settings) const {
  Interval result;
  if (!in_space(primitive)) {
    result.point_outside = outside_ == Policy::ignored;
    if (outside_ == Policy::obstacle) {
      result.hi_m = 0.0;
      result.witness_world = in_space(primitive.a_world) ? primitive.b_world : primitive.a_world;
    }
    return result;
  }
  // Everything below measures from the axis; the radius goes off at the end.
  const double radius_m = primitive.radius_m;
  const double reported_m = rho_m_ + radius_m;
  const double cap_m = std::min(rho_m_, settings.enough_m) + radius_m;
  double hi_m = std::numeric_limits<double>::infinity();
  const auto offer = [&](const Eigen::Vector3d& candidate) {
    const double distance_m = axis_distance_m(primitive, candidate);
    if (distance_m < hi_m && distance_m <= reported_m && is_obstacle(candidate)) {
      hi_m = std::max(distance_m, radius_m);  // whatever lies in the primitive is as near as can be
      result.hi_m = hi_m - radius_m;
      result.witness_world = candidate;
    }
  };
  offer(primitive.a_world);
  offer(primitive.b_world);
  if (outside_ == Policy::obstacle) {
    offer(nearest_border_point(primitive));
  }

  WorldBox root =
      WorldBox{primitive.a_world.cwiseMin(primitive.b_world), primitive.a_world.cwiseMax(primitive.b_world)}.grown(
          cap_m);
  if (const auto* box = std::get_if<WorldBox>(&space_)) {
    root = {root.low.cwiseMax(box->low), root.high.cwiseMin(box->high)};
  }
  std::vector<Nearness> cameras;
  for (const CameraSpace& camera : cameras_) {
    cameras.emplace_back(camera, primitive, cap_m);
  }
  std::priority_queue<OpenBox, std::vector<OpenBox>, Farther> open;
  open.push({0.0, false, root});
  // Nothing nearer than this is in O unless it lies in an open box; smallest boxes that stay undecided lower it.
  double undecided_m = std::numeric_limits<double>::infinity();
  std::optional<Eigen::Vector3d> suspect_world;
  while (!open.empty()) {
    OpenBox next = open.top();
    const double lo_m = std::min(undecided_m, next.distance_m);
    if (lo_m >= std::min(hi_m, cap_m) - settings.gap_m || hi_m <= radius_m) {
      break;
    }
    if (result.boxes >= settings.box_limit) {
      result.limit_reached = true;
      break;
    }
    open.pop();
    if (!next.examined) {
      ++result.boxes;
      const double bound_m =
          nearest_possible_m(next.box, next.distance_m, std::min(hi_m, cap_m), cameras, suspect_world);
      if (bound_m >= std::min(hi_m, cap_m)) {
        continue;
      }
      if (suspect_world) {
        offer(*suspect_world);
      }
      next.examined = true;
      if (bound_m > next.distance_m) {
        next.distance_m = bound_m;
        open.push(next);
        continue;
      }
    }
    offer(next.box.nearest_to(nearest_on_axis(primitive, next.box)));
    offer(next.box.centre());
    for (int i = 0; i < 8; ++i) {
      offer(next.box.corner(i));
    }
    if (next.box.longest_side_m() <= settings.smallest_box_m) {
      undecided_m = std::min(undecided_m, next.distance_m);
      continue;
    }
    const Eigen::Vector3d centre = next.box.centre();
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector3d corner = next.box.corner(i);
      const WorldBox child{corner.cwiseMin(centre), corner.cwiseMax(centre)};
      const Eigen::Vector3d on_axis = nearest_on_axis(primitive, child);
      const double distance_m =
          std::max(next.distance_m, (child.nearest_to(on_axis) - on_axis).norm() - kAnswerRoundingM);
      if (distance_m < std::min(hi_m, cap_m)) {
        open.push({distance_m, false, child});
      }
    }
  }
  const double open_m = open.empty() ? cap_m : open.top().distance_m;
  result.lo_m = std::max(0.0, std::min({undecided_m, hi_m, cap_m, open_m}) - radius_m);
  return result;
}

}  // namespace depthgrid::reference
