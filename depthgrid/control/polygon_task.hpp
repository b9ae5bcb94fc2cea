// The letter's task: the end effector passes the vertices of a polygon one after the other, for ever, at a nominal
// speed.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "depthgrid/control/motion_task.hpp"

namespace depthgrid::control {

struct PolygonSettings {
  std::vector<Eigen::Vector3d> vertices_world;
  double speed_m_s = 0.40;
  double corner_speed_m_s = 0.05;  ///< at the vertices, where the direction jumps
  double acceleration_m_s2 = 2.0;  ///< along the edges, from and to the corner speed
  double arrival_m = 0.005;        ///< nearer than this a vertex is reached
};

/// Throws Error with value and rule.
void validate(const PolygonSettings& settings);

/// Six vertices around `centre`, the first straight above it, in the vertical plane with this horizontal normal (its
/// vertical part is dropped; z points up). Throws Error when there is no such plane or the radius is not positive.
[[nodiscard]] std::vector<Eigen::Vector3d> vertical_hexagon(const Eigen::Vector3d& centre_world, double radius_m,
                                                            const Eigen::Vector3d& normal_world);

/// Knows only the next vertex, so wherever the end effector was driven to, it goes on from there: straight to the
/// vertex that it has not reached. Nothing but the constructor allocates, locks or throws.
class PolygonTask final : public MotionTask {
 public:
  explicit PolygonTask(const PolygonSettings& settings);

  /// Three rows: desired_velocity() of the tip's origin, however it is turned.
  [[nodiscard]] Task rows(const EndEffector& tip) noexcept override;

  /// The velocity that the task wants at this position; counts a vertex that is reached. Zero for a position that is
  /// not finite.
  [[nodiscard]] Eigen::Vector3d desired_velocity(const Eigen::Vector3d& p_world) noexcept;

  [[nodiscard]] const Eigen::Vector3d& next_vertex_world() const noexcept;
  [[nodiscard]] std::int64_t vertices_reached() const noexcept { return reached_; }

 private:
  PolygonSettings settings_;
  std::size_t next_ = 0;
  std::int64_t reached_ = 0;
};

}  // namespace depthgrid::control
