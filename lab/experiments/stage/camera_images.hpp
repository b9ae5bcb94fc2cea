// What the cameras of a rig deliver of a staged cell, robot intervals included.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "depthgrid/core/frame.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/robot/robot_removal.hpp"
#include "depthgrid/simulation/simulated_sensors.hpp"
#include "lab/experiments/stage/staged_cell.hpp"
#include "lab/workcell/depth_caster.hpp"

namespace depthgrid::experiments {

/// What becomes of the robot in the images.
enum class RobotPixels : std::uint8_t {
  behind_unknown,  ///< removed with Frame::robot: nothing is known of the space behind it (the letter's case (iv))
  thin_layer,      ///< the same with thin_padding_m() and the sensor's margin in the test
  background,      ///< replaced by the empty room: nothing stands behind the robot. Not true whenever something does
};

/// Images of one instant. Sensors as RigCamera::sensor names them; "ideal" ones are exact. One thread.
class CameraImages {
 public:
  /// Throws Error as DepthCaster and SimulatedSensors do.
  CameraImages(const Rig& rig, const StagedCell& stage, RobotPixels robot,
               const simulation::SensorGroupSettings& noise);

  /// Takes the images of the cell as it is now. `frame` numbers the noise, the time is that of the frames.
  void take(const StagedCell& stage, std::uint64_t frame, double time_s = 0);

  /// One a camera, in the rig's order; of the last take(), valid until the next.
  [[nodiscard]] std::span<const Frame> frames() const noexcept { return frames_; }
  /// As measured, 0 = no measurement.
  [[nodiscard]] const DepthImage& depth_m(std::size_t camera) const { return measured_m_[camera]; }
  [[nodiscard]] const Rig& rig() const noexcept { return rig_; }
  /// By how much the robot's capsules are grown in the images: the sensors' margin at 2.5 m and 2 cm, or the thin
  /// layer.
  [[nodiscard]] double padding_m() const noexcept { return padding_m_; }

 private:
  Rig rig_;
  RobotPixels robot_;
  double padding_m_;
  workcell::DepthCaster caster_;
  simulation::SimulatedSensors sensors_;
  std::vector<robot::RobotRemoval> removals_;
  std::vector<DepthImage> empty_m_;  ///< of the room without robot and person; for `background`
  std::vector<DepthImage> ideal_m_;
  std::vector<DepthImage> measured_m_;
  std::vector<Frame> frames_;
};

}  // namespace depthgrid::experiments
