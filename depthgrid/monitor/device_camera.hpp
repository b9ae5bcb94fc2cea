// Cameras with a driver of their own, and what was recorded with them, as a cell names them. Internal.
#pragma once

#include <memory>

#include "depthgrid/cell/cell.hpp"
#include "depthgrid/core/rig.hpp"
#include "depthgrid/sensors/playback.hpp"
#include "depthgrid/sensors/recorded_camera.hpp"
#include "depthgrid/sensors/source.hpp"

namespace depthgrid::monitor {

/// First and last time of an entry that is a recording of any kind. Throws Error; also where its times are of a clock
/// that another recording of the cell does not share.
[[nodiscard]] sensors::RecordedSpan span_of(const cell::CameraEntry& entry, const RigCamera& camera,
                                            const cell::Cell& cell);

/// Not open. Throws Error that names the place in the cell file.
[[nodiscard]] std::unique_ptr<sensors::DepthSource> device_camera(
    const cell::CameraEntry& entry, const RigCamera& camera, const std::shared_ptr<const sensors::Playback>& playback);

}  // namespace depthgrid::monitor
