#include "depthgrid/core/sensor_models.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "depthgrid/core/error.hpp"

namespace depthgrid {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// The longest an image of a 30 Hz camera can take: exposed for a whole frame period, and read out row by row in
/// another one where the shutter rolls.
constexpr double kGlobalShutter30Hz = 0.5 / 30.0;
constexpr double kRollingShutter30Hz = 1.0 / 30.0;

/// Enough for holes of a few pixels within 2 m in images of 640 columns, and less than a finger's tip and joint.
constexpr double kSmallObstacle = 0.02;
/// For sensors with wide holes at edges, or whose readings may stand so many pixels beside their place that less says
/// next to nothing: a D435's 2 cm, with 3 px, nothing at all beyond 0.7 m in images of 848 columns. Thicker than this
/// are hands and forearms, the least of a person that counts.
constexpr double kForearm = 0.05;

/// Seen from the sensor the projector is on the infrared camera's right, and a D4xx's other imager, too.
constexpr double kKinectProjector = 0.075;

MeasurementRule between(double near_m, double far_m, bool clamp_beyond_far = false) {
  return {near_m, far_m, clamp_beyond_far, {}};
}

/// Disparities of the D400 family come in steps of 1/32 px. The maker's engineers recommend 0.08 px for the noise and
/// state an accuracy of 2 % of the depth.
SensorModel realsense(std::string_view name, std::string_view description, double baseline_m, double largest_focal_px,
                      double near_m, double far_m, double half_exposure_s) {
  return {name,
          description,
          {0.0, 0.02, 0.0, 3},
          StereoNoise{baseline_m, 0.08, 1.0 / 32.0, largest_focal_px},
          true,
          between(near_m, far_m),
          half_exposure_s,
          std::nullopt,
          kForearm,
          baseline_m};
}

/// Noise of at most 17 mm and a typical systematic error below 11 mm + 0.1 % are stated for the whole range of a mode;
/// the device's own time stamps are the middle of the exposure.
SensorModel azure_kinect(std::string_view name, std::string_view description, double near_m, double far_m,
                         double exposure_s) {
  return {name,
          description,
          {kSensorSigmas * 0.017 + 0.011, 0.001, 0.0, 1},
          std::nullopt,
          true,
          between(near_m, far_m),
          exposure_s / 2,
          std::nullopt,
          kSmallObstacle,
          0.0};
}

std::array<SensorModel, 9> make_models() {
  return {{
      {"ideal",
       "no noise, no quantisation; filter radius 1 px",
       {0.0, 0.0, 0.0, 1},
       std::nullopt,
       false,
       between(0, kNoLimit),
       0.0,
       0.0,
       0.0,
       0.0},
      // sigma(z) = 0.0012 + 0.0019 (z - 0.4)^2 m and steps of 2.9e-3 z^2 m: three sigma and half a step are
      // 0.004512 - 0.00456 z + 0.00715 z^2. A margin has no negative coefficient, so this one lies nowhere below that
      // on 0.5 ... 5 m and at most 4.3 mm above it. A reading beyond 5 m is far away, no failure: it frees up to 5 m.
      {"kinect_v1",
       "structured light; filter radius 2 px, 0.5 ... 5 m",
       {0.00245, 0.0, 0.00633, 2},
       std::nullopt,
       false,
       between(0.5, 5.0, true),
       kRollingShutter30Hz,
       std::nullopt,
       kForearm,
       kKinectProjector},
      realsense("realsense_d415", "stereo, 55 mm; filter radius 3 px, 0.45 ... 3 m", 0.055, 960.0, 0.45, 3.0,
                kRollingShutter30Hz),
      realsense("realsense_d435", "stereo, 50 mm; filter radius 3 px, 0.28 ... 3 m", 0.050, 640.0, 0.28, 3.0,
                kGlobalShutter30Hz),
      realsense("realsense_d455", "stereo, 95 mm; filter radius 3 px, 0.52 ... 6 m", 0.095, 640.0, 0.52, 6.0,
                kGlobalShutter30Hz),
      azure_kinect("azure_kinect_nfov", "time of flight, 640 x 576; 0.5 ... 3.86 m", 0.5, 3.86, 0.0128),
      azure_kinect("azure_kinect_nfov_binned", "time of flight, 320 x 288; 0.5 ... 5.46 m", 0.5, 5.46, 0.0128),
      azure_kinect("azure_kinect_wfov", "time of flight, 1024 x 1024; 0.25 ... 2.21 m", 0.25, 2.21, 0.0203),
      azure_kinect("azure_kinect_wfov_binned", "time of flight, 512 x 512; 0.25 ... 2.88 m", 0.25, 2.88, 0.0128),
  }};
}

const std::array<SensorModel, 9>& models() {
  static const std::array<SensorModel, 9> kModels = make_models();
  return kModels;
}

bool same_name(std::string_view given, std::string_view name) {
  return std::equal(given.begin(), given.end(), name.begin(), name.end(),
                    [](char a, char b) { return (a == '-' ? '_' : a) == b; });
}

}  // namespace

std::span<const SensorModel> sensor_models() noexcept { return models(); }

const SensorModel& sensor_model(std::string_view name) {
  std::string names;
  for (const SensorModel& model : models()) {
    if (same_name(name, model.name)) {
      return model;
    }
    names.append(names.empty() ? "" : ", ").append(model.name);
  }
  fail("there is no sensor model '", name, "', known are ", names);
}

CameraMargins sensor_margins(const SensorModel& model, const PinholeCamera& camera, double metres_per_unit) noexcept {
  CameraMargins margins;
  margins.sensor = model.margin;
  if (model.stereo) {
    const double focal_px = std::min(camera.fx_px, model.stereo->largest_focal_px);
    margins.sensor.quadratic_per_m += (kSensorSigmas * model.stereo->subpixel_px + 0.5 * model.stereo->step_px) /
                                      (focal_px * model.stereo->baseline_m);
  }
  if (model.rounds_to_units) {
    margins.sensor.constant_m += 0.5 * metres_per_unit;
  }
  margins.half_exposure_s = model.half_exposure_s.value_or(0.0);
  margins.time_uncertainty_s = model.time_uncertainty_s.value_or(0.0);
  return margins;
}

}  // namespace depthgrid
