// The numbers of the simulated sensors; their sources stand in docs/simulation.md.
#include <algorithm>
#include <numbers>

#include "depthgrid/core/sensor_models.hpp"
#include "depthgrid/simulation/sensor_simulation.hpp"

namespace depthgrid::simulation {

namespace {

constexpr double kRadPerDegree = std::numbers::pi / 180;

/// Nguyen, Izadi and Lovell 2012 for the noise; 1/z in steps of 1 / (8 f b) with the sensor's own focal length of 575
/// px.
SensorSimulation kinect_v1() {
  constexpr double kBaseline = 0.075;
  SensorSimulation s;
  s.noise_constant_m = 0.0012;
  s.noise_quadratic_per_m = 0.0019;
  s.noise_origin_m = 0.4;
  s.noise_slant = 0.0001;
  s.lateral_px = 0.8;
  s.lateral_slant_px = 0.035;
  s.step_per_m = 1 / (8 * 575 * kBaseline);
  s.baseline_m = kBaseline;
  s.flying_share = 0.2;
  s.dropout_share = 0.002;
  s.largest_slant_rad = 80 * kRadPerDegree;
  s.near_m = 0.5;
  s.far_m = 10;
  s.structured_light = true;
  return s;
}

SensorSimulation stereo(const SensorModel& model, const PinholeCamera& camera) {
  const StereoNoise& noise = *model.stereo;
  const double focal_times_baseline = std::min(camera.fx_px, noise.largest_focal_px) * noise.baseline_m;
  SensorSimulation s;
  s.noise_quadratic_per_m = noise.subpixel_px / focal_times_baseline;
  s.step_per_m = noise.step_px / focal_times_baseline;
  s.bias_linear = 0.02;
  s.lateral_px = 1;
  s.lateral_limit_px = 3;
  s.patch_px = 4;
  s.baseline_m = noise.baseline_m;
  s.flying_share = 0.1;
  s.dropout_share = 0.005;
  s.largest_slant_rad = 80 * kRadPerDegree;
  s.near_m = model.rule.near_m;
  s.far_m = 10;
  return s;
}

SensorSimulation azure_kinect(const SensorModel& model) {
  SensorSimulation s;
  s.noise_constant_m = 0.017;
  s.bias_constant_m = 0.011;
  s.bias_linear = 0.001;
  s.flying_share = 0.5;
  s.dropout_share = 0.001;
  s.largest_slant_rad = 85 * kRadPerDegree;
  s.near_m = model.rule.near_m;
  s.far_m = model.rule.far_m;
  return s;
}

}  // namespace

SensorSimulation sensor_simulation(std::string_view model_name, const PinholeCamera& camera) {
  const SensorModel& model = depthgrid::sensor_model(model_name);
  SensorSimulation result;
  if (model.stereo) {
    result = stereo(model, camera);
  } else if (model.name == "kinect_v1") {
    result = kinect_v1();
  } else if (model.name != "ideal") {
    result = azure_kinect(model);
  }
  result.name = model.name;
  return result;
}

}  // namespace depthgrid::simulation
