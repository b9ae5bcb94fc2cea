#include "depthgrid/sensors/recorded_camera.hpp"

#include <exception>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/sensors/clock.hpp"

namespace depthgrid::sensors {
namespace {

files::RecordingOptions only(const std::string& camera) {
  files::RecordingOptions options;
  options.camera_ids = {camera};
  return options;
}

}  // namespace

RecordedSpan recorded_span(const std::filesystem::path& recording, const std::string& camera) {
  return recorded_span(recording, only(camera));
}

RecordedSpan recorded_span(const std::filesystem::path& recording, const files::RecordingOptions& options) {
  const files::Recording opened(recording, options);
  const auto first_s = opened.time_s(0);
  const auto last_s = opened.time_s(opened.frame_count() - 1);
  if (!first_s || !last_s) {
    fail(opened.rig_file().string(), ": says no times, so it cannot be played: rate_hz, or images with time stamps");
  }
  return {opened.start_s() + *first_s, opened.start_s() + *last_s};
}

RecordedCamera::RecordedCamera(std::filesystem::path recording, files::RecordingOptions options,
                               std::shared_ptr<const Playback> playback)
    : path_(std::move(recording)), options_(std::move(options)), playback_(std::move(playback)) {}

RecordedCamera::RecordedCamera(std::filesystem::path recording, const std::string& camera,
                               std::shared_ptr<const Playback> playback)
    : RecordedCamera(std::move(recording), only(camera), std::move(playback)) {}

void RecordedCamera::open() {
  recording_.emplace(path_, options_);
  const RigCamera& camera = recording_->rig().cameras.front();
  info_ = {"recording " + path_.string(), camera.id, "the recording's", camera.intrinsics, camera.metres_per_unit};
  reason_.clear();
  index_ = 0;
  round_ = playback_->round_at(clock_now_s());
}

double RecordedCamera::due_s(int index) const {
  return playback_->clock_s(recording_->start_s() + recording_->time_s(index).value_or(0), round_);
}

bool RecordedCamera::go_to(int index) {
  index_ = index;
  if (index_ >= recording_->frame_count() && playback_->repeats()) {
    index_ = 0;
    ++round_;
  }
  return index_ < recording_->frame_count();
}

Reading RecordedCamera::read(int index, DepthReading& reading) {
  const Frame frame = recording_->read(index).front();
  reading.depth = frame.depth;
  // An image's own time may differ from its frame's.
  reading.time_s = playback_->clock_s(recording_->start_s() + frame.time_s, round_);
  reading.T_world_camera = recording_->moves(0) ? std::optional(recording_->T_world_camera(index, 0)) : std::nullopt;
  return frame.depth.data != nullptr ? Reading::got : Reading::nothing;
}

Reading RecordedCamera::next(DepthReading& reading, double longest_s) noexcept try {
  if (!recording_) {
    reason_ = "is not open";
    return Reading::failed;
  }
  if (!go_to(index_)) {
    return Reading::ended;
  }
  reading.skipped = 0;
  if (playback_->pace() == Pace::as_recorded) {
    if (!wait_until(due_s(index_), longest_s)) {
      return Reading::nothing;
    }
    while (index_ + 1 < recording_->frame_count() && due_s(index_ + 1) <= clock_now_s()) {
      ++index_;
      ++reading.skipped;
    }
  }
  const int index = index_++;
  return read(index, reading);
} catch (const std::exception& error) {
  reason_ = error.what();
  return Reading::failed;
}

}  // namespace depthgrid::sensors
