// Margins of known depth sensors.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "depthgrid/core/margin.hpp"

namespace depthgrid::app {

/// What is assumed of a sensor unless the user says otherwise.
struct SensorPreset {
  std::string name;
  std::string description;
  SensorMargin margin;
  std::optional<double> near_m;  ///< readings below are no measurement; none: as the rig file says
  std::optional<double> far_m;   ///< readings above count as far_m (the sensor tells "far" from "no return")
};

/// All presets. kinect-v1: noise sigma(z) = 0.0012 + 0.0019 (z - 0.4)^2 m and steps of 2.9e-3 z^2 m, so that 3 sigma
/// and half a step are 0.004512 - 0.00456 z + 0.00715 z^2. A margin has no negative coefficients: the preset
/// 0.00245 + 0.00633 z^2 is never below that on 0.5 ... 5 m and at most 4.3 mm above it.
const std::vector<SensorPreset>& sensor_presets();

/// Throws UsageError that lists the names there are.
const SensorPreset& sensor_preset(const std::string& name);

}  // namespace depthgrid::app
