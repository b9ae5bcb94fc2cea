// The letter's cell with a LWR 4+ in it whose links go where the loop says, and something that moves.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "depthgrid/core/rig.hpp"
#include "depthgrid/robot/robot_model.hpp"
#include "depthgrid/simulation/simulated_sensors.hpp"
#include "lab/experiments/loop/avoidance_motion.hpp"
#include "lab/workcell/cell_truth.hpp"
#include "lab/workcell/depth_caster.hpp"

namespace depthgrid::experiments {

/// The letter's cameras, 1 or 2 of them, with images of this width (as with_width()) and the same view. `sensor`: see
/// simulation::letter_arrangement(). Throws Error on an unknown sensor.
[[nodiscard]] Rig avoidance_rig(int cameras, int width_px, std::string_view sensor);

/// How near the moving links really are, and which.
struct TrueDistance {
  double distance_m = 0;           ///< 0: touching
  std::size_t link = 0;            ///< of the model
  Eigen::Vector3d on_robot_world;  ///< NaN when touching
  Eigen::Vector3d on_obstacle_world;
};

/// One thread.
class AvoidanceCell {
 public:
  /// The model must outlive it. Throws Error when a shape cannot be read.
  AvoidanceCell(const robot::RobotModel& model, const AvoidanceMotion& motion);

  /// Everything at one instant.
  void update(double time_s, std::span<const Pose> T_world_link);

  /// One ideal image a camera.
  void render(const Rig& rig, std::vector<DepthImage>& depth_m);

  [[nodiscard]] const simulation::Workcell& cell() const noexcept { return cell_; }

  /// To what moves (with what it carries); to plates, table, workpiece. Nothing when there is none.
  [[nodiscard]] std::optional<TrueDistance> to_person() const;
  [[nodiscard]] std::optional<TrueDistance> to_objects() const;

 private:
  [[nodiscard]] std::optional<TrueDistance> nearest(simulation::BodyKind kind) const;

  AvoidanceMotion motion_;
  simulation::Workcell cell_;
  std::vector<std::size_t> link_of_body_;  ///< by body; only those of the robot
  std::size_t first_link_body_ = 0;
  std::optional<std::size_t> person_;
  std::optional<workcell::DepthCaster> caster_;
  std::optional<workcell::CellTruth> truth_;
};

}  // namespace depthgrid::experiments
