#include "depthgrid/monitor/device_camera.hpp"

#include <algorithm>
#include <cmath>

#include "depthgrid/cell/cell_setup.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/sensors/freenect_camera.hpp"
#include "depthgrid/sensors/openni_camera.hpp"
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

sensors::ArrivalTimes arrival_of(const cell::CameraEntry& entry, const RigCamera& camera) {
  return {.lag_s = entry.arrival_lag_s, .time_uncertainty_s = camera.margins->time_uncertainty_s};
}

std::unique_ptr<sensors::DepthSource> realsense(const cell::CameraEntry& entry, const RigCamera& camera) {
  sensors::RealSenseSettings settings;
  settings.serial = entry.device;
  settings.width_px = camera.intrinsics.width_px;
  settings.height_px = camera.intrinsics.height_px;
  settings.rate_hz = static_cast<int>(std::lround(entry.rate_hz));
  settings.arrival = arrival_of(entry, camera);
  if (camera.margins->half_exposure_s > 0) {
    settings.longest_exposure_s = 2 * camera.margins->half_exposure_s;
  }
  return std::make_unique<sensors::RealSenseCamera>(settings);
}

std::unique_ptr<sensors::DepthSource> freenect(const cell::CameraEntry& entry, const RigCamera& camera) {
  if (camera.intrinsics.width_px != sensors::FreenectCamera::kWidth_px ||
      camera.intrinsics.height_px != sensors::FreenectCamera::kHeight_px) {
    fail(entry.place, ": intrinsics: a Kinect v1 gives images of 640 x 480 pixels, not of ", camera.intrinsics.width_px,
         " x ", camera.intrinsics.height_px);
  }
  return std::make_unique<sensors::FreenectCamera>(
      sensors::FreenectSettings{.serial = entry.device, .arrival = arrival_of(entry, camera)});
}

std::unique_ptr<sensors::DepthSource> openni(const cell::CameraEntry& entry, const RigCamera& camera) {
  return std::make_unique<sensors::OpenniCamera>(sensors::OpenniSettings{.device = entry.device,
                                                                         .width_px = camera.intrinsics.width_px,
                                                                         .height_px = camera.intrinsics.height_px,
                                                                         .arrival = arrival_of(entry, camera)});
}

/// What a recording by the camera's maker says of its times.
struct MadeSpan {
  sensors::RecordedSpan span;
  bool has_own_clock = false;
};

MadeSpan made_span(const cell::CameraEntry& entry, const RigCamera& camera) {
  if (entry.source == SourceKind::realsense) {
    const sensors::RealSenseSpan span = sensors::realsense_span(entry.recording, arrival_of(entry, camera));
    return {.span = {span.first_s, span.last_s}, .has_own_clock = span.has_own_clock};
  }
  const sensors::OpenniSpan span = sensors::openni_span(entry.recording);
  return {.span = {span.first_s, span.last_s}, .has_own_clock = true};
}

}  // namespace

sensors::RecordedSpan span_of(const cell::CameraEntry& entry, const RigCamera& camera, const cell::Cell& cell) {
  if (entry.source == SourceKind::recording) {
    return sensors::recorded_span(entry.recording, cell::recording_options(entry));
  }
  const MadeSpan made = made_span(entry, camera);
  if (made.has_own_clock && !is_alone(cell)) {
    fail(entry.place,
         ": recording: its times are of the camera's own clock, so nothing says when it was recorded beside the other "
         "recordings of this cell");
  }
  return made.span;
}

std::unique_ptr<sensors::DepthSource> device_camera(const cell::CameraEntry& entry, const RigCamera& camera,
                                                    const std::shared_ptr<const sensors::Playback>& playback) {
  const bool is_recording = !entry.recording.empty();
  switch (entry.source) {
    case SourceKind::realsense:
      return is_recording
                 ? std::make_unique<sensors::RealSenseRecording>(entry.recording, playback, arrival_of(entry, camera))
                 : realsense(entry, camera);
    case SourceKind::freenect:
      return freenect(entry, camera);
    case SourceKind::openni:
      return is_recording ? std::make_unique<sensors::OpenniRecording>(entry.recording, entry.mirrored, playback)
                          : openni(entry, camera);
    default:
      fail(entry.place, ": source: ", to_string(entry.source), " is no camera with a driver");
  }
}

}  // namespace depthgrid::monitor
