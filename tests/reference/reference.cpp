#include "reference/reference.hpp"

#include <algorithm>
#include <limits>
#include <queue>

namespace depthgrid::reference {
namespace {

struct OpenBox {
  double distance_m;  ///< from P to the box: nothing in it is nearer
  WorldBox box;
};

struct Farther {
  bool operator()(const OpenBox& a, const OpenBox& b) const { return a.distance_m > b.distance_m; }
};

Eigen::Vector3d nearest_in(const WorldBox& box, const Eigen::Vector3d& p) {
  return p.cwiseMax(box.low).cwiseMin(box.high);
}

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

bool Reference::is_obstacle(const Eigen::Vector3d& p_world) const {
  if (!in_space(p_world)) {
    return outside_ == Policy::obstacle;
  }
  const bool blocked =
      std::all_of(cameras_.begin(), cameras_.end(), [&](const CameraSpace& camera) { return camera.blocks(p_world); });
  const bool counts =
      uncovered_ == Policy::obstacle ||
      std::any_of(cameras_.begin(), cameras_.end(), [&](const CameraSpace& camera) { return camera.covers(p_world); });
  return blocked && counts;
}

bool Reference::holds_no_obstacle(const WorldBox& box) const {
  const auto* frustum = std::get_if<FrustumSpace>(&space_);
  if (frustum != nullptr && cameras_[frustum->principal].outside_view(box, {frustum->d_min_m, frustum->d_max_m})) {
    return true;  // of the outside only the border counts, and that is looked at once, in distance()
  }
  std::vector<std::size_t> covering;
  for (std::size_t k = 0; k < cameras_.size(); ++k) {
    if (uncovered_ == Policy::ignored && !cameras_[k].covers_nothing_of(box)) {
      covering.push_back(k);
    }
  }
  if (uncovered_ == Policy::ignored && covering.empty()) {
    return true;
  }
  for (std::size_t k = 0; k < cameras_.size(); ++k) {
    std::optional<ViewLimits> limits;
    if (frustum != nullptr && frustum->principal == k) {
      limits = ViewLimits{frustum->d_min_m, frustum->d_max_m};
    }
    if (uncovered_ == Policy::ignored && covering.size() == 1 && covering.front() == k) {
      limits = cameras_[k].view_limits();  // beyond this camera's view nothing counts
    }
    if (cameras_[k].frees_box(box, limits)) {
      return true;
    }
  }
  return false;
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

Interval Reference::distance(const Eigen::Vector3d& p_world, const SearchSettings& settings) const {
  Interval result;
  if (!in_space(p_world)) {
    result.point_outside = outside_ == Policy::ignored;
    if (outside_ == Policy::obstacle) {
      result.hi_m = 0.0;
      result.witness_world = p_world;
    }
    return result;
  }
  double hi_m = std::numeric_limits<double>::infinity();
  const auto offer = [&](const Eigen::Vector3d& candidate) {
    const double distance_m = (candidate - p_world).norm();
    if (distance_m < hi_m && distance_m <= rho_m_ && is_obstacle(candidate)) {
      hi_m = distance_m;
      result.hi_m = distance_m;
      result.witness_world = candidate;
    }
  };
  offer(p_world);
  if (outside_ == Policy::obstacle) {
    offer(nearest_border_point(p_world));
  }

  WorldBox root = WorldBox{p_world, p_world}.grown(rho_m_);
  if (const auto* box = std::get_if<WorldBox>(&space_)) {
    root = {root.low.cwiseMax(box->low), root.high.cwiseMin(box->high)};
  }
  std::priority_queue<OpenBox, std::vector<OpenBox>, Farther> open;
  open.push({0.0, root});
  // Nothing nearer than this is in O unless it lies in an open box; smallest boxes that stay undecided lower it.
  double undecided_m = std::numeric_limits<double>::infinity();
  while (!open.empty()) {
    const OpenBox next = open.top();
    const double lo_m = std::min(undecided_m, next.distance_m);
    if (next.distance_m > std::min(hi_m, rho_m_) || hi_m - lo_m <= settings.gap_m) {
      break;
    }
    if (result.boxes >= settings.box_limit) {
      result.limit_reached = true;
      break;
    }
    open.pop();
    ++result.boxes;
    if (holds_no_obstacle(next.box)) {
      continue;
    }
    offer(nearest_in(next.box, p_world));
    offer(next.box.centre());
    for (int i = 0; i < 8; ++i) {
      offer(next.box.corner(i));
    }
    if ((next.box.high - next.box.low).maxCoeff() <= settings.smallest_box_m) {
      undecided_m = std::min(undecided_m, next.distance_m);
      continue;
    }
    const Eigen::Vector3d centre = next.box.centre();
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector3d corner = next.box.corner(i);
      const WorldBox child{corner.cwiseMin(centre), corner.cwiseMax(centre)};
      const double distance_m = (nearest_in(child, p_world) - p_world).norm();
      if (distance_m <= std::min(hi_m, rho_m_)) {
        open.push({distance_m, child});
      }
    }
  }
  result.lo_m = std::min({undecided_m, hi_m, rho_m_, open.empty() ? rho_m_ : open.top().distance_m});
  return result;
}

}  // namespace depthgrid::reference
