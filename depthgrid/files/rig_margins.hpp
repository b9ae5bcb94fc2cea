// The errors of a camera as its entry of the rig file states them. Not part of the installed headers. Internal.
#pragma once

#include <rapidjson/document.h>

#include <optional>

#include "depthgrid/core/rig.hpp"
#include "depthgrid/core/sensor_models.hpp"

namespace depthgrid::files {

/// The sensor model that the entry names; null where it names none. Throws Error that lists the names there are.
const SensorModel* sensor_of(const rapidjson::Value& camera);

/// The sensor's margins with the entry's own numbers in their place; none where the entry says nothing. `calibrated`
/// has its intrinsics and metres_per_unit. Throws Error where the entry gives margins that say nothing about noise.
std::optional<CameraMargins> margins_of(const rapidjson::Value& camera, const SensorModel* sensor,
                                        const RigCamera& calibrated);

}  // namespace depthgrid::files
