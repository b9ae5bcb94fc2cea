#include "program/sensor_options.hpp"

#include <CLI/CLI.hpp>
#include <cmath>
#include <utility>

#include "depthgrid/core/plausibility.hpp"
#include "depthgrid/core/sensor_models.hpp"
#include "program/usage_error.hpp"

namespace depthgrid::program {

namespace {

/// For CLI11: empty, or what is wrong with the name.
std::string unknown_sensor(const std::string& name) {
  try {
    (void)sensor_model(name);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

void add_margin(CLI::App& command, const char* option, std::optional<double>& target, const char* description) {
  command.add_option(option, target, description)->group("Sensor");
}

/// The sensor's own part of the margins; the calibration of the rig file stays.
void take_sensor(const SensorModel& model, const RigCamera& camera, CameraMargins& margins) {
  const CameraMargins of_model = sensor_margins(model, camera.intrinsics, camera.metres_per_unit);
  margins.sensor = of_model.sensor;
  margins.half_exposure_s = of_model.half_exposure_s;
  margins.time_uncertainty_s = model.time_uncertainty_s.value_or(margins.time_uncertainty_s);
}

bool names_noise(const SensorOptions& options) {
  return options.margin_constant_m || options.margin_linear || options.margin_quadratic_per_m;
}

}  // namespace

void add_sensor_options(CLI::App& command, SensorOptions& options) {
  std::string sensors;
  for (const SensorModel& model : sensor_models()) {
    sensors.append("; ").append(model.name).append(": ").append(model.description);
  }
  command
      .add_option("--sensor", options.sensor,
                  "margins to start from (default: those of the rig file, else ideal)" + sensors)
      ->check(CLI::Validator(unknown_sensor, "NAME"))
      ->group("Sensor");
  add_margin(command, "--margin-constant", options.margin_constant_m, "constant part of the depth margin m(D), metres");
  add_margin(command, "--margin-linear", options.margin_linear, "part of m(D) that grows with D");
  add_margin(command, "--margin-quadratic", options.margin_quadratic_per_m,
             "part of m(D) that grows with D^2, 1/metre");
  command.add_option("--margin-lateral", options.margin_lateral_px, "filter radius w, pixels")->group("Sensor");
  add_margin(command, "--margin-translation", options.margin_translation_m, "calibration error of position, metres");
  add_margin(command, "--margin-rotation", options.margin_rotation_rad, "calibration error of rotation, radians");
  add_margin(command, "--margin-time", options.margin_time_m,
             "largest way of an obstacle between the exposures, metres");
  add_margin(command, "--half-exposure", options.half_exposure_s,
             "half the time in which one image is taken, seconds (search)");
  add_margin(command, "--time-uncertainty", options.time_uncertainty_s, "error of the time stamps, seconds (search)");
  add_margin(command, "--near", options.near_m, "nearest measurable depth, metres");
  add_margin(command, "--far", options.far_m, "farthest measurable depth, metres");
  command.add_option("--beyond-far", options.beyond_far, "readings beyond --far: invalid, or clamp = free up to --far")
      ->check(CLI::IsMember({"invalid", "clamp"}))
      ->group("Sensor");
}

bool names_margins(const SensorOptions& options) noexcept {
  return names_noise(options) || options.margin_lateral_px || options.margin_translation_m ||
         options.margin_rotation_rad || options.margin_time_m || options.half_exposure_s || options.time_uncertainty_s;
}

std::vector<CameraMargins> camera_margins(const SensorOptions& options, const Rig& rig, bool must_be_stated) {
  std::vector<CameraMargins> all;
  for (const RigCamera& camera : rig.cameras) {
    if (must_be_stated && !camera.margins && !options.sensor && !names_noise(options)) {
      fail_usage("camera '", camera.id,
                 "' has no margins in the rig file; give --sensor NAME (ideal: no noise) or --margin-constant, "
                 "--margin-linear, --margin-quadratic");
    }
    CameraMargins margins = camera.margins.value_or(CameraMargins{});
    if (options.sensor) {
      take_sensor(sensor_model(*options.sensor), camera, margins);
    }
    margins.sensor.constant_m = options.margin_constant_m.value_or(margins.sensor.constant_m);
    margins.sensor.linear = options.margin_linear.value_or(margins.sensor.linear);
    margins.sensor.quadratic_per_m = options.margin_quadratic_per_m.value_or(margins.sensor.quadratic_per_m);
    margins.sensor.lateral_px = options.margin_lateral_px.value_or(margins.sensor.lateral_px);
    margins.translation_m = options.margin_translation_m.value_or(margins.translation_m);
    margins.rotation_rad = options.margin_rotation_rad.value_or(margins.rotation_rad);
    margins.half_exposure_s = options.half_exposure_s.value_or(margins.half_exposure_s);
    margins.time_uncertainty_s = options.time_uncertainty_s.value_or(margins.time_uncertainty_s);
    validate(margins.sensor);
    validate(PoseMargin{margins.translation_m, margins.rotation_rad, options.margin_time_m.value_or(0.0)});
    margins.translation_m += options.margin_time_m.value_or(0.0);
    validate(margins, ("camera '" + camera.id + "'").c_str());
    check_plausible(margins, ("camera '" + camera.id + "'").c_str());
    all.push_back(margins);
  }
  return all;
}

std::optional<double> near_limit_m(const SensorOptions& options) {
  const double near_m = options.sensor ? sensor_model(*options.sensor).rule.near_m : 0.0;
  return options.near_m || !(near_m > 0) ? options.near_m : near_m;
}

std::optional<double> far_limit_m(const SensorOptions& options) {
  const double far_m = options.sensor ? sensor_model(*options.sensor).rule.far_m : MeasurementRule{}.far_m;
  return options.far_m || !std::isfinite(far_m) ? options.far_m : far_m;
}

std::optional<int> filter_radius_px(const SensorOptions& options) {
  if (options.margin_lateral_px || !options.sensor) {
    return options.margin_lateral_px;
  }
  return sensor_model(*options.sensor).margin.lateral_px;
}

std::optional<bool> clamp_beyond_far(const SensorOptions& options) {
  if (options.beyond_far) {
    return *options.beyond_far == "clamp";
  }
  // A model's far end is a declared property of the sensor; the user's own is not unless it is said.
  if (options.far_m || !far_limit_m(options)) {
    return std::nullopt;
  }
  return sensor_model(*options.sensor).rule.clamp_beyond_far;
}

}  // namespace depthgrid::program
