#include "depthgrid/robot/control_points.hpp"

#include <cmath>

#include "depthgrid/core/error.hpp"

namespace depthgrid::robot {

std::vector<ControlPoint> cover_with_balls(std::span<const LinkCapsule> capsules, double spacing_m) {
  if (!(spacing_m > 0)) {
    fail("control points: the spacing is ", spacing_m, " m, must be positive");
  }
  std::vector<ControlPoint> result;
  for (const LinkCapsule& item : capsules) {
    const Eigen::Vector3d along = item.capsule.b - item.capsule.a;
    const double length_m = along.norm();
    const int pieces = static_cast<int>(std::ceil(length_m / spacing_m));
    const double radius_m = std::hypot(item.capsule.radius_m, pieces > 0 ? 0.5 * length_m / pieces : 0.0);
    for (int i = 0; i <= pieces; ++i) {
      const double part = pieces > 0 ? static_cast<double>(i) / pieces : 0.0;
      result.push_back({item.link, item.capsule.a + part * along, radius_m});
    }
  }
  return result;
}

void place(std::span<const ControlPoint> points, std::span<const Pose> T_world_link,
           std::span<Eigen::Vector3d> points_world) noexcept {
  for (std::size_t i = 0; i < points.size(); ++i) {
    points_world[i] = T_world_link[points[i].link] * points[i].p_link;
  }
}

}  // namespace depthgrid::robot
