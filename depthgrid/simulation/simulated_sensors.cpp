#include "depthgrid/simulation/simulated_sensors.hpp"

#include "depthgrid/core/error.hpp"
#include "depthgrid/simulation/pixel_random.hpp"

namespace depthgrid::simulation {

SimulatedSensors::SimulatedSensors(const Rig& rig, const SensorGroupSettings& settings) : settings_(settings) {
  depthgrid::validate(rig);
  if (!settings.vibrating.empty() && settings.vibrating.size() != rig.cameras.size()) {
    fail("vibrating has ", settings.vibrating.size(), " entries, must be none or one for each of ", rig.cameras.size(),
         " cameras");
  }
  settings_.vibrating.resize(rig.cameras.size(), false);
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const RigCamera& camera = rig.cameras[i];
    SensorSimulation sensor =
        sensor_simulation(camera.sensor.empty() ? std::string("ideal") : camera.sensor, camera.intrinsics);
    sensor.vibration_px = settings_.vibrating[i] ? settings.vibration_px : 0.0;
    T_world_camera_.push_back(camera.T_world_camera);
    sensors_.emplace_back(std::move(sensor), camera.intrinsics, scrambled(settings.seed) + i);
  }
}

void SimulatedSensors::measure(std::span<const DepthImage> ideal_m, std::uint64_t frame,
                               std::span<DepthImage> measured_m) {
  if (ideal_m.size() != sensors_.size() || measured_m.size() != sensors_.size()) {
    fail("given ", ideal_m.size(), " ideal and ", measured_m.size(), " measured images, must be ", sensors_.size());
  }
  std::vector<StructuredLightUnit> units;
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    sensors_[i].measure(ideal_m[i], frame, measured_m[i]);
    if (sensors_[i].sensor().structured_light) {
      units.push_back({sensors_[i].camera(), T_world_camera_[i], &ideal_m[i], settings_.vibrating[i]});
    }
  }
  std::size_t unit = 0;
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    if (sensors_[i].sensor().structured_light) {
      apply_interference(units, unit++, settings_.interference, sensors_[i].seed(), frame, measured_m[i]);
    }
  }
}

}  // namespace depthgrid::simulation
