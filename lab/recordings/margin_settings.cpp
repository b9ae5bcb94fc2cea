#include "lab/recordings/margin_settings.hpp"

#include <array>
#include <numbers>

#include "depthgrid/core/sensor_models.hpp"

namespace depthgrid::lab {

namespace {

constexpr double kDegree_rad = std::numbers::pi / 180;

CameraMargins no_margin(int lateral_px) {
  CameraMargins margins;
  margins.sensor.lateral_px = lateral_px;
  margins.smallest_obstacle_m = 0;
  return margins;
}

CameraMargins kinect_margin() {
  CameraMargins margins;
  margins.sensor = sensor_model("kinect_v1").margin;
  margins.smallest_obstacle_m = 0;
  return margins;
}

}  // namespace

std::vector<MarginSetting> ball_margins(const Rig& rig) {
  constexpr std::array<double, 3> kTranslations_m = {0.021, 0.010, 0.013};
  constexpr std::array<double, 3> kRotations_rad = {0.84 * kDegree_rad, 0.38 * kDegree_rad, 0.33 * kDegree_rad};
  constexpr double kQuarterFrame_s = 0.25 / 30;
  constexpr double kWalking_m_s = 1.6;
  const std::size_t n = rig.cameras.size();
  MarginSetting calibrated{"Kinect + calibration", std::vector(n, kinect_margin()), 0};
  for (std::size_t k = 0; k < n; ++k) {
    calibrated.margins[k].translation_m = kTranslations_m.at(k);
    calibrated.margins[k].rotation_rad = kRotations_rad.at(k);
  }
  MarginSetting timed = calibrated;
  timed.name = "Kinect + calibration + time";
  timed.v_max_m_s = kWalking_m_s;
  for (CameraMargins& margins : timed.margins) {
    margins.half_exposure_s = sensor_model("kinect_v1").half_exposure_s.value_or(0);
    margins.time_uncertainty_s = kQuarterFrame_s;
  }
  return {{"none, w = 0", std::vector(n, no_margin(0)), 0},
          {"none, w = 1", std::vector(n, no_margin(1)), 0},
          {"Kinect", std::vector(n, kinect_margin()), 0},
          calibrated,
          timed};
}

std::vector<MarginSetting> kitchen_margins(std::size_t camera_count) {
  CameraMargins posed = kinect_margin();
  posed.translation_m = 0.015;
  posed.rotation_rad = 0.5 * kDegree_rad;
  return {{"none, w = 0", std::vector(camera_count, no_margin(0)), 0},
          {"none, w = 1", std::vector(camera_count, no_margin(1)), 0},
          {"Kinect", std::vector(camera_count, kinect_margin()), 0},
          {"Kinect + pose", std::vector(camera_count, posed), 0}};
}

Rig with_kinect_range(Rig rig) {
  const MeasurementRule& range = sensor_model("kinect_v1").rule;
  for (RigCamera& camera : rig.cameras) {
    camera.rule.near_m = range.near_m;
    camera.rule.far_m = range.far_m;
    camera.rule.clamp_beyond_far = range.clamp_beyond_far;
  }
  return rig;
}

}  // namespace depthgrid::lab
