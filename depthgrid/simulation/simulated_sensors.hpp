// The depth sensors of a whole rig in simulation, with what they do to each other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "depthgrid/core/depth_image.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/simulation/interference.hpp"
#include "depthgrid/simulation/sensor_simulation.hpp"

namespace depthgrid::simulation {

/// What of a rig's simulation is not in the rig. One entry of `vibrating` a camera, or none at all.
struct SensorGroupSettings {
  std::uint64_t seed = 1;
  InterferenceModel interference{};
  std::vector<bool> vibrating{};
  double vibration_px = 0.5;  ///< of a vibrating unit's image; judged, no source
};

/// One simulated sensor for each camera of a rig, of the model that RigCamera::sensor names (empty: ideal). Structured
/// light units disturb each other. One thread at a time.
class SimulatedSensors {
 public:
  /// Throws Error when the rig is invalid, names an unknown model, or `vibrating` has another length.
  SimulatedSensors(const Rig& rig, const SensorGroupSettings& settings);

  /// One ideal and one measured image a camera, in the rig's order. Throws Error on another number or size.
  void measure(std::span<const DepthImage> ideal_m, std::uint64_t frame, std::span<DepthImage> measured_m);

  [[nodiscard]] const SimulatedSensor& sensor(std::size_t camera) const { return sensors_[camera]; }

 private:
  SensorGroupSettings settings_;
  std::vector<Pose> T_world_camera_;
  std::vector<SimulatedSensor> sensors_;
};

}  // namespace depthgrid::simulation
