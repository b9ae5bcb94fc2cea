#include "depthgrid/core/carried_answer.hpp"

#include <algorithm>
#include <cmath>

namespace depthgrid {

double greatest_displacement_m(const Capsule& before, const Capsule& now) noexcept {
  // Between the ends the displacement is linear, so its norm is convex and greatest at an end.
  const double a_m = (now.a - before.a).norm();
  const double b_m = (now.b - before.b).norm();
  const double grown_m = now.radius_m - before.radius_m;
  const double sum_m = a_m + b_m + grown_m;  // not finite if any of them is not
  return std::isfinite(sum_m) ? std::max(a_m, b_m) + std::max(0.0, grown_m) : Proximity::kNaN;
}

Answer carried_over(const Answer& answer, const Capsule& asked, const Capsule& now, double elapsed_s,
                    double v_max_m_s) noexcept {
  const double moved_m = greatest_displacement_m(asked, now);
  if (!std::isfinite(moved_m) || now.radius_m < 0) {
    return {};
  }
  Answer carried = answer;
  // std::max would make 0 of a NaN in its second argument.
  const auto less = [](double bound_m, double by_m) {
    const double rest_m = bound_m - by_m;
    return rest_m < 0 ? 0.0 : rest_m;
  };
  carried.nearest.distance_m = less(answer.nearest.distance_m, moved_m);
  carried.nearest.known_to_m = less(answer.nearest.known_to_m, moved_m);
  carried.distance_now_m =
      elapsed_s >= 0 ? less(answer.distance_now_m, moved_m + v_max_m_s * elapsed_s) : Proximity::kNaN;
  const Eigen::Vector3d& nearest_world = answer.nearest.nearest_world;
  if (nearest_world.allFinite()) {
    carried.on_axis_world = nearest_on_axis(now, nearest_world);
    const Eigen::Vector3d to_nearest = nearest_world - carried.on_axis_world;
    const double distance_m = to_nearest.norm();
    carried.nearest.direction_world =
        distance_m > 0 ? Eigen::Vector3d(to_nearest / distance_m) : Eigen::Vector3d::Zero();
  }
  return carried;
}

}  // namespace depthgrid
