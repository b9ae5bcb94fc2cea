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
  return margins;
}

}  // namespace depthgrid::files
