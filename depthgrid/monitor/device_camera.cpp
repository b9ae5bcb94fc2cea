#include "depthgrid/monitor/device_camera.hpp"

#include <algorithm>
#include <cmath>

#include "depthgrid/cell/cell_setup.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/sensors/realsense_camera.hpp"
#include "depthgrid/sensors/realsense_recording.hpp"

namespace depthgrid::monitor {
namespace {

using cell::SourceKind;

bool is_alone(const cell::Cell& cell) {
  const auto recordings = std::count_if(cell.cameras.begin(), cell.cameras.end(),
                                        [](const auto& camera) { return !camera.recording.empty(); });
  return recordings == 1 && !(cell.robot && cell.robot->joints.source == SourceKind::recording);
}

std::unique_ptr<sensors::DepthSource> realsense(const cell::CameraEntry& entry, const RigCamera& camera) {
  sensors::RealSenseSettings settings;
  settings.serial = entry.device;
  settings.width_px = camera.intrinsics.width_px;
  settings.height_px = camera.intrinsics.height_px;
  settings.rate_hz = static_cast<int>(std::lround(entry.rate_hz));
  settings.arrival = {.lag_s = entry.arrival_lag_s, .time_uncertainty_s = camera.margins->time_uncertainty_s};
  if (camera.margins->half_exposure_s > 0) {
    settings.longest_exposure_s = 2 * camera.margins->half_exposure_s;
  }
  return std::make_unique<sensors::RealSenseCamera>(settings);
}

}  // namespace

sensors::RecordedSpan span_of(const cell::CameraEntry& entry, const cell::Cell& cell) {
  if (entry.source == SourceKind::recording) {
    return sensors::recorded_span(entry.recording, cell::recording_options(entry));
  }
  if (entry.source != SourceKind::realsense) {
    fail(entry.place, ": recording: of source: ", to_string(entry.source), " is not part of this build");
  }
  const sensors::RealSenseSpan span = sensors::realsense_span(entry.recording);
  if (span.has_own_clock && !is_alone(cell)) {
    fail(entry.place,
         ": recording: its times are of the camera's own clock, so nothing says when it was recorded "
         "beside the other recordings of this cell: record with global time");
  }
  return {span.first_s, span.last_s};
}

std::unique_ptr<sensors::DepthSource> device_camera(const cell::CameraEntry& entry, const RigCamera& camera,
                                                    const std::shared_ptr<const sensors::Playback>& playback) {
  if (entry.source == SourceKind::realsense) {
    return entry.recording.empty() ? realsense(entry, camera)
                                   : std::make_unique<sensors::RealSenseRecording>(entry.recording, playback);
  }
  fail(entry.place, ": source: ", to_string(entry.source),
       " is not part of this build: recording, simulated, realsense, ros2");
}

}  // namespace depthgrid::monitor
