// The KUKA LWR 4+ that stands in the experiments' cell and moves its joints to and fro.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "depthgrid/robot/control_points.hpp"
#include "depthgrid/robot/link_capsules.hpp"
#include "depthgrid/robot/robot_model.hpp"
#include "depthgrid/simulation/shapes.hpp"

namespace depthgrid::experiments {

inline constexpr std::size_t kControlPoints = 9;

/// The base stands in the world's origin. A function of time alone.
class ArmAtWork {
 public:
  ArmAtWork();

  /// Takes the arm to where it is at a time in seconds: over the free side of the cell, away from the table. No joint
  /// is faster than 0.6 rad/s.
  void move_to(double time_s);
  /// To joint positions, rad.
  void pose(const std::array<double, 7>& q_rad);

  /// In the order of model().links().
  [[nodiscard]] std::span<const Pose> T_world_link() const noexcept { return T_world_link_; }
  /// The links' capsules in the world frame.
  [[nodiscard]] std::span<const Capsule> capsules_world() const noexcept { return capsules_world_; }
  /// Nine points evenly spaced on the arm's axis, from above the shoulder to the flange; world frame. All are more than
  /// 0.4 m above the pedestal, whose top reaches into the robot's base: what stands inside the robot's padding no
  /// method can see.
  [[nodiscard]] std::span<const Eigen::Vector3d> points_world() const noexcept { return points_world_; }

  [[nodiscard]] const robot::RobotModel& model() const noexcept { return model_; }
  [[nodiscard]] const std::vector<robot::LinkCapsule>& capsules() const noexcept { return capsules_; }

 private:
  robot::RobotModel model_;
  std::vector<robot::LinkCapsule> capsules_;
  std::vector<robot::ControlPoint> points_;
  std::vector<Pose> T_world_link_;
  std::vector<Capsule> capsules_world_;
  std::vector<Eigen::Vector3d> points_world_;
};

}  // namespace depthgrid::experiments
