#include "depthgrid/files/rig_margins.hpp"

#include <string_view>

#include "depthgrid/core/error.hpp"

namespace depthgrid::files {
namespace {

using rapidjson::Value;

/// The number under `key` into `target`; whether there is one. The schema has checked type and range.
bool take(const Value& object, const char* key, double& target) {
  const auto member = object.FindMember(key);
  if (member == object.MemberEnd()) {
    return false;
  }
  target = member->value.GetDouble();
  return true;
}

/// Whether the entry says that its images were registered to another camera; none: it does not say.
std::optional<bool> registered_of(const Value& camera) {
  const auto registered = camera.FindMember("registered");
  return registered != camera.MemberEnd() ? std::optional(registered->value.GetBool()) : std::nullopt;
}

void refuse_bands_of_registered(const Value& camera, const CameraMargins& margins) {
  if (margins.second_view_x_m != 0 && registered_of(camera).value_or(false)) {
    fail("second_view_x_m is ", margins.second_view_x_m,
         " m and \"registered\" is true: in images that were registered to another camera shadow bands lie on both "
         "sides, and nothing can be said of them; leave second_view_x_m out, or record images as the sensor computes "
         "them");
  }
}

}  // namespace

const SensorModel* sensor_of(const Value& camera) {
  const auto name = camera.FindMember("sensor");
  if (name == camera.MemberEnd()) {
    return nullptr;
  }
  return &sensor_model(std::string_view(name->value.GetString(), name->value.GetStringLength()));
}

std::optional<CameraMargins> margins_of(const Value& camera, const SensorModel* sensor, const RigCamera& calibrated) {
  std::optional<CameraMargins> margins;
  if (sensor != nullptr) {
    margins = sensor_margins(*sensor, calibrated.intrinsics, calibrated.metres_per_unit);
    margins->second_view_x_m = registered_of(camera).value_or(true) ? 0.0 : sensor->second_view_x_m;
  }
  const auto own = camera.FindMember("margins");
  if (own == camera.MemberEnd()) {
    return margins;
  }
  const bool has_sensor = margins.has_value();
  CameraMargins& result = margins ? *margins : margins.emplace();
  const Value& given = own->value;
  bool has_noise = take(given, "noise_constant_m", result.sensor.constant_m);
  has_noise = take(given, "noise_linear", result.sensor.linear) || has_noise;
  has_noise = take(given, "noise_quadratic_per_m", result.sensor.quadratic_per_m) || has_noise;
  if (!has_sensor && !has_noise) {
    fail(
        "says nothing about the depth's noise, and there is no sensor; give noise_constant_m, noise_linear or "
        "noise_quadratic_per_m, or name a \"sensor\" (\"ideal\" has no noise)");
  }
  if (const auto lateral = given.FindMember("lateral_px"); lateral != given.MemberEnd()) {
    result.sensor.lateral_px = lateral->value.GetInt();
  }
  take(given, "translation_m", result.translation_m);
  take(given, "rotation_rad", result.rotation_rad);
  take(given, "half_exposure_s", result.half_exposure_s);
  take(given, "time_uncertainty_s", result.time_uncertainty_s);
  take(given, "smallest_obstacle_m", result.smallest_obstacle_m);
  take(given, "second_view_x_m", result.second_view_x_m);
  refuse_bands_of_registered(camera, result);
  return margins;
}

}  // namespace depthgrid::files
