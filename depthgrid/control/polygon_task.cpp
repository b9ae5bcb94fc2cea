#include "depthgrid/control/polygon_task.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "depthgrid/control/obstacle.hpp"
#include "depthgrid/core/error.hpp"

namespace depthgrid::control {
namespace {

void check_positive(const char* what, double value, const char* unit) {
  if (!(std::isfinite(value) && value > 0)) {
    fail("polygon task: ", what, " is ", value, unit, ", must be greater than 0 and finite");
  }
}

}  // namespace

void validate(const PolygonSettings& settings) {
  if (settings.vertices_world.size() < 2) {
    fail("polygon task: there are ", settings.vertices_world.size(), " vertices, must be at least 2");
  }
  check_positive("speed", settings.speed_m_s, " m/s");
  check_positive("corner speed", settings.corner_speed_m_s, " m/s");
  check_positive("acceleration", settings.acceleration_m_s2, " m/s^2");
  check_positive("arrival", settings.arrival_m, " m");
  for (std::size_t i = 0; i < settings.vertices_world.size(); ++i) {
    const Eigen::Vector3d& here = settings.vertices_world[i];
    const Eigen::Vector3d& there = settings.vertices_world[(i + 1) % settings.vertices_world.size()];
    if (!here.allFinite()) {
      fail("polygon task: vertex ", i, " is not finite");
    }
    if ((there - here).norm() <= settings.arrival_m) {
      fail("polygon task: vertex ", i, " and the next are ", (there - here).norm(),
           " m from each other, must be more than the arrival distance of ", settings.arrival_m, " m");
    }
  }
}

std::vector<Eigen::Vector3d> vertical_hexagon(const Eigen::Vector3d& centre_world, double radius_m,
                                              const Eigen::Vector3d& normal_world) {
  check_positive("radius", radius_m, " m");
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const auto sideways = unit_vector(up.cross(normal_world));
  if (!sideways) {
    fail("polygon task: the normal of a vertical plane is horizontal, not (", normal_world.transpose(), ")");
  }
  std::vector<Eigen::Vector3d> vertices;
  for (int i = 0; i < 6; ++i) {
    const double angle = i * std::numbers::pi / 3;
    vertices.emplace_back(centre_world + radius_m * (std::cos(angle) * up + std::sin(angle) * *sideways));
  }
  return vertices;
}

PolygonTask::PolygonTask(const PolygonSettings& settings) : settings_(settings) { validate(settings); }

Task PolygonTask::rows(const EndEffector& tip) noexcept {
  return {tip.jacobian.topRows(3), desired_velocity(tip.T_world_tip.translation())};
}

const Eigen::Vector3d& PolygonTask::next_vertex_world() const noexcept { return settings_.vertices_world[next_]; }

Eigen::Vector3d PolygonTask::desired_velocity(const Eigen::Vector3d& p_world) noexcept {
  if (!p_world.allFinite()) {
    return Eigen::Vector3d::Zero();
  }
  const std::size_t count = settings_.vertices_world.size();
  if ((next_vertex_world() - p_world).norm() <= settings_.arrival_m) {
    next_ = (next_ + 1) % count;
    ++reached_;
  }
  const Eigen::Vector3d way = next_vertex_world() - p_world;
  const double from_last = (settings_.vertices_world[(next_ + count - 1) % count] - p_world).norm();
  const double to_corner = std::min(way.norm(), from_last);
  const double corner = settings_.corner_speed_m_s;
  const double speed =
      std::min(settings_.speed_m_s, std::sqrt(corner * corner + 2 * settings_.acceleration_m_s2 * to_corner));
  return speed * unit_vector(way).value_or(Eigen::Vector3d::Zero());
}

}  // namespace depthgrid::control
