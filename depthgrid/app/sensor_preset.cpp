#include "depthgrid/app/sensor_preset.hpp"

#include "depthgrid/app/usage_error.hpp"

namespace depthgrid::app {

const std::vector<SensorPreset>& sensor_presets() {
  static const std::vector<SensorPreset> presets = {
      {"ideal", "no noise, no quantisation; lateral reach 1 px", {0.0, 0.0, 0.0, 1}, std::nullopt, std::nullopt},
      {"kinect-v1",
       "structured light: m(z) = 0.00245 + 0.00633 z^2 m, lateral reach 2 px, 0.5 ... 5 m",
       {0.00245, 0.0, 0.00633, 2},
       0.5,
       5.0},
  };
  return presets;
}

const SensorPreset& sensor_preset(const std::string& name) {
  std::string names;
  for (const auto& preset : sensor_presets()) {
    if (preset.name == name) {
      return preset;
    }
    names += (names.empty() ? "" : ", ") + preset.name;
  }
  fail_usage("--sensor ", name, ": there is no such sensor; known are ", names);
}

}  // namespace depthgrid::app
